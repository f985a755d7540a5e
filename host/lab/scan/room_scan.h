// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lab/random.h"
#include "lab/solids/part_surface.h"
#include "lab/solids/scene.h"

// What a laser scanner sees of a room from some stations: patches of the solids' surfaces, at most
// 25 mm wide, less what touches or lies within another solid.
namespace topple::scenes {

class RoomScan {
  public:
    // Stations in the room's frame, at most 255, none within a solid. `world` must outlive this.
    // `threads` as in ThreadPool.
    RoomScan(const World& world, const std::vector<Vec3>& stations, unsigned threads);

    // In the order in which the scanner sweeps: station by station, turning from column to column.
    std::size_t patches() const { return seen_.size(); }
    double area(std::size_t patch) const { return seen_[patch].area; }  // m^2
    std::int32_t object(std::size_t patch) const;

    // Points spread evenly over a patch, each moved along the scanner's ray by a normally
    // distributed error of this standard deviation, room frame. Without error, every point is
    // clear of all other solids by 3 mm.
    void sample(std::size_t patch, double noise_m, Random random, std::span<Vec3> points) const;

  private:
    // Parts [first, last) that lie within one box: an object's, or one of the room's own.
    struct Group {
        Bounds box;
        std::size_t first, last;
    };
    struct Seen {
        Patch patch;
        double area = 0;
        std::uint8_t station = 0;
        bool near = false;  // another solid is near: points must be checked
        std::uint32_t column = 0;
        double slope = 0;
    };
    enum class Room { clear, near, none };

    Room room_at(const Vec3& p, double radius, std::int32_t part) const;
    bool blocked(const Vec3& from, const Vec3& to, std::size_t& last) const;
    void look(const Patch& patch, int depth, std::vector<std::size_t>& last,
              std::vector<Seen>& seen) const;
    bool find_station(const Sheet::Place& place, std::vector<std::size_t>& last, Seen& seen) const;

    const World& world_;
    const std::vector<Vec3> stations_;
    std::vector<Part::Heading> headings_;
    std::vector<Bounds> boxes_;  // of parts
    std::vector<Group> groups_;
    std::vector<Sheet> sheets_;
    std::vector<Seen> seen_;
};

}  // namespace topple::scenes

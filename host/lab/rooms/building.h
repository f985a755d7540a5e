// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "lab/solids/scene.h"

// Buildings of furnished rooms, as a laser scanner leaves them. The building's frame: metres, z up,
// the lowest floor at z = 0.
namespace topple::scenes {

struct BuildingOptions {
    std::uint64_t seed = 1;
    std::uint64_t points = 1'000'000;
    double spacing_m = 0.005;   // between points that are neighbours on a surface
    std::uint64_t storeys = 0;  // 0: as few as hold 40 rooms each at most
    bool varied = false;        // varied furniture instead of plain, see RoomOptions
    double noise_m = 0.002;     // standard deviation of a point along the scanner's ray
    unsigned threads = 0;       // 0: all cores; the result does not depend on it
};

// Rooms of one height in rows and columns, storey by storey, with a door between any two that are
// neighbours. The number of rooms follows from that of the points and their spacing.
class Building {
  public:
    // Throws Error(usage) where an option makes no sense.
    explicit Building(const BuildingOptions& options);

    const BuildingOptions& options() const { return options_; }
    std::size_t rooms() const { return rooms_; }
    std::size_t storeys() const { return storeys_; }

    struct Door {
        std::size_t to = 0;    // the room behind
        std::size_t wall = 0;  // 1 to 4: at low y, high y, low x, high x
        std::array<Vec3, 2>
            opening{};  // lowest and highest corner, room frame; half of the wall deep
    };
    struct Room {
        std::size_t id = 0, storey = 0;
        Vec3 origin{};  // of the room's frame (scene.h) in the building's
        std::vector<Door> doors;
        // Floor, ceiling, walls up to the middle of their thickness and what else is the
        // building's are object 0.
        World world;
        std::vector<Vec3> stations;  // where the scanner stands, room frame
    };
    // The same each time.
    Room room(std::size_t id) const;

    static constexpr double wall_m = 0.12, storey_m = 3.1, door_width_m = 0.9, door_height_m = 2.05;

  private:
    struct Cell {
        std::size_t storey, row, column;
    };
    Cell cell(std::size_t id) const;
    bool has(const Cell& cell, std::size_t& id) const;
    std::vector<Door> doors(std::size_t id, const Vec3& size) const;

    BuildingOptions options_;
    std::size_t rooms_ = 0, storeys_ = 0, per_storey_ = 0;
    std::vector<double> widths_, depths_;  // of columns and rows
};

struct BuildingSummary {
    std::size_t rooms = 0, storeys = 0;
    std::uint64_t objects = 0;  // with the building itself
    double spacing_m = 0;       // as it came out
};

// Where write_building puts the truth about `cloud`: beside it, with the ending .truth.json.
std::filesystem::path truth_of(const std::filesystem::path& cloud);

// Scans a building, a room at a time, into a binary .ply of x y z truth_object, and writes the
// truth. The points are spread evenly over all that the scanner sees from its stations in each
// room; within a room they come as the scanner sweeps. Both files get their names when they are
// complete; `keep_going` is called before each room, twice, and stops it all by returning false.
// Memory is that of one room's surface and a million points. Throws Error(input) where a file can't
// be written.
//
// Truth: seed, points, spacing, noise, storeys; rooms (id, storey, origin, size, doors, stations,
// parts of the building itself in the building's frame); objects (id, name, where, room, bounds,
// volume, points, rests_on and fixed_to as ids of objects, parts as in ground_truth.h, building's
// frame). Object 0 is the building itself.
BuildingSummary write_building(const std::filesystem::path& cloud, const BuildingOptions& options,
                               const std::function<bool(std::size_t, std::size_t)>& keep_going);

}  // namespace topple::scenes

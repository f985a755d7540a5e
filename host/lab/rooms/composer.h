// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lab/rooms/room_maker.h"

// Puts a room together as rooms are: things stand flush against walls and one another, under
// tables, in niches. Solids of different objects touch but never reach into one another by more
// than `sunk`; those of one object may.
namespace topple::scenes {

class Composer : public RoomMaker {
  public:
    static constexpr double sunk = 0.0005;  // m

    Composer(std::uint64_t seed, std::uint64_t stream) : RoomMaker(seed, stream) {}

    struct Shell {
        Vec3 size{4, 4, 2.5};  // inner, metres
        double missing = 0.2;  // chance of each wall to be absent; at least one stays
        double low = 0.05;     // and to be a half wall
        double ceiling = 0.5;
        int windows = 2, doors = 2;  // at most
        bool fittings = true;        // radiators, pipes, pillars, curtains, pictures
    };
    // Floor and walls with windows, doors, sills, skirting, niches. First of all.
    void build(const Shell& shell);

    // Whether it keeps out of all solids there, and out of ways to doors.
    bool fits(const Blueprint& blueprint, const Pose& pose) const;

    // Each returns whether it found room; placed().back() is it then.
    bool stand(const Blueprint& blueprint, const Pose& pose,
               const std::vector<std::int32_t>& supporters, const std::string& where);
    // Built in: fixed to the building.
    bool fix(const Blueprint& blueprint, const Pose& pose);
    // Its back along a wall, now and then flush with what stands there already.
    bool along_wall(const Blueprint& blueprint, bool built_in = false, int attempts = 40);
    // A row of what `make` gives, side by side with their backs along a wall, from..to in metres;
    // so many of the joints are loose. Returns where they are in placed().
    std::vector<std::size_t> row(int wall, double from, double to, double loose,
                                 const std::function<Blueprint()>& make);
    // Its back in the wall's plane, its origin at a height.
    bool on_wall(const Blueprint& blueprint, double height);
    // On the floor, anywhere.
    bool anywhere(const Blueprint& blueprint, int attempts = 40);
    // Facing a placed table's front or back (side 0, 1) or ends (2, 3), pushed in by chance.
    bool before(std::size_t table, int side, const Blueprint& chair);
    // The placed parts that make one level surface with the surface's own: all planks of a pallet.
    std::vector<std::int32_t> deck(std::size_t index, const Surface& surface) const;
    // On a surface of what was placed; by chance side by side with what stands there. Several:
    // stacked, lowest first.
    bool on_surface(std::size_t index, const Surface& surface, const std::vector<Blueprint>& stack);
    // Things of `make(random, height)` on all surfaces of a placed blueprint, so many per m^2.
    using Make = std::function<std::vector<Blueprint>(Random&, double)>;
    void fill(std::size_t index, double per_m2, const Make& make);
    void fill_all(double per_m2, const Make& make);
    // The last that was placed, where something was.
    void fill_if(bool placed, double per_m2, const Make& make) {
        if (placed) fill(last(), per_m2, make);
    }
    // Leaning against a wall, without being fixed.
    bool leaning(const Blueprint& blueprint);

    using RoomMaker::against_wall;
    double wall_length(int wall) const { return world_.room[wall < 2 ? 0 : 1]; }
    const std::vector<int>& walls() const { return walls_; }  // that stand
    int any_wall() { return walls_[random_.index(walls_.size())]; }
    double skirting() const { return skirting_; }  // m that it keeps furniture off the walls
    // Solids of the building itself.
    std::int32_t add_building(Part part) { return add_own(std::move(part)); }
    std::int32_t add_building_box(const char* name, double x, double y, double bottom,
                                  const Vec3& size);

  private:
    struct Opening {
        double from, to, bottom, top;
        bool door;
    };
    void build_wall(int wall, double height, const std::vector<Opening>& openings);
    void wall_piece(int wall, const char* name, double from, double to, double bottom, double top,
                    double inset, double deep);
    void fill_opening(int wall, const Opening& opening);
    void add_fittings();
    void hang_curtain(int wall, const Opening& opening);

    std::vector<Bounds> free_;
    std::vector<int> walls_;
    std::array<std::int32_t, 4> wall_part_{-1, -1, -1, -1};
    double skirting_ = 0, thickness_ = 0.15;
};

}  // namespace topple::scenes

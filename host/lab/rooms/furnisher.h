// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lab/rooms/furnished_room.h"
#include "lab/rooms/room_maker.h"

// Puts blueprints into a room so that solids never overlap, and different objects touch only where
// one carries the other, hangs on a wall or leans against it.
namespace topple::scenes {

class Furnisher : public RoomMaker {
  public:
    explicit Furnisher(const RoomOptions& options, std::uint64_t stream = 0);

    // Floor and walls, perhaps a pillar: parts 0 to 4 or 5. First of all.
    void build_room();
    // A box of the room's own, fixed to the parts `to`; its lowest face at `bottom`.
    std::int32_t add_room_part(const char* name, double x, double y, double bottom,
                               const Vec3& size, const std::vector<std::int32_t>& to);

    // A block from floor to ceiling in a corner: at the right (high x) or left, far (high y) or
    // near. None where that would reach into what is kept free.
    void add_corner(const char* name, const Vec3& size, bool right, bool far);

    // Whether the blueprint's parts keep their distance from all others there, but for contacts of
    // its feet with `supporter` and of its wall parts and what leans with `wall`; -1: none.
    bool fits(const Blueprint& blueprint, const Pose& pose, std::int32_t supporter,
              std::int32_t wall) const;
    void place(const Blueprint& blueprint, const Pose& pose, std::int32_t supporter,
               std::int32_t wall, const std::string& where);

    // Each tries some places at random, and returns whether it found one.
    bool place_along_wall(const Blueprint& blueprint, int attempts = 80);
    bool place_anywhere(const Blueprint& blueprint, int attempts = 60);
    // Its back in a wall's plane: fixed to the wall, its origin at a height from `lowest` to
    // `highest`, or standing on the floor and leaning.
    bool place_at_wall(const Blueprint& blueprint, double lowest, double highest);
    bool place_leaning(const Blueprint& blueprint);
    // Facing the table's front, pushed in as far as chance and legs allow.
    bool place_before(std::size_t table, const Blueprint& chair);

    // The pose on a surface where `free` holds, and how close it is to the surface's edge. `reach`
    // says how far the thing goes from its origin along the surface's x and y when turned by yaw.
    struct Spot {
        Pose pose;
        double edge;
    };
    using Reach = std::function<std::array<double, 2>(double yaw)>;
    std::optional<Spot> spot_on(const Placed& base, const Surface& surface, const Reach& reach,
                                const std::function<bool(const Pose&)>& free);
    // Calls put(surface) for each surface of what was placed, as often as its area, chance and
    // `clutter` have it.
    void each_place_on(std::size_t placed, double clutter,
                       const std::function<void(const Surface&)>& put);
    // Where a thing at a spot is said to be.
    static std::string where(const Surface& surface, double edge);

    void tilt(double degrees);

  private:
    bool place_on_floor(const Blueprint& blueprint, int attempts, const std::function<Pose()>& any);
    bool place_in_plane_of_wall(const Blueprint& blueprint, std::int32_t supporter,
                                const std::function<double()>& height);
    bool is_kept_free(const Bounds& box) const;
    // The pose with the back along wall 1..4, at a share of its length.
    Pose at_wall(std::int32_t wall, double along, double off, double z, double turn) const;

    std::optional<Vec3> size_;
    std::vector<Bounds> keep_free_;
};

// What stands where, by chance, in each kind of furnished_room().
World plain_room(const RoomOptions& options);
World varied_room(const RoomOptions& options);

}  // namespace topple::scenes

// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "core/vectors.h"
#include "lab/rooms/furnished_room.h"
#include "lab/scan/depth_camera.h"

// A furnished room at two times, between which a thing was taken away, one was put there and one
// was moved.
namespace topple::test {

struct RoomPair {
    scenes::World before, after;
    std::int32_t taken = -1, put = -1, moved = -1;  // -1: there was no place to move one to
};

inline scenes::World without(const scenes::World& world, std::int32_t object) {
    scenes::World out = world;
    std::erase_if(out.parts, [&](const scenes::Part& part) { return part.object == object; });
    return out;
}

inline scenes::Bounds bounds_of(const scenes::World& world, std::int32_t object) {
    scenes::Bounds out = scenes::no_bounds();
    for (const scenes::Part& part : world.parts)
        if (part.object == object) scenes::extend(out, part.bounds());
    return out;
}

// Things that carry nothing and are fixed to nothing.
inline std::vector<std::int32_t> loose_things(const scenes::World& world) {
    std::set<std::int32_t> out, no{0};
    for (const scenes::Part& part : world.parts) out.insert(part.object);
    for (const auto& [below, above] : world.support) no.insert(world.parts[below].object);
    for (const auto& [a, b] : world.fixed) {
        if (world.parts[a].object == world.parts[b].object) continue;
        no.insert({world.parts[a].object, world.parts[b].object});
    }
    for (const std::int32_t object : no) out.erase(object);
    return {out.begin(), out.end()};
}

// Carries a thing along what it stands on to where nothing is, 0.25 to 1 m away; whether it could.
inline bool move_aside(scenes::World& world, std::int32_t object) {
    const scenes::Bounds box = bounds_of(world, object);
    const auto fits = [&](const Vec3& by) {
        scenes::Bounds there = box;
        for (Vec3& corner : there) corner = plus(corner, by);
        there[0][2] += 0.01;
        bool held = false;
        for (const scenes::Part& part : world.parts) {
            if (part.object == object) continue;
            const scenes::Bounds other = part.bounds();
            if (scenes::overlap(there, other, 0.03)) {
                const bool below = other[1][2] <= box[0][2] + 0.005;
                if (!below) return false;
            }
            held = held || (std::abs(other[1][2] - box[0][2]) < 0.005 &&
                            other[0][0] <= there[0][0] && other[0][1] <= there[0][1] &&
                            other[1][0] >= there[1][0] && other[1][1] >= there[1][1]);
        }
        return held;
    };
    for (const double way_m : {0.5, 0.35, 0.25, 0.75, 1.0}) {
        for (int n = 0; n < 12; ++n) {
            const Vec3 by{way_m * std::cos(n * M_PI / 6), way_m * std::sin(n * M_PI / 6), 0};
            if (!fits(by)) continue;
            for (scenes::Part& part : world.parts)
                if (part.object == object) part.center = plus(part.center, by);
            return true;
        }
    }
    return false;
}

inline RoomPair room_pair(std::uint64_t seed) {
    scenes::RoomOptions room;
    room.seed = seed;
    const scenes::World world = scenes::furnished_room(room);
    const std::vector<std::int32_t> loose = loose_things(world);
    RoomPair out;
    if (loose.size() < 3) return out;
    out.taken = loose[loose.size() / 3];
    out.put = loose[2 * loose.size() / 3];
    out.before = without(world, out.put);
    out.after = without(world, out.taken);
    for (const std::int32_t object : loose) {
        if (object == out.taken || object == out.put || !move_aside(out.after, object)) continue;
        out.moved = object;
        break;
    }
    return out;
}

// Films a room; the world of its poses is turned about the vertical and shifted.
inline scenes::Sequence filmed(const scenes::World& world, std::uint64_t seed, double turn_deg,
                               const Vec3& shift_m) {
    scenes::CameraOptions camera;
    camera.frames = 30;
    camera.seed = seed;
    scenes::Sequence out = scenes::walk(world, camera);
    const double c = std::cos(turn_deg * M_PI / 180), s = std::sin(turn_deg * M_PI / 180);
    for (DepthFrame& frame : out.frames) {
        const Mat4 pose = frame.camera_to_world;
        for (std::size_t column = 0; column < 4; ++column) {
            frame.camera_to_world[column] = c * pose[column] - s * pose[4 + column];
            frame.camera_to_world[4 + column] = s * pose[column] + c * pose[4 + column];
        }
        for (std::size_t a = 0; a < 3; ++a) frame.camera_to_world[4 * a + 3] += shift_m[a];
    }
    return out;
}

}  // namespace topple::test

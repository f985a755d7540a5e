// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "lab/furniture/blueprint.h"
#include "lab/solids/pose.h"
#include "lab/solids/scene.h"

namespace topple::scenes {

// A room to which things are added: the world, and how they came to stand in it.
class RoomMaker {
  public:
    // A blueprint that stands somewhere: where its parts begin, and how it was moved.
    struct Placed {
        Blueprint blueprint;
        Pose pose;
        std::int32_t first_part = 0;
    };
    const std::vector<Placed>& placed() const { return placed_; }
    std::size_t last() const { return placed_.size() - 1; }
    Random& random() { return random_; }
    World& world() { return world_; }

  protected:
    RoomMaker(std::uint64_t seed, std::uint64_t stream) : random_(seed, stream) {}

    // A solid of the room itself.
    std::int32_t add_own(Part part) {
        part.object = 0;
        boxes_.push_back(part.bounds());
        world_.parts.push_back(std::move(part));
        return static_cast<std::int32_t>(world_.parts.size()) - 1;
    }

    // An object; returns its first part.
    std::int32_t add(const Blueprint& blueprint, const Pose& pose, const std::string& where) {
        const auto object = static_cast<std::int32_t>(world_.objects.size());
        const auto first = static_cast<std::int32_t>(world_.parts.size());
        world_.objects.push_back({blueprint.name, where, blueprint.pile});
        for (const Part& local : blueprint.parts) {
            Part part = moved(pose, local);
            part.object = object;
            boxes_.push_back(part.bounds());
            world_.parts.push_back(std::move(part));
        }
        for (const auto& [a, b] : blueprint.joints) world_.fixed.emplace_back(first + a, first + b);
        placed_.push_back({blueprint, pose, first});
        return first;
    }

    // The pose with the back along wall 0..3 (low y, high y, low x, high x); `along` in metres.
    Pose against_wall(int wall, double along, double off, double z, double turn) const {
        using std::numbers::pi;
        if (wall == 0) return {along, off, z, turn};
        if (wall == 1) return {along, world_.room[1] - off, z, pi + turn};
        if (wall == 2) return {off, along, z, -pi / 2 + turn};
        return {world_.room[0] - off, along, z, pi / 2 + turn};
    }

    World world_;
    Random random_;
    std::vector<Placed> placed_;
    std::vector<Bounds> boxes_;  // of parts
};

}  // namespace topple::scenes

// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/solid_scene.h"

namespace topple {

// What becomes of solids of which some primitives are not there after all.
struct TakenAway {
    std::vector<std::int32_t> number;          // of each primitive, in their order; -1: taken away
    std::shared_ptr<const SolidScene> solids;  // without them
    struct Voxel {
        Place at;
        std::int32_t primitive;  // whose it is now, by its new number; -1: it is empty
    };
    std::vector<Voxel> changed;  // sorted
};

// kept: by primitive. A voxel at least half of which is another's becomes that one's.
TakenAway take_away(const SolidScene& solids, const std::vector<bool>& kept);

// Of what is listed by primitive, that of those which are left.
template <class T>
std::vector<T> left_of(std::span<const std::int32_t> number, const std::vector<T>& by_primitive) {
    std::vector<T> out;
    for (std::size_t p = 0; p < number.size(); ++p)
        if (number[p] >= 0) out.push_back(by_primitive[p]);
    return out;
}

}  // namespace topple

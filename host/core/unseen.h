// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>

#include "core/scan_gaps.h"

namespace topple {

// Whether no sensor saw into voxel (i, j, k) and nothing completed it, for any threads at once;
// empty: nothing is known to be unseen, as where nobody says where the sensors were.
using Unseen = std::function<bool(std::int32_t, std::int32_t, std::int32_t)>;

// Whether a support whose highest cells are at k may go on in column (i, j): as in the shadow that
// a thing casts on the table on which it stands. Less than a square of noise_gap voxels is what
// grazing rays leave at an edge that was seen.
inline bool may_carry(const Unseen& unseen, std::int32_t i, std::int32_t j, std::int32_t k) {
    if (!unseen || !unseen(i, j, k)) return false;
    const auto all_from = [&](std::int32_t low_i, std::int32_t low_j) {
        for (std::int32_t a = 0; a < noise_gap * noise_gap; ++a)
            if (!unseen(low_i + a / noise_gap, low_j + a % noise_gap, k)) return false;
        return true;
    };
    for (std::int32_t a = 0; a < noise_gap * noise_gap; ++a)
        if (all_from(i - a / noise_gap, j - a % noise_gap)) return true;
    return false;
}

}  // namespace topple

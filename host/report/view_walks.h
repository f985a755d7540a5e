// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/rotation.h"
#include "topple/scene.h"

namespace topple::report {

// Scene::walks as they are drawn, in the view's frame. Cell (x, y) is the parallelogram from
// corner_m + x * along_x_m + y * along_y_m, its index y * nx + x.
struct PackedWalks {
    std::int64_t nx = 0, ny = 0;
    Vec3 corner_m{}, along_x_m{}, along_y_m{};
    std::vector<std::uint8_t> shade;  // 0: not walkable; else 1 + 254 x the root of visits / most
    std::vector<std::int16_t> floor_mm;  // above corner_m
    double most = 0;  // visits per event of a busy cell: but one in a hundred have fewer
    std::vector<std::vector<std::array<float, 3>>> paths;
};

// Merges cells by squares until at most `cells` are left. Never fails; where the walks' sizes do
// not fit together, or a place is not finite, there are none.
PackedWalks pack_walks(const Walks& walks, const Rotation& view_from_input, std::size_t cells);

}  // namespace topple::report

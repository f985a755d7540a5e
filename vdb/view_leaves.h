// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "carve_leaves.hpp"
#include "vdb/leaf_table.h"

namespace topple::vdb {

// What one depth frame can see at most: the cone of its pixels, down to its deepest reading.
struct ViewCone {
    std::array<float, 12> camera;  // as kernel carve_leaves takes it
    double far_m = 0;              // deepest reading with its noise; below 0: no reading at all
};

// The leaves of the table that some cone reaches, ascending. The others cost nothing but the
// division of the table's box in halves until a part lies outside of all cones. Conservative with
// respect to kernel carve_leaves: a leaf that is left out would get neither of its bits.
std::vector<std::uint64_t> leaves_in_view(const LeafTable& table, std::span<const ViewCone> cones,
                                          const kernels::CarveParams& params);

}  // namespace topple::vdb

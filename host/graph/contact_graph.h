// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/table.h"
#include "physics/bodies.h"
#include "topple/kernels/device.h"

// What touches what, and what rests on what (paper, 4.2). Grid frame: metres, z up.
namespace topple::graph {

// One primitive resting on another: columns in which a voxel of `supported` lies right above one of
// `supporter`.
struct Carrying {
    std::int32_t supporter = -1;  // -1: solid that belongs to no primitive
    std::int32_t supported = -1;
    double area_m2 = 0;
    double height_m = 0;  // of the contact, the mean over its columns
    // Convex hull of the contact, counter-clockwise, with what may be in contact: where nobody has
    // seen between the supported primitive and the height of the contact. Of a box seen from the
    // front, the rear stands on the table, too, but not beyond the table's edge.
    std::vector<std::array<double, 2>> outline;
    double border_error_m = 0;  // of the outline: one standard error
};

// One primitive whose side touches another's.
struct Leaning {
    std::int32_t primitive = -1, against = -1;
    double height_m = 0;                             // of the contact's middle
    std::array<std::array<double, 2>, 4> outline{};  // points on its border, seen from above
};

struct ContactGraph {
    std::int32_t primitives = 0;
    double voxel_m = 0;
    std::vector<physics::TouchingPair> pairs;                 // sorted by (a, b)
    std::vector<Carrying> carryings;                          // sorted by (supported, supporter)
    std::vector<Leaning> leanings;                            // sorted by (primitive, against)
    Table<PrimitiveId, std::array<double, 3>> silhouette_m2;  // area seen along x, y, z
    Table<PrimitiveId, double> lowest_m, highest_m;
    Table<PrimitiveId, double> section_m2;  // mean level cross-section

    // What carries one primitive: a range of `carryings`.
    std::span<const Carrying> carriers_of(std::int32_t primitive) const;
    // What one primitive touches with its sides: a range of `leanings`.
    std::span<const Leaning> leanings_of(std::int32_t primitive) const;
};

// Gaps of up to contact_gap empty voxels count as contact. Heights and outlines of contacts are
// those of the surfaces in `boundary`, where there are any, else of voxels.
ContactGraph build_contact_graph(device::Device& device, const SolidCells& cells,
                                 std::int32_t primitives, const BoundaryCells& boundary = {});

}  // namespace topple::graph

// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/boundary_cells.h"

// How the patches around a voxel bound what is solid in it: at a convex edge both do, at a concave
// one either.
namespace topple::solids {

struct SeenPatch {
    std::uint32_t patch = 0;
    double count = 0, here = 0;  // points around the voxel, and in it
    Vec3 mean{};
};

// See BoundaryCells. No slots: all of the voxel is solid, or, if any of no groups suffices,
// nothing.
struct Combination {
    bool nothing = false, any_group = false;
    std::size_t used = 0;
    std::array<std::uint32_t, BoundaryCells::slots> slot{};
    std::array<SlotUse, BoundaryCells::slots> use{};
};
Combination combine(std::span<const SeenPatch> seen, std::span<const SurfacePatch> patches,
                    const Vec3& middle, double voxel_m);

// A patch that bounds all of it, where it passes the voxel or leaves it out.
void add_bound(std::uint32_t patch, bool outside, std::span<const SurfacePatch> patches,
               const Vec3& middle, double voxel_m, Combination& sum);

// Whether two patches are the two sides of one wall: they face away from each other, and each was
// seen on the solid side of the other.
bool are_wall(const SeenPatch& a, const SeenPatch& b, std::span<const SurfacePatch> patches);

// Whether two patches meet in a concave edge, if they do: each was seen outside of the other.
bool are_concave(const SeenPatch& a, const SeenPatch& b, std::span<const SurfacePatch> patches,
                 double voxel_m);

void drop_slot(std::size_t slot, Combination& sum);

}  // namespace topple::solids

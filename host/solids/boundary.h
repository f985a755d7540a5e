// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "core/boundary_cells.h"
#include "core/ledge.h"
#include "core/solid_cells.h"
#include "core/thread_pool.h"
#include "solids/coherence.h"
#include "solids/patches.h"
#include "topple/kernels/device.h"

namespace topple::solids {

// What bounds the solids within their voxels: patches that were seen in a voxel or right beside it;
// and where two solids touch, or one reaches what faces it unseen, the patch of the one that goes
// on there, for both: they share no volume and leave none. Sheets, of which nobody knows how thick
// they are, end within their voxels only where something stands against them. sheet: by primitive.
BoundaryCells find_boundary(device::Device& device, const SolidCells& cells, const SeenCells& seen,
                            std::vector<SurfacePatch> patches, const std::vector<bool>& sheet,
                            std::span<const Ledge> ledges = {});

// The part of each voxel that is solid, and its moments (kernel cell_share).
void measure_shares(device::Device& device, double voxel_m, BoundaryCells& boundary);

// Where two primitives' solids end at one another: for the voxels of one, patches that bound it.
struct Mate {
    Place at;
    std::int32_t primitive;
    std::uint32_t patch;
    bool outside;  // of the patch is where the primitive is
    bool extends;  // the primitive goes on into this voxel; else it counts for its own ones alone
    BorderKey key() const { return {at, primitive}; }
};
// Adds patches of ledges to `patches`. faced: by cell, bits of the directions -x +x -y +y -z +z
// that a patch of the cell's primitive that was seen beside it faces. Sorted by key.
std::vector<Mate> find_mates(const SolidCells& cells, const SeenCells& seen,
                             std::span<const std::uint8_t> faced, std::span<const Ledge> ledges,
                             std::vector<SurfacePatch>& patches, ThreadPool& threads);

// The next cell along +axis of each, so many voxels away at most; no_cell where there is none.
std::vector<std::size_t> next_cells(const SolidCells& cells, std::size_t axis,
                                    std::int32_t furthest);

// Bits of the directions that a gradient has its largest part along, roughly.
std::uint8_t faced_by(const Vec3& gradient);
// Half of the range of a patch's values over a voxel: its own, if it is flat.
double reach_of(const Vec3& gradient, double voxel_m);

// Without the cells of primitives that lie in `cells` but of which the surfaces leave nothing:
// these were seen, but are so thin, and are solid as whole voxels. A thing without a volume can't
// be weighed. primitives: their number.
BoundaryCells without_void_solids(const SolidCells& cells, BoundaryCells all,
                                  std::size_t primitives);

}  // namespace topple::solids

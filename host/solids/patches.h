// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/boundary_cells.h"
#include "core/thread_pool.h"
#include "geometry/segmentation.h"
#include "solids/grid_points.h"

// From the seen surface to solids that are finer than their voxels. Grid frame: metres, z up.
namespace topple::solids {

// In standard deviations of a patch's points: what lies farther from it is not of it.
inline constexpr double outlier = 3;

// Points that make a patch at least: a quadric has nine figures.
inline constexpr std::size_t least_points = 12;

// A model fitted anew to the points near it. residual_m: what it leaves of its own.
SurfacePatch fit_patch(geometry::AlgebraicModel model, double residual_m,
                       std::span<const Eigen::Vector3d> points);

// The regions' models, fitted anew to the points themselves: surfels at edges lie inside of both
// faces. Points that a region only borders on are told from its own by their distance, in robust
// standard deviations. region_of_point: -1 for none.
std::vector<SurfacePatch> fit_patches(const GridPoints& points,
                                      std::span<const geometry::Region> regions,
                                      std::span<const std::int32_t> region_of_point,
                                      ThreadPool& threads);

// Surfels at an edge make narrow regions of their own there, askew to both faces. A patch whose
// points larger ones beside it explain is none, nor is one within a surfel of two much larger ones
// that faces between them: its points become theirs, and what these leave belongs to no patch.
// cell_m: about twice the surfels' edge.
void drop_explained(const GridPoints& points, std::span<const SurfacePatch> patches, double cell_m,
                    PointLabels& labels, ThreadPool& threads);

// Faces too narrow for regions of their own, as the rim of a cup. Points that lie off their patch
// go to the nearest one beside it that explains them. Where those left over within a primitive hang
// together in one plane, all of the primitive around them behind it, that plane is added to the
// patches. Arguments as of drop_explained(), after it.
void add_narrow_faces(const GridPoints& points, double cell_m, std::vector<SurfacePatch>& patches,
                      PointLabels& labels, ThreadPool& threads);

// Where the patches were seen: of each voxel, primitive and patch the points' number and mean.
// Sorted by (i, j, k, primitive, patch).
struct SeenCells {
    std::vector<std::int32_t> i, j, k, primitive, patch;
    std::vector<float> count, x, y, z;
    std::size_t size() const { return i.size(); }
};
SeenCells seen_cells(const GridPoints& points, const PointLabels& labels, double voxel_m,
                     ThreadPool& threads);

// Length of the mean normal of what faces one way, at least.
inline constexpr double one_way = 0.95;

// Whether each of so many primitives was seen from one side only: its patches face one way.
std::vector<bool> one_sided(const SeenCells& seen, std::span<const SurfacePatch> patches,
                            std::size_t primitives);

}  // namespace topple::solids

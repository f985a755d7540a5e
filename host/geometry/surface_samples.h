// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/thread_pool.h"
#include "geometry/manhattan.h"
#include "geometry/surfels.h"
#include "topple/cloud_view.h"

namespace topple::geometry {

// The seen surface as features measure it: one sample for each primitive in each cell of a cubic
// grid, at the mean of its points there. No finer than a given edge, so that what is measured on
// samples hardly depends on how densely a room was scanned. The scene's frame: metres, z up, x and
// y along its axes. Sorted by (primitive, cell).
struct SurfaceSamples {
    double edge_m = 0;     // of the cells
    double spacing_m = 0;  // as if samples lay on a square lattice on the surface; edge_m or more
    std::vector<float> x, y, z;
    std::vector<float> nx, ny, nz;  // unit, towards the sensor's side; 0 where undefined
    // CIE L*a*b*, means over the points, NaN where none is known; empty where the scan has no
    // colours.
    std::vector<float> lab_l, lab_a, lab_b;
    std::vector<std::int32_t> primitive;  // -1: of none

    std::size_t size() const { return x.size(); }
    bool coloured() const { return !lab_l.empty(); }
};

// Those for which `keep` holds, in their order.
SurfaceSamples samples_where(const SurfaceSamples& samples,
                             const std::function<bool(std::size_t)>& keep);
// By rising primitive, else in their order.
void sort_by_primitive(SurfaceSamples& samples);

// The arrays of numbers that each sample has one of: place, normal and colour. Those of colour may
// be empty.
std::array<std::vector<float>*, 9> columns_of(SurfaceSamples& samples);
std::array<const std::vector<float>*, 9> columns_of(const SurfaceSamples& samples);

// The finest edge, metres: below the size of what is told apart, above every room sensor's noise.
inline constexpr double finest_sample_m = 0.02;

// primitive_of_point: by point of the cloud, or -1. The cells are of `edge_m`, which should be at
// least the spacing of points.
SurfaceSamples sample_surface(const CloudView& cloud, const Surfels& surfels,
                              std::span<const std::int32_t> primitive_of_point,
                              const SceneFrame& frame, double edge_m, ThreadPool& threads);

}  // namespace topple::geometry

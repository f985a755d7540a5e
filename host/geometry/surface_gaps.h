// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/thread_pool.h"
#include "geometry/surfels.h"
#include "topple/cloud_view.h"
#include "topple/input.h"

namespace topple::geometry {

// Points on the surface between surfels that lie too far apart to close it at some step.
struct GapPoints {
    std::vector<float> x, y, z;  // metres, the cloud's frame
    std::vector<std::int32_t> primitive;
    std::vector<std::int32_t> face;     // -1: between two faces
    std::vector<std::uint32_t> surfel;  // one that it lies beside
    std::size_t size() const { return x.size(); }
};

// Over the triangles of surfels of one primitive that are neighbours of one another, so that
// nothing goes beyond what was seen; no two in one cell of step_m. face, primitive: labels of
// surfels, -1 for none. None where all neighbours lie within two steps. By primitive, ascending.
GapPoints close_gaps(const Surfels& surfels, std::span<const std::int32_t> face,
                     std::span<const std::int32_t> primitive, double step_m, ThreadPool& pool);

// The coordinates of a cloud, and after them of what closes its gaps.
PointCloud with_gaps(const CloudView& cloud, const GapPoints& gaps);

}  // namespace topple::geometry

// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/thread_pool.h"
#include "geometry/surfels.h"

namespace topple::geometry {

// Which side of each surfel the sensor was on: the sum of unit directions from the surfel's points
// to their sensors, or of the stored normals; empty where neither is known. The directions are
// rounded so that their sums are exact, whatever the order of the points.
struct Orientation {
    std::array<std::vector<double>, 3> towards;
};
Orientation sensor_side(const Surfels& surfels, const CloudView& cloud,
                        std::span<const Vec3> viewpoints,
                        std::span<const std::uint32_t> viewpoint_of_point, ThreadPool& threads);

// Flips normals to the known side. Where no side is known, signs spread over each connected piece
// from neighbour to neighbour, the most parallel first (Hoppe et al. 1992), and the piece as a
// whole faces the middle of the cloud, as the inside of a room does.
void orient(Surfels& surfels, const Orientation& orientation);

}  // namespace topple::geometry

// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/thread_pool.h"
#include "geometry/surfels.h"

namespace topple::geometry {

// Where the sensor of each point was: at the viewpoint, or, where there are none, where the stored
// normals point to. The arguments must outlive it.
class SensorSides {
  public:
    SensorSides(const CloudView& cloud, std::span<const Vec3> viewpoints,
                std::span<const std::uint32_t> viewpoint_of_point);
    bool known() const { return known_; }
    // The way from a point to its sensor, of any length.
    std::array<double, 3> way(std::size_t point) const;
    // Its unit direction, rounded so that sums are exact, whatever their
    // order; 0 where it is not known.
    std::array<float, 3> towards(std::size_t point) const;

  private:
    const CloudView& cloud_;
    std::span<const Vec3> viewpoints_;
    std::span<const std::uint32_t> viewpoint_of_point_;
    bool known_;
};

// Which side of each surfel the sensor was on: the sum of unit directions from the surfel's points
// to their sensors; empty where these are not known.
struct Orientation {
    std::array<std::vector<double>, 3> towards;
};
Orientation sensor_side(const Surfels& surfels, const SensorSides& sides, ThreadPool& threads);

// Flips normals to the known side. Where no side is known, signs spread over each connected piece
// from neighbour to neighbour, the most parallel first (Hoppe et al. 1992), and the piece as a
// whole faces the middle of the cloud, as the inside of a room does.
void orient(Surfels& surfels, const Orientation& orientation);

}  // namespace topple::geometry

// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "topple/cloud_view.h"

namespace topple::geometry {

// Where the sensors of a cloud were that says so of each point.
struct SensorPlaces {
    std::vector<Vec3> places;  // metres; the mean of those in the same cell of 5 cm
    // Place of each point. Of a point that does not say: of the nearest place; empty where there
    // are none at all.
    std::vector<std::uint32_t> of_point;
    std::uint64_t unknown = 0;  // points that do not say
};
SensorPlaces sensor_places(const CloudView& cloud);

// At most so many of them that lie far apart, by their numbers: first the one of the most points,
// then always the one that is farthest from those chosen.
std::vector<std::uint32_t> places_apart(const SensorPlaces& sensors, std::size_t most);

}  // namespace topple::geometry

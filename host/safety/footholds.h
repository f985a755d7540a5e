// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/rotation.h"
#include "topple/scene.h"

namespace topple::safety {

// Where objects stand on one another, as the solid voxels of a finished scene show it: a parse's
// own contacts are not kept with its result. Seen from above, along the room's axes, metres.
class Footholds {
  public:
    using Polygon = std::vector<std::array<double, 2>>;

    explicit Footholds(const Scene& scene);

    // Convex hull of the columns in which the supported object lies right above the supporter of
    // Scene::supports[support]; where it does in none, of those with a gap that noise may leave.
    // Empty: they touch elsewhere, or the scene has no voxels.
    const Polygon& of(std::size_t support) const { return of_[support]; }

    // How far outside of the hull of these supports' footholds a place lies, level, metres; below 0
    // inside. One of them is not empty.
    double outside_m(std::span<const std::size_t> supports, const Vec3& place) const;

  private:
    Rotation axes_;  // the room's
    std::vector<Polygon> of_;
};

}  // namespace topple::safety

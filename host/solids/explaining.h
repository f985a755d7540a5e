// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <span>

#include "solids/patches.h"

namespace topple::solids {

inline double distance_to(const SurfacePatch& patch, const Eigen::Vector3d& p) {
    return patch.distance({p.x(), p.y(), p.z()});
}

// Of the patches that are near, and that may(patch) allows, the one that lies nearest to a point in
// standard deviations of its noise, the lowest of equals; -1 where it is none's.
template <class May>
std::int32_t explaining(std::span<const SurfacePatch> patches, std::span<const std::int32_t> near,
                        const Eigen::Vector3d& p, const May& may) {
    std::int32_t best = -1;
    double least = 1;
    for (const std::int32_t n : near) {
        if (!may(n)) continue;
        const SurfacePatch& patch = patches[n];
        const double off = std::abs(distance_to(patch, p)) / (outlier * patch.noise_m);
        if (off > least || (off == least && best >= 0 && best < n)) continue;
        least = off;
        best = n;
    }
    return best;
}

}  // namespace topple::solids

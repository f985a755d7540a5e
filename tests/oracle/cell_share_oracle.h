// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

namespace topple::oracle {

// A surface f(p) = c0 + c . q + q' C q, q = p - origin, and how it bounds a voxel.
struct ShareSurface {
    std::array<double, 3> origin{};
    std::array<double, 10> c{};
    bool outside = false, bounds = false;
};

// A boolean formula of surfaces: groups of them, and those that bound all of it.
struct ShareVoxel {
    std::array<int, 3> index{};
    bool any_group = false;
    std::vector<std::vector<ShareSurface>> groups;
    std::vector<ShareSurface> bounds;
};

struct Share {
    double part = 0;                 // of the voxel, 0 to 1
    std::array<double, 3> moment{};  // mean of the inside times its place, in quarters of the edge
};

// Of a cube of this edge around `at`, the part inside of the surface: that of a slab across, with
// the gradient of the voxel's middle.
inline double inside_of(const ShareSurface& s, const std::array<double, 3>& at,
                        const std::array<double, 3>& middle, double edge) {
    const auto slope = [&](const std::array<double, 3>& p) {
        const double u = p[0] - s.origin[0], v = p[1] - s.origin[1], w = p[2] - s.origin[2];
        return std::array{s.c[1] + 2 * s.c[4] * u + s.c[7] * v + s.c[8] * w,
                          s.c[2] + 2 * s.c[5] * v + s.c[7] * u + s.c[9] * w,
                          s.c[3] + 2 * s.c[6] * w + s.c[8] * u + s.c[9] * v};
    };
    const std::array<double, 3> g = slope(middle);
    const double u = at[0] - s.origin[0], v = at[1] - s.origin[1], w = at[2] - s.origin[2];
    const double f = s.c[0] + s.c[1] * u + s.c[2] * v + s.c[3] * w + s.c[4] * u * u +
                     s.c[5] * v * v + s.c[6] * w * w + s.c[7] * u * v + s.c[8] * u * w +
                     s.c[9] * v * w;
    const double distance = f / std::max(std::hypot(g[0], g[1], g[2]), 0.2);
    return std::clamp(0.5 - (s.outside ? -distance : distance) / edge, 0.0, 1.0);
}

// Kernel cell_share in plain double precision, as a formula of probabilities of independent events.
inline Share cell_share(const ShareVoxel& voxel, double voxel_m) {
    const double edge = voxel_m / 4;
    std::array<double, 3> middle{};
    for (std::size_t a = 0; a < 3; ++a) middle[a] = (voxel.index[a] + 0.5) * voxel_m;
    Share out;
    for (int a = 0; a < 4; ++a) {
        for (int b = 0; b < 4; ++b) {
            for (int c = 0; c < 4; ++c) {
                const std::array<double, 3> step{a - 1.5, b - 1.5, c - 1.5};
                std::array<double, 3> at = middle;
                for (std::size_t k = 0; k < 3; ++k) at[k] += step[k] * edge;
                // P(and) is the product, P(or) that of the opposites' opposite.
                double no_group = 1, all_groups = 1;
                for (const auto& group : voxel.groups) {
                    double all = 1, none = 1;
                    for (const ShareSurface& s : group) {
                        const double in = inside_of(s, at, middle, edge);
                        all *= in;
                        none *= 1 - in;
                    }
                    no_group *= 1 - all;
                    all_groups *= 1 - none;
                }
                double in = voxel.any_group ? 1 - no_group : all_groups;
                // Patches that bound a voxel of no groups bound the whole of it.
                if (voxel.groups.empty()) in = voxel.any_group && voxel.bounds.empty() ? 0 : 1;
                for (const ShareSurface& s : voxel.bounds) in *= inside_of(s, at, middle, edge);
                out.part += in / 64;
                for (std::size_t k = 0; k < 3; ++k) out.moment[k] += in / 64 * step[k];
            }
        }
    }
    return out;
}

}  // namespace topple::oracle

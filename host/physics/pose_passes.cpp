// SPDX-License-Identifier: MIT
#include "physics/pose_passes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace topple::physics {
namespace {

double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vec3 minus(const Vec3& a, const Vec3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vec3 direction_of(const SphereMesh& mesh, std::size_t v) {
    return {mesh.x[v], mesh.y[v], mesh.z[v]};
}

bool is_minimum(const Flooded& f, std::size_t v) {
    for (std::size_t k = 0; k < 6; ++k) {
        if (f.height[f.mesh->neighbour[v * 6 + k]] < f.height[v]) return false;
    }
    return true;
}

struct Balance {
    PosePass pose;
    Vec3 edge_from, edge_to;
};

// The pose in which the centre of mass (the origin) stands above the edge a-b, if it can.
std::optional<Balance> balance(const Vec3& a, const Vec3& b) {
    const Vec3 e = minus(b, a);
    const double length2 = dot(e, e);
    if (!(length2 > 0)) return std::nullopt;
    const double t = -dot(a, e) / length2;
    if (t < 0 || t > 1) return std::nullopt;
    const Vec3 foot{a[0] + t * e[0], a[1] + t * e[1], a[2] + t * e[2]};
    const double height = std::sqrt(dot(foot, foot));
    if (!(height > 0)) return std::nullopt;
    return Balance{{height, {-foot[0] / height, -foot[1] / height, -foot[2] / height}, 0}, a, b};
}

// Whether the pose rests on the edge alone: no vertex lower, and not on vertices on both sides of
// it, which would make it a face and the pose a minimum.
bool is_pass(const Balance& b, std::span<const Vec3> vertices, double rounding) {
    const Vec3 across = cross(minus(b.edge_to, b.edge_from), b.pose.direction);
    const double width = std::sqrt(dot(across, across));
    bool left = false, right = false;
    for (const Vec3& v : vertices) {
        const double below = -dot(v, b.pose.direction) - b.pose.height_m;
        if (below > rounding) return false;
        if (below < -rounding) continue;
        const double side = dot(minus(v, b.edge_from), across) / width;
        left |= side > rounding;
        right |= side < -rounding;
    }
    return !(left && right);
}

// The edges' passes within `radius` radians of the one found, the highest below the bound.
std::optional<PosePass> search(const PosePass& found, std::span<const Vec3> vertices, double radius,
                               double bound, double rounding) {
    // At most `keep` of the lowest vertices: the edge's ends are among them for all but the
    // roundest.
    constexpr std::size_t keep = 192;
    double reach = 0;
    std::vector<std::pair<double, std::uint32_t>> low;
    for (std::size_t n = 0; n < vertices.size(); ++n) {
        low.emplace_back(dot(vertices[n], found.direction), static_cast<std::uint32_t>(n));
        reach = std::max(reach, dot(vertices[n], vertices[n]));
    }
    std::sort(low.begin(), low.end());
    const double band =
        low.front().first + 2 * std::sqrt(reach) * std::sin(std::min(radius, std::numbers::pi / 2));
    std::size_t count = 0;
    while (count < std::min(keep, low.size()) && low[count].first <= band) ++count;
    std::vector<Balance> candidates;
    for (std::size_t p = 0; p < count; ++p) {
        for (std::size_t q = p + 1; q < count; ++q) {
            const auto pose = balance(vertices[low[p].second], vertices[low[q].second]);
            if (!pose || pose->pose.height_m > bound ||
                dot(pose->pose.direction, found.direction) < std::cos(radius)) {
                continue;
            }
            candidates.push_back(*pose);
        }
    }
    std::stable_sort(candidates.begin(), candidates.end(), [](const Balance& a, const Balance& b) {
        return a.pose.height_m > b.pose.height_m;
    });
    for (const Balance& candidate : candidates) {
        if (is_pass(candidate, vertices, rounding)) return candidate.pose;
    }
    return std::nullopt;
}

}  // namespace

std::vector<PosePass> find_passes(const Flooded& f) {
    // Only minima need a look: from anywhere behind a pass, one can descend to a minimum that is
    // behind the same pass and deeper.
    std::vector<std::pair<float, std::uint32_t>> behind;
    for (std::uint32_t v = 0; v < f.height.size(); ++v) {
        if (double{f.level[v]} - f.height[v] > f.tolerance_m && is_minimum(f, v)) {
            behind.emplace_back(f.level[v], v);
        }
    }
    std::sort(behind.begin(), behind.end());
    std::vector<PosePass> passes;
    std::vector<float> levels;
    for (const auto& [level, v] : behind) {
        if (levels.empty() || levels.back() != level) {
            levels.push_back(level);
            passes.push_back({level, {}, passes.empty() ? f.height[v] : passes.back().deepest_m});
        }
        passes.back().deepest_m = std::min<double>(passes.back().deepest_m, f.height[v]);
    }
    // A level is the height of the pass's own direction.
    std::vector<bool> placed(levels.size(), false);
    for (std::uint32_t v = 0; v < f.height.size() && !levels.empty(); ++v) {
        if (f.level[v] != f.height[v]) continue;
        const auto at = std::lower_bound(levels.begin(), levels.end(), f.level[v]);
        if (at == levels.end() || *at != f.level[v]) continue;
        const auto n = static_cast<std::size_t>(at - levels.begin());
        if (placed[n]) continue;
        placed[n] = true;
        passes[n].direction = direction_of(*f.mesh, v);
    }
    return passes;
}

bool rolls(const Flooded& f) {
    const Vec3 start = direction_of(*f.mesh, f.start);
    const double limit = f.height[f.start] + f.tolerance_m;
    for (std::size_t v = 0; v < f.height.size(); ++v) {
        if (f.level[v] <= limit && dot(direction_of(*f.mesh, v), start) <= 0) return true;
    }
    return false;
}

std::optional<PosePass> refine_pass(const PosePass& found, std::span<const Vec3> vertices,
                                    double spacing) {
    if (vertices.size() < 2) return std::nullopt;
    // The mesh's path may leave the ridge up to a few spacings beside the edge's own pose: the
    // ridge falls off quadratically there, while the mesh misses its floor by the spacing.
    const double bound = found.height_m * (1 + spacing * spacing / 7);
    const double rounding = 1e-7 * found.height_m;
    for (const double radius : {1.25 * spacing, std::min(spacing + std::sqrt(spacing), 0.5)}) {
        if (auto exact = search(found, vertices, radius, bound, rounding)) {
            exact->deepest_m = found.deepest_m;
            return exact;
        }
    }
    return std::nullopt;
}

}  // namespace topple::physics

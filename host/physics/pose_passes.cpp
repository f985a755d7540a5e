// SPDX-License-Identifier: MIT
#include "physics/pose_passes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "physics/vectors.h"

namespace topple::physics {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

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
    Balance result{{}, a, b};
    result.pose.height_m = height;
    result.pose.direction = {-foot[0] / height, -foot[1] / height, -foot[2] / height};
    return result;
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

std::vector<PosePass> passes_to(std::vector<MinimumBehind> behind) {
    std::stable_sort(
        behind.begin(), behind.end(),
        [](const MinimumBehind& a, const MinimumBehind& b) { return a.level_m < b.level_m; });
    std::vector<PosePass> passes;
    for (const MinimumBehind& b : behind) {
        if (passes.empty() || passes.back().height_m != b.level_m) {
            PosePass pass{b.level_m, b.pass, infinity, {}};
            if (!passes.empty()) {
                pass.deepest_m = passes.back().deepest_m;
                pass.deepest = passes.back().deepest;
            }
            passes.push_back(pass);
        }
        if (b.height_m < passes.back().deepest_m) {
            passes.back().deepest_m = b.height_m;
            passes.back().deepest = b.minimum;
        }
    }
    return passes;
}

std::vector<PosePass> find_passes(const Flooded& f) {
    // Only minima need a look: from anywhere behind a pass, one can descend to a minimum that is
    // behind the same pass and deeper.
    std::vector<MinimumBehind> behind;
    for (std::uint32_t v = 0; v < f.height.size(); ++v) {
        if (double{f.level[v]} - f.height[v] > f.noise_m && is_minimum(f, v)) {
            behind.push_back({f.level[v], f.height[v], {}, direction_of(*f.mesh, v)});
        }
    }
    std::vector<PosePass> passes = passes_to(std::move(behind));
    // A level is the height of the pass's own direction.
    std::vector<bool> placed(passes.size(), false);
    for (std::uint32_t v = 0; v < f.height.size() && !passes.empty(); ++v) {
        if (f.level[v] != f.height[v]) continue;
        const auto at = std::lower_bound(
            passes.begin(), passes.end(), double{f.level[v]},
            [](const PosePass& pass, double level) { return pass.height_m < level; });
        if (at == passes.end() || at->height_m != double{f.level[v]}) continue;
        const auto n = static_cast<std::size_t>(at - passes.begin());
        if (placed[n]) continue;
        placed[n] = true;
        at->direction = direction_of(*f.mesh, v);
    }
    return passes;
}

bool rolls(const Flooded& f) {
    const Vec3 start = direction_of(*f.mesh, f.start);
    const double level = f.height[f.start];
    std::vector<bool> seen(f.height.size(), false);
    std::vector<std::uint32_t> next{f.start};
    seen[f.start] = true;
    while (!next.empty()) {
        const std::uint32_t v = next.back();
        next.pop_back();
        if (dot(direction_of(*f.mesh, v), start) <= 0) return true;
        for (std::size_t k = 0; k < 6; ++k) {
            const std::uint32_t w = f.mesh->neighbour[std::size_t{v} * 6 + k];
            if (seen[w] || std::abs(f.height[w] - level) > f.noise_m) continue;
            seen[w] = true;
            next.push_back(w);
        }
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
            exact->deepest = found.deepest;
            return exact;
        }
    }
    return std::nullopt;
}

double refine_minimum(const Vec3& direction, std::span<const Vec3> vertices, double spacing) {
    // Only what lies low enough can become the lowest within reach.
    double low = infinity, reach = 0;
    for (const Vec3& v : vertices) {
        low = std::min(low, dot(v, direction));
        reach = std::max(reach, dot(v, v));
    }
    std::vector<Vec3> near;
    for (const Vec3& v : vertices) {
        if (dot(v, direction) <= low + 4 * spacing * std::sqrt(reach)) near.push_back(v);
    }
    const auto height = [&](const Vec3& d) {
        double lowest = infinity;
        for (const Vec3& v : near) lowest = std::min(lowest, dot(v, d));
        return -lowest;
    };
    Vec3 at = direction;
    double best = height(at);
    // A basis across the direction, from the axis that it has least of.
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a) {
        if (std::abs(at[a]) < std::abs(at[axis])) axis = a;
    }
    Vec3 unit{};
    unit[axis] = 1;
    const Vec3 u = cross(at, unit), w = cross(at, u);
    // Moves along creases need fine directions: twelve of them.
    for (double step = spacing; step > spacing / 100; step /= 2) {
        for (int moves = 0; moves < 4; ++moves) {
            Vec3 better = at;
            for (int k = 0; k < 12; ++k) {
                const double angle = k * std::numbers::pi / 6, c = step * std::cos(angle),
                             s = step * std::sin(angle);
                Vec3 d{};
                for (std::size_t a = 0; a < 3; ++a) d[a] = at[a] + c * u[a] + s * w[a];
                const double length = std::sqrt(dot(d, d));
                for (double& x : d) x /= length;
                if (dot(d, direction) < std::cos(2 * spacing)) continue;
                if (const double h = height(d); h < best) {
                    best = h;
                    better = d;
                }
            }
            if (better == at) break;
            at = better;
        }
    }
    return best;
}

}  // namespace topple::physics

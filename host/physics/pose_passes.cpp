// SPDX-License-Identifier: MIT
#include "physics/pose_passes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/vectors.h"
#include "physics/infinity.h"

namespace topple::physics {
namespace {

// visit(v . direction, v) for all vertices that can be the lowest, to `rounding`, in a direction
// that is at most `radius` radians away: that turn gains v on the one that is lowest now by no more
// than their distance times the turn's chord.
template <typename Visit>
void for_lowest(std::span<const Vec3> vertices, const Vec3& direction, double radius,
                double rounding, const Visit& visit) {
    const Vec3* lowest = nullptr;
    double low = infinity;
    for (const Vec3& v : vertices) {
        const double height = dot(v, direction);
        if (height >= low) continue;
        low = height;
        lowest = &v;
    }
    const double chord = 2 * std::sin(radius / 2) * (1 + 1e-9);
    for (const Vec3& v : vertices) {
        const double height = dot(v, direction), above = height - low - rounding;
        const Vec3 apart = minus(v, *lowest);
        if (above <= 0 || above * above <= chord * chord * dot(apart, apart)) visit(height, v);
    }
}

// The pose in which the centre of mass (the origin) stands above an edge, if it can.
struct Balance {
    double height_m = 0;
    Vec3 foot{};  // of the plumb line, on the edge

    Vec3 direction() const {
        return {-foot[0] / height_m, -foot[1] / height_m, -foot[2] / height_m};
    }
};
std::optional<Balance> balance(const Vec3& a, const Vec3& b) {
    const Vec3 e = minus(b, a);
    const double length2 = dot(e, e), along = -dot(a, e);
    // Most pairs end here, without a division.
    if (!(length2 > 0) || along < 0 || along > length2) return std::nullopt;
    const double t = along / length2;
    const Vec3 foot{a[0] + t * e[0], a[1] + t * e[1], a[2] + t * e[2]};
    const double height = std::sqrt(dot(foot, foot));
    if (!(height > 0)) return std::nullopt;
    return Balance{height, foot};
}

// Whether the pose rests on the edge a-b alone: no vertex lower, and not on vertices on both sides
// of it, which would make it a face and the pose a minimum. What is lower is likely among the
// first.
bool is_pass(const Balance& balanced, const Vec3& a, const Vec3& b, std::span<const Vec3> first,
             std::span<const Vec3> vertices, double rounding) {
    const Vec3 up = balanced.direction();
    for (const Vec3& v : first) {
        if (-dot(v, up) - balanced.height_m > rounding) return false;
    }
    const Vec3 across = cross(minus(b, a), up);
    const double width = std::sqrt(dot(across, across));
    bool left = false, right = false;
    for (const Vec3& v : vertices) {
        const double below = -dot(v, up) - balanced.height_m;
        if (below > rounding) return false;
        if (below < -rounding) continue;
        const double side = dot(minus(v, a), across) / width;
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
    std::vector<std::pair<double, Vec3>> low;
    for_lowest(vertices, found.direction, radius, rounding,
               [&](double height, const Vec3& v) { low.emplace_back(height, v); });
    std::stable_sort(low.begin(), low.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    low.resize(std::min(keep, low.size()));
    std::vector<Vec3> near;
    for (const auto& [height, v] : low) near.push_back(v);
    struct Edge {
        double height_m = 0;
        std::uint32_t p = 0, q = 0;
    };
    const double least_turn = std::cos(radius);
    std::vector<Edge> edges;
    for (std::uint32_t p = 0; p < near.size(); ++p) {
        for (std::uint32_t q = p + 1; q < near.size(); ++q) {
            const auto pose = balance(near[p], near[q]);
            if (pose && pose->height_m <= bound &&
                dot(pose->direction(), found.direction) >= least_turn)
                edges.push_back({pose->height_m, p, q});
        }
    }
    // The highest first, of equal ones the first.
    const auto later = [](const Edge& a, const Edge& b) {
        if (a.height_m != b.height_m) return a.height_m < b.height_m;
        return a.p != b.p ? a.p > b.p : a.q > b.q;
    };
    std::make_heap(edges.begin(), edges.end(), later);
    while (!edges.empty()) {
        const auto& [height, p, q] = edges.front();
        const Balance pose = *balance(near[p], near[q]);
        if (is_pass(pose, near[p], near[q], near, vertices, rounding))
            return PosePass{pose.height_m, pose.direction(), 0, {}, Ends{near[p], near[q]}};
        std::pop_heap(edges.begin(), edges.end(), later);
        edges.pop_back();
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
            PosePass pass{b.level_m, b.pass, infinity, {}, b.edge};
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

std::vector<PosePass> passes_that_matter(std::vector<PosePass> passes) {
    std::vector<PosePass> kept;
    for (const PosePass& pass : passes) {
        if (kept.empty() || pass.deepest_m < kept.back().deepest_m) kept.push_back(pass);
    }
    return kept;
}

std::vector<PosePass> find_passes(const Sampled& f) {
    // Only minima need a look: from anywhere behind a pass, one can descend to a minimum that is
    // behind the same pass and deeper.
    std::vector<MinimumBehind> behind;
    const std::span<const std::uint32_t> minima = f.basins->minima();
    for (std::size_t b = 0; b < minima.size(); ++b) {
        const float height = f.height[minima[b]], level = f.basins->level_of_minimum(b);
        if (double{level} - height > f.noise_m)
            behind.push_back({level, height, {}, direction_of(*f.mesh, minima[b])});
    }
    std::vector<PosePass> passes = passes_that_matter(passes_to(std::move(behind)));
    // A level is the height of the pass's own direction.
    for (PosePass& pass : passes) {
        const auto level = static_cast<float>(pass.height_m);
        for (std::uint32_t v = 0; v < f.height.size(); ++v) {
            if (f.height[v] != level || f.basins->level(v) != level) continue;
            pass.direction = direction_of(*f.mesh, v);
            break;
        }
    }
    return passes;
}

bool rolls(const Sampled& f) {
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
    const double radius = 2 * spacing;
    std::vector<Vec3> near;
    for_lowest(vertices, direction, radius, 0, [&](double, const Vec3& v) { near.push_back(v); });
    // The height along d, or some height that is no less than `enough`. The vertex that sufficed
    // comes first the next time: it is likely to do so again.
    const auto height = [&](const Vec3& d, double enough) {
        double lowest = infinity;
        for (Vec3& v : near) {
            lowest = std::min(lowest, dot(v, d));
            if (-lowest < enough) continue;
            std::swap(v, near.front());
            break;
        }
        return -lowest;
    };
    Vec3 at = direction;
    double best = height(at, infinity);
    // A basis across the direction, from the axis that it has least of.
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a) {
        if (std::abs(at[a]) < std::abs(at[axis])) axis = a;
    }
    Vec3 unit{};
    unit[axis] = 1;
    const Vec3 u = cross(at, unit), w = cross(at, u);
    // Moves along creases need fine directions: twelve of them.
    std::array<double, 12> cosine, sine;
    for (std::size_t k = 0; k < 12; ++k) {
        const double angle = static_cast<double>(k) * std::numbers::pi / 6;
        cosine[k] = std::cos(angle);
        sine[k] = std::sin(angle);
    }
    const double least_turn = std::cos(radius);
    for (double step = spacing; step > spacing / 100; step /= 2) {
        for (int moves = 0; moves < 4; ++moves) {
            Vec3 better = at;
            for (std::size_t k = 0; k < 12; ++k) {
                const double c = step * cosine[k], s = step * sine[k];
                Vec3 d{};
                for (std::size_t a = 0; a < 3; ++a) d[a] = at[a] + c * u[a] + s * w[a];
                const double length = std::sqrt(dot(d, d));
                for (double& x : d) x /= length;
                if (dot(d, direction) < least_turn) continue;
                if (const double h = height(d, best); h < best) {
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

// SPDX-License-Identifier: MIT
#include "physics/hull_ways.h"

#include <algorithm>

namespace topple::physics {

HullWays::HullWays(std::span<const Vec3> vertices, const Vec3& start)
    : hull_(hull_polytope(vertices, {0, 0, 0})),
      tree_(merge_tree(hull_, 0)),
      start_(start),
      start_height_m_(height(start)),
      rest_(descend(hull_, opposite(start))) {}

void HullWays::settle() {
    start_ = rest();
    start_height_m_ = rest_height();
}

// Up at a node of the merge tree: a face, or the highest point of an edge's arc.
Vec3 HullWays::direction(std::uint32_t node) const {
    if (node < hull_.face.size()) return opposite(hull_.face[node].normal);
    const HullPolytope::Edge& e = hull_.edge[node - hull_.face.size()];
    if (e.turns()) return opposite(unit(e.foot));
    const auto &a = hull_.face[e.face[0]], &b = hull_.face[e.face[1]];
    return opposite(a.height > b.height ? a.normal : b.normal);
}

std::optional<Ends> HullWays::edge(std::uint32_t node) const {
    if (node < hull_.face.size()) return std::nullopt;
    const auto& ends = hull_.edge[node - hull_.face.size()].end;
    return Ends{along({}, hull_.radius, hull_.corner[ends[0]]),
                along({}, hull_.radius, hull_.corner[ends[1]])};
}

std::vector<PosePass> HullWays::passes(double noise_m) const {
    std::vector<PosePass> behind;  // of each minimum, the pass to it from the start
    for (std::uint32_t f = 0; f < hull_.face.size(); ++f) {
        if (!hull_.face[f].minimum) continue;
        PosePass pass{start_height_m_, start_, hull_.face[f].height * hull_.radius,
                      opposite(hull_.face[f].normal)};
        const std::int32_t last = tree_.last_join(rest_, f);
        if (last >= 0) {
            const MergeTree::Basin& basin = tree_.basins[last];
            if (basin.pass * hull_.radius > start_height_m_) {
                pass.height_m = basin.pass * hull_.radius;
                pass.direction = direction(basin.saddle);
                pass.edge = edge(basin.saddle);
            }
        }
        if (pass.height_m - pass.deepest_m > noise_m) behind.push_back(pass);
    }
    std::ranges::stable_sort(behind, {}, &PosePass::height_m);
    std::vector<PosePass> out;
    for (const PosePass& pass : behind) {
        if (!out.empty() && pass.deepest_m >= out.back().deepest_m) continue;
        if (!out.empty() && pass.height_m == out.back().height_m) out.pop_back();
        out.push_back(pass);
    }
    return out;
}

double HullWays::height(const Vec3& up) const {
    const Vec3 down = opposite(up);
    double highest = 0;
    for (const Vec3& v : hull_.corner) highest = std::max(highest, dot(v, down));
    return highest * hull_.radius;
}

double HullWays::level(const Vec3& up) const {
    double level = std::max(start_height_m_, height(up));
    const std::int32_t last = tree_.last_join(rest_, descend(hull_, opposite(up)));
    if (last >= 0) {
        level = std::max(level, tree_.basins[last].pass * hull_.radius);
    }
    return level;
}

bool HullWays::rolls(double noise_m) const {
    const auto near = [&](double height) {
        return std::abs(height * hull_.radius - start_height_m_) <= noise_m;
    };
    std::vector<bool> seen(hull_.face.size(), false);
    std::vector<std::uint32_t> next{rest_};
    seen[rest_] = true;
    while (!next.empty()) {
        const HullPolytope::Face& face = hull_.face[next.back()];
        next.pop_back();
        if (!near(face.height)) continue;
        if (-dot(face.normal, start_) <= 0) return true;
        for (const std::uint32_t n : face.edges) {
            const HullPolytope::Edge& e = hull_.edge[n];
            if (!near(e.highest)) continue;
            for (const std::uint32_t f : e.face) {
                if (seen[f]) continue;
                seen[f] = true;
                next.push_back(f);
            }
        }
    }
    return false;
}

}  // namespace topple::physics

// SPDX-License-Identifier: MIT
#include "export/merge_parts.h"

#include <algorithm>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

#include "export/separate.h"

namespace topple::exports {
namespace {

struct Pair {
    double added_m3;
    std::size_t a, b;
    // Cheapest first, then oldest, so that the order is the same everywhere.
    bool operator<(const Pair& other) const {
        return std::tie(added_m3, a, b) > std::tie(other.added_m3, other.a, other.b);
    }
};

std::optional<ConvexPart> joined(const ConvexPart& a, const ConvexPart& b) {
    std::vector<Vec3> points = a.corner;
    points.insert(points.end(), b.corner.begin(), b.corner.end());
    return hull_part(points);
}

// Each point stands for the mean of both.
void gather(const ConvexPart& a, const ConvexPart& b, ConvexPart& both) {
    both.solid = a.solid;
    both.solid.insert(both.solid.end(), b.solid.begin(), b.solid.end());
    const double solid_m3 = a.solid_each_m3 * static_cast<double>(a.solid.size()) +
                            b.solid_each_m3 * static_cast<double>(b.solid.size());
    both.solid_each_m3 = solid_m3 / std::max<double>(1, static_cast<double>(both.solid.size()));
}

}  // namespace

void merge_parts(std::vector<ConvexPart>& parts, double most_m3, double touching_m) {
    constexpr double most_share = 0.1;
    std::vector<bool> gone(parts.size(), false);
    std::priority_queue<Pair> pairs;
    const auto consider = [&](std::size_t a, std::size_t b) {
        if (gone[a] || gone[b] || !near(parts[a], parts[b], touching_m)) return;
        const auto both = joined(parts[a], parts[b]);
        if (!both) return;
        const double added = both->volume_m3 - parts[a].volume_m3 - parts[b].volume_m3;
        if (added <= most_share * both->volume_m3 && added <= most_m3) pairs.push({added, a, b});
    };
    for (std::size_t a = 0; a < parts.size(); ++a)
        for (std::size_t b = a + 1; b < parts.size(); ++b) consider(a, b);
    while (!pairs.empty()) {
        const Pair best = pairs.top();
        pairs.pop();
        if (gone[best.a] || gone[best.b] || best.added_m3 > most_m3) continue;
        auto both = joined(parts[best.a], parts[best.b]);
        if (!both) continue;
        most_m3 -= std::max(0.0, best.added_m3);
        gather(parts[best.a], parts[best.b], *both);
        gone[best.a] = gone[best.b] = true;
        parts.push_back(*std::move(both));
        gone.push_back(false);
        for (std::size_t n = 0; n + 1 < parts.size(); ++n) consider(n, parts.size() - 1);
    }
    std::vector<ConvexPart> left;
    for (std::size_t n = 0; n < parts.size(); ++n)
        if (!gone[n]) left.push_back(std::move(parts[n]));
    parts = std::move(left);
}

}  // namespace topple::exports

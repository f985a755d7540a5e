// SPDX-License-Identifier: MIT
#include "export/simplify.h"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "core/vectors.h"

namespace topple::exports {
namespace {

// Numbers of the corners that lie furthest along the axes and the diagonals between two or three.
std::vector<std::size_t> ends_of(const ConvexPart& part) {
    std::vector<std::size_t> out;
    for (int n = 0; n < 27; ++n) {
        const Vec3 d{double(n / 9 - 1), double(n / 3 % 3 - 1), double(n % 3 - 1)};
        if (n == 13) continue;
        const auto end =
            std::ranges::max_element(part.corner, {}, [&](const Vec3& c) { return dot(d, c); });
        out.push_back(static_cast<std::size_t>(end - part.corner.begin()));
    }
    std::ranges::sort(out);
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

// For each face the corner of the part furthest beyond it, if beyond the tolerance; furthest first.
std::vector<std::pair<double, std::size_t>> missed(const ConvexPart& part, const ConvexPart& hull,
                                                   double tolerance_m) {
    std::vector<std::pair<double, std::size_t>> out;
    for (const HalfSpace& side : hull.face) {
        double most = tolerance_m;
        std::size_t at = part.corner.size();
        for (std::size_t n = 0; n < part.corner.size(); ++n) {
            const double beyond = dot(side.normal, part.corner[n]) - side.offset_m;
            if (beyond <= most) continue;
            most = beyond;
            at = n;
        }
        if (at < part.corner.size()) out.emplace_back(most, at);
    }
    std::ranges::sort(out, std::greater<>());
    return out;
}

}  // namespace

ConvexPart simplified(ConvexPart part, double tolerance_m) {
    constexpr std::size_t few = 16;
    if (part.corner.size() <= few) return part;
    std::vector<std::size_t> kept = ends_of(part);
    std::vector<bool> taken(part.corner.size(), false);
    for (const std::size_t n : kept) taken[n] = true;
    for (;;) {
        std::vector<Vec3> points;
        for (const std::size_t n : kept) points.push_back(part.corner[n]);
        auto hull = reshaped(part, points);
        if (!hull) return part;
        const std::size_t before = kept.size();
        for (const auto& [beyond, n] : missed(part, *hull, tolerance_m)) {
            if (taken[n] || kept.size() >= most_corners) continue;
            taken[n] = true;
            kept.push_back(n);
        }
        if (kept.size() == before) return *std::move(hull);
    }
}

}  // namespace topple::exports

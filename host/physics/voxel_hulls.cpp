// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>

#include "physics/part_hulls.h"
#include "physics/qhull.h"
#include "topple/error.h"

namespace topple::physics {
namespace {

using Corner = std::array<std::int32_t, 3>;

std::int64_t turn(const Corner& o, const Corner& a, const Corner& b) {
    return (std::int64_t{a[1]} - o[1]) * (std::int64_t{b[2]} - o[2]) -
           (std::int64_t{a[2]} - o[2]) * (std::int64_t{b[1]} - o[1]);
}

// Convex hull of points of one slice in (j, k), by the monotone chain; strict corners only. The
// points come sorted and distinct.
std::vector<Corner> slice_hull(const std::vector<Corner>& points) {
    if (points.size() < 3) return points;
    std::vector<Corner> hull;
    for (int side = 0; side < 2; ++side) {
        const std::size_t base = hull.size();
        const auto add = [&](const Corner& p) {
            while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) {
                hull.pop_back();
            }
            hull.push_back(p);
        };
        if (side == 0) {
            for (auto p = points.begin(); p != points.end(); ++p) add(*p);
        } else {
            for (auto p = points.rbegin(); p != points.rend(); ++p) add(*p);
        }
        hull.pop_back();  // the other side starts with it
    }
    return hull;
}

std::vector<Corner> reduce(std::vector<Corner> corners) {
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    if (corners.size() <= 8) return corners;
    std::vector<std::array<double, 3>> points;
    for (const Corner& c : corners) {
        points.push_back({double(c[0]) - corners.front()[0], double(c[1]) - corners.front()[1],
                          double(c[2]) - corners.front()[2]});
    }
    const auto kept = convex_hull(points);
    if (!kept) return corners;  // the slices' corners have the same hull, only more of them
    std::vector<Corner> hull;
    for (const std::uint32_t n : kept->vertices) hull.push_back(corners[n]);
    return hull;
}

}  // namespace

std::vector<std::vector<Corner>> voxel_hulls(const SolidCells& cells, std::int32_t primitives) {
    std::vector<std::vector<Corner>> corners(static_cast<std::size_t>(primitives));
    // Per primitive and column of the slice: its lowest and highest cell.
    struct Column {
        std::int32_t i, j, low, high;
    };
    std::vector<std::vector<Column>> columns(corners.size());
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const std::int32_t label = cells.primitive[n];
        if (label < 0) continue;
        if (label >= primitives) {
            throw Error(ErrorKind::input, "solid cells: primitive " + std::to_string(label) +
                                              " is not below " + std::to_string(primitives));
        }
        auto& list = columns[label];
        if (list.empty() || list.back().i != cells.i[n] || list.back().j != cells.j[n]) {
            list.push_back({cells.i[n], cells.j[n], cells.k[n], cells.k[n]});
        } else {
            list.back().low = std::min(list.back().low, cells.k[n]);
            list.back().high = std::max(list.back().high, cells.k[n]);
        }
    }
    for (std::size_t label = 0; label < corners.size(); ++label) {
        const auto& list = columns[label];
        for (std::size_t c = 0; c < list.size();) {
            const std::int32_t i = list[c].i;
            std::vector<Corner> slice;
            for (; c < list.size() && list[c].i == i; ++c) {
                for (const std::int32_t j : {list[c].j, list[c].j + 1}) {
                    slice.push_back({i, j, list[c].low});
                    slice.push_back({i, j, list[c].high + 1});
                }
            }
            std::sort(slice.begin(), slice.end());
            slice.erase(std::unique(slice.begin(), slice.end()), slice.end());
            for (Corner p : slice_hull(slice)) {
                corners[label].push_back(p);
                ++p[0];
                corners[label].push_back(p);
            }
        }
        corners[label] = reduce(std::move(corners[label]));
    }
    return corners;
}

}  // namespace topple::physics

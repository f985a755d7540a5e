// SPDX-License-Identifier: MIT
#include "objects/object_boxes.h"

#include <algorithm>
#include <limits>

#include "solids/cell_shape.h"

namespace topple {
namespace {

constexpr double nowhere = std::numeric_limits<double>::infinity();

struct Ends {
    Vec3 low{nowhere, nowhere, nowhere}, high{-nowhere, -nowhere, -nowhere};
    void add(const Vec3& p) {
        for (std::size_t a = 0; a < 3; ++a) {
            low[a] = std::min(low[a], p[a]);
            high[a] = std::max(high[a], p[a]);
        }
    }
    bool holds(const Vec3& from, const Vec3& to) const {
        for (std::size_t a = 0; a < 3; ++a)
            if (from[a] < low[a] || to[a] > high[a]) return false;
        return true;
    }
};

}  // namespace

std::vector<ObjectBox> object_boxes(const SolidScene& solids, ObjectOf object_of,
                                    std::size_t objects) {
    const SolidCells& cells = solids.cells();
    const BoundaryCells& boundary = solids.boundary();
    const double h = cells.voxel_m;
    Table<ObjectId, Ends> ends(objects);
    // That of an object, where a voxel may widen it.
    const auto widened = [&](PrimitiveId primitive, const Vec3& from, const Vec3& to) -> Ends* {
        const ObjectId o = object_of(primitive);
        if (o < 0) return nullptr;
        Ends& box = ends[o];
        return box.holds(from, to) ? nullptr : &box;
    };
    for (std::size_t c = 0; c < cells.size(); ++c) {
        const Vec3 from{cells.i[c] * h, cells.j[c] * h, cells.k[c] * h};
        const Vec3 to{from[0] + h, from[1] + h, from[2] + h};
        Ends* const box = widened(cells.primitive[c], from, to);
        if (!box || boundary.find(cells.i[c], cells.j[c], cells.k[c], cells.primitive[c]) !=
                        BoundaryCells::absent)
            continue;
        box->add(from);
        box->add(to);
    }
    std::vector<Vec3> corners;
    for (std::size_t b = 0; b < boundary.size(); ++b) {
        const Vec3 from{boundary.i[b] * h, boundary.j[b] * h, boundary.k[b] * h};
        Ends* const box =
            widened(boundary.primitive[b], from, {from[0] + h, from[1] + h, from[2] + h});
        if (!box || boundary.share[b] == 0) continue;
        corners.clear();
        solids::add_corners(boundary, b, h, corners);
        for (const Vec3& corner : corners) box->add(corner);
    }
    std::vector<ObjectBox> out(objects);
    for (std::size_t o = 0; o < objects; ++o) {
        const auto& [low, high] = ends[o];
        if (!(low[0] <= high[0])) continue;
        for (std::size_t a = 0; a < 3; ++a) {
            out[o].size_m[a] = high[a] - low[a];
            out[o].middle_m[a] = (low[a] + high[a]) / 2;
        }
    }
    return out;
}

}  // namespace topple

// SPDX-License-Identifier: MIT
#include "physics/closed_furniture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "physics/rectangle.h"
#include "physics/tipping.h"

namespace topple::physics {
namespace {

constexpr double backing_reach_m = 0.08;

// By how far is looked behind an object: a voxel less than that, that, and a voxel more.
using Backing = std::array<double, 3>;

using Point = std::array<double, 2>;

struct FootOutline {
    std::vector<Point> corners;  // of its columns
    std::int32_t lowest = std::numeric_limits<std::int32_t>::max();
    std::int32_t highest = std::numeric_limits<std::int32_t>::min();
};

class Sight {
  public:
    Sight(const SolidCells& cells, const CellColumns& columns,
          std::span<const std::int32_t> object_of_primitive, const std::vector<bool>& room)
        : cells_(cells), columns_(columns), object_(object_of_primitive), room_(room) {}

    // Of a rectangle's side the share of what the object has within reach of it that has the room
    // within reach of that.
    Backing backed(const Rectangle& r, std::size_t axis, int way, const FootOutline& of,
                   std::int32_t object) const {
        const double h = cells_.voxel_m, step = 2 * h;  // along the side
        const auto reach = static_cast<int>(std::max<double>(1, std::lround(backing_reach_m / h)));
        const Point &out = r.axes[axis], &along = r.axes[1 - axis];
        std::size_t solid = 0;
        std::array<std::size_t, 3> before{};
        for (double s = -r.half[1 - axis] + h; s < r.half[1 - axis]; s += step) {
            for (std::int32_t k = of.lowest; k <= of.highest; k += 2) {
                const auto cell = [&](int n) {  // n voxels beyond the side
                    const double t = way * (r.half[axis] + (n - 0.5) * h);
                    return primitive(r.middle[0] + t * out[0] + s * along[0],
                                     r.middle[1] + t * out[1] + s * along[1], k);
                };
                // The object may end short of its box, and go a little way into a wall, of which
                // nobody knows how thick it is.
                int last = 1;
                bool own = false;
                while (!own && last > -reach) {
                    const std::int32_t p = cell(--last);
                    own = p >= 0 && object_[p] == object;
                }
                if (!own) continue;
                ++solid;
                const auto behind = [&](int n) {
                    const std::int32_t p = cell(n);
                    return p >= 0 && room_[p];
                };
                int away = 0;
                while (away <= reach + 1 && !behind(last - away) && !behind(last + away)) ++away;
                for (int more = -1; more <= 1; ++more) before[more + 1] += away <= reach + more;
            }
        }
        Backing share{};
        for (std::size_t n = 0; n < share.size() && solid > 0; ++n)
            share[n] = static_cast<double>(before[n]) / static_cast<double>(solid);
        return share;
    }

  private:
    std::int32_t primitive(double x, double y, std::int32_t k) const {
        const auto [first, last] =
            columns_.at(static_cast<std::int32_t>(std::floor(x / cells_.voxel_m)),
                        static_cast<std::int32_t>(std::floor(y / cells_.voxel_m)));
        const auto begin = cells_.k.begin() + static_cast<std::ptrdiff_t>(first),
                   end = cells_.k.begin() + static_cast<std::ptrdiff_t>(last);
        const auto found = std::lower_bound(begin, end, k);
        if (found == end || *found != k) return -1;
        return cells_.primitive[found - cells_.k.begin()];
    }

    const SolidCells& cells_;
    const CellColumns& columns_;
    std::span<const std::int32_t> object_;
    const std::vector<bool>& room_;
};

std::vector<FootOutline> foot_outlines(const SolidCells& cells,
                                       std::span<const std::int32_t> object_of_primitive,
                                       const std::vector<bool>& room, std::size_t objects) {
    std::vector<FootOutline> out(objects);
    const double h = cells.voxel_m;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const std::int32_t p = cells.primitive[n];
        if (p < 0 || room[p]) continue;
        FootOutline& f = out[object_of_primitive[p]];
        f.lowest = std::min(f.lowest, cells.k[n]);
        f.highest = std::max(f.highest, cells.k[n]);
        const Point low{cells.i[n] * h, cells.j[n] * h};
        // Cells of a column follow each other.
        if (!f.corners.empty() && f.corners.back() == low) continue;
        f.corners.push_back({low[0] + h, low[1] + h});
        f.corners.push_back({low[0] + h, low[1]});
        f.corners.push_back({low[0], low[1] + h});
        f.corners.push_back(low);
    }
    return out;
}

}  // namespace

std::vector<FurnitureLooks> furniture_looks(const SolidScene& solids,
                                            std::span<const std::int32_t> object_of_primitive,
                                            std::span<const double> volumes_m3) {
    const SolidCells& cells = solids.cells();
    const std::vector<bool> room = solids.shell();
    const Sight sight(cells, solids.columns(), object_of_primitive, room);
    std::vector<FootOutline> of =
        foot_outlines(cells, object_of_primitive, room, volumes_m3.size());
    std::vector<FurnitureLooks> out(volumes_m3.size());
    for (std::size_t o = 0; o < out.size(); ++o) {
        if (of[o].corners.empty()) continue;
        const Rectangle box = smallest_rectangle(convex_polygon(std::move(of[o].corners)));
        const double height = cells.voxel_m * (of[o].highest - of[o].lowest + 1);
        out[o].height_m = height;
        out[o].fill = std::min(1.0, volumes_m3[o] / (box.area() * height));
        out[o].box_side_m2 = 2 * box.area() + 4 * (box.half[0] + box.half[1]) * height;
        out[o].box_m = {2 * std::min(box.half[0], box.half[1]),
                        2 * std::max(box.half[0], box.half[1])};
        if (out[o].fill < least_furniture_fill) continue;
        for (const std::size_t axis : {std::size_t{0}, std::size_t{1}})
            for (const int way : {-1, 1}) {
                const auto [less, usual, more] =
                    sight.backed(box, axis, way, of[o], static_cast<std::int32_t>(o));
                if (usual > out[o].backing) {
                    out[o].backing = usual;
                    out[o].front = {-way * box.axes[axis][0], -way * box.axes[axis][1]};
                    out[o].deep_m = 2 * box.half[axis];
                }
                out[o].backing_range = {std::max(out[o].backing_range[0], less),
                                        std::max(out[o].backing_range[1], more)};
            }
    }
    return out;
}

double log_odds_closed(const FurnitureLooks& looks, double backing) {
    constexpr double offset = -2.58, per_metre = 7.34;  // tests/fitting/fit_closed.py
    return offset + per_metre * looks.height_m * looks.fill * backing;
}

double probability_closed(const FurnitureLooks& looks) {
    return 1 / (1 + std::exp(-log_odds_closed(looks, looks.backing)));
}

ClosedBody closed_body(const FurnitureLooks& looks, double volume_m3, double board_kg_m3,
                       double contents_kg_m3) {
    ClosedBody out;
    if (!(volume_m3 > 0)) return out;
    // The sides of what fills its box only in part are shorter by about as much.
    const double side_m2 = looks.box_side_m2 * std::pow(looks.fill, 2.0 / 3);
    const double inner = std::max(0.0, 1 - side_m2 * ClosedBody::board_m / volume_m3);
    out.density_kg_m3 = board_kg_m3 * (1 - inner) + contents_kg_m3 * inner;
    // The inside is the outside made smaller; moments go with the fifth power of lengths.
    const double inner_moment = std::pow(inner, 5.0 / 3);
    out.inertia_density_kg_m3 = board_kg_m3 * (1 - inner_moment) + contents_kg_m3 * inner_moment;
    // Even distributions of a width w have the standard deviation w / sqrt(12).
    const double contents_kg = contents_kg_m3 * inner * volume_m3;
    out.error.mass_kg = 2 * contents_kg / std::sqrt(12.0);
    const double mass_kg = out.density_kg_m3 * volume_m3;
    out.contents_share = mass_kg > 0 ? contents_kg / mass_kg : 0;
    out.error.center_m[2] =
        mass_kg > 0 ? contents_kg / mass_kg * looks.height_m / 2 / std::sqrt(12.0) : 0;
    return out;
}

Drawers drawers_of(const FurnitureLooks& looks, double closed, const ClosedBody& body) {
    // Doors are as frequent, of which nothing hangs that weighs; set by hand. Drawers without a
    // stop are tested at two thirds of their way.
    constexpr double have_drawers = 0.5, drawn = 2.0 / 3;
    return {have_drawers * closed, looks.front, drawn * looks.deep_m, body.contents_share};
}

}  // namespace topple::physics

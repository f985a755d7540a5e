// SPDX-License-Identifier: MIT
#include "safety/objects.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "core/scan_gaps.h"
#include "physics/landscape.h"
#include "physics/sliding.h"
#include "safety/columns.h"

namespace topple::safety {

std::vector<std::int32_t> movable_object_of_cells(const Surroundings& surroundings,
                                                  std::span<const RiskObject> objects) {
    std::vector<std::int32_t> out = surroundings.object;
    for (std::int32_t& o : out) {
        const auto at = static_cast<std::size_t>(o);  // of -1 it is beyond all
        if (at >= objects.size() || objects[at].grounded) o = -1;
    }
    return out;
}

bool is_floor_cell(const Surroundings& surroundings, std::size_t cell) {
    const std::int32_t primitive = surroundings.cells->primitive[cell];
    return primitive >= 0 &&
           static_cast<std::size_t>(primitive) < surroundings.is_floor_primitive.size() &&
           surroundings.is_floor_primitive[primitive];
}

std::vector<std::vector<std::uint32_t>> cells_of_objects(
    std::span<const std::int32_t> object_of_cell, std::size_t objects) {
    std::vector<std::vector<std::uint32_t>> out(objects);
    for (std::size_t c = 0; c < object_of_cell.size(); ++c) {
        if (object_of_cell[c] >= 0) {
            out[object_of_cell[c]].push_back(static_cast<std::uint32_t>(c));
        }
    }
    return out;
}

MassSpread stance(const Surroundings& surroundings, std::span<const std::uint32_t> of_object,
                  const RiskObject& object) {
    const SolidCells& cells = *surroundings.cells;
    MassSpread out;
    if (of_object.empty()) return out;
    const auto weight = [&](std::uint32_t c) {
        const auto primitive = static_cast<std::size_t>(cells.primitive[c]);
        return primitive < surroundings.density_kg_m3.size() ? surroundings.density_kg_m3[primitive]
                                                             : 1.0;
    };
    double all = 0, x = 0, y = 0, z = 0;
    std::int32_t low = cells.k[of_object.front()], high = low;
    for (const std::uint32_t c : of_object) {
        const double w = weight(c);
        all += w;
        x += w * (cells.i[c] + 0.5);
        y += w * (cells.j[c] + 0.5);
        z += w * (cells.k[c] + 0.5);
        low = std::min(low, cells.k[c]);
        high = std::max(high, cells.k[c]);
    }
    x /= all;
    y /= all;
    z /= all;
    double xx = 0, xy = 0, yy = 0, zz = 0;
    for (const std::uint32_t c : of_object) {
        const double w = weight(c);
        const double dx = cells.i[c] + 0.5 - x, dy = cells.j[c] + 0.5 - y,
                     dz = cells.k[c] + 0.5 - z;
        xx += w * dx * dx;
        xy += w * dx * dy;
        yy += w * dy * dy;
        zz += w * dz * dz;
    }
    const double voxel = cells.voxel_m, voxel2 = voxel * voxel, own = 1.0 / 12;  // of a unit cube
    out.center = object.center.value_or(Vec3{x * voxel, y * voxel, z * voxel});
    out.bottom_m = std::isnan(object.base_m) ? low * voxel : object.base_m;
    out.top_m = (high + 1.0) * voxel;
    out.spread_m2 = {(xx / all + own) * voxel2, xy / all * voxel2, (yy / all + own) * voxel2,
                     (zz / all + own) * voxel2};
    return out;
}

double half_base(const RiskObject& object, const MassSpread& stance, double dx, double dy) {
    const auto& polygon = object.support_polygon;
    if (polygon.size() < 3) return std::max(0.0, object.base_width_m / 2 + object.border_shift_m);
    // The nearest edge that the ray leaves through; inside a convex polygon that is the way out.
    double reach = INFINITY;
    for (std::size_t e = 0; e < polygon.size(); ++e) {
        const auto& a = polygon[e];
        const auto& b = polygon[(e + 1) % polygon.size()];
        const double nx = b[1] - a[1],
                     ny = a[0] - b[0];  // outward, as the polygon runs counter-clockwise
        const double along = dx * nx + dy * ny;
        const double inside = (a[0] - stance.center[0]) * nx + (a[1] - stance.center[1]) * ny;
        if (along > 0) reach = std::min(reach, inside / along);
    }
    return std::isfinite(reach) ? std::max(0.0, reach + object.border_shift_m) : 0.0;
}

double support_reach(const MassSpread& stance, const Columns& columns, double dx, double dy) {
    const double voxel = columns.voxel_m();
    // The layers below its base that it may rest on.
    constexpr std::int64_t layers = contact_gap + 1;
    constexpr std::uint64_t in_layers = (std::uint64_t{1} << layers) - 1;
    const auto below = static_cast<std::int64_t>(std::lround(stance.bottom_m / voxel)) - layers;
    double way = 0;
    for (; way < physics::longest_slide_m; way += voxel / 2) {
        const double x = stance.center[0] + way * dx, y = stance.center[1] + way * dy;
        const std::uint64_t solid =
            columns.solid(static_cast<std::int64_t>(std::floor(x / voxel)),
                          static_cast<std::int64_t>(std::floor(y / voxel)), below);
        if ((solid & in_layers) == 0) return way;
    }
    return INFINITY;
}

Profile profile(const RiskObject& object, const MassSpread& stance, const Columns& columns,
                double dx, double dy) {
    return {half_base(object, stance, dx, dy),
            half_base(object, stance, -dx, -dy),
            stance.height(),
            std::sqrt(stance.gyration_m2(dx, dy)),
            support_reach(stance, columns, dx, dy),
            support_reach(stance, columns, -dx, -dy)};
}

double tipping_energy(double mass_kg, double height_m, double half_base_m) {
    // sqrt(h^2 + b^2) - h without the cancellation
    const double diagonal = std::hypot(height_m, half_base_m);
    const double rise = diagonal > 0 ? half_base_m * half_base_m / (diagonal + height_m) : 0;
    return mass_kg * physics::gravity * rise;
}

// A heap of the arrows with the smallest random keys, the largest of these first.
struct ArrowSample::Arrow {
    std::uint64_t key, order;
    float x, y, z, vx, vy, vz, density;
    bool operator<(const Arrow& other) const {
        return key != other.key ? key < other.key : order < other.order;
    }
};

ArrowSample::ArrowSample() = default;
ArrowSample::~ArrowSample() = default;

void ArrowSample::offer(const Vec3& at, const Vec3& along, double density) {
    const std::uint64_t order = offered_++;
    const std::uint64_t key = Random(order).bits();
    if (heap_.size() == max_samples && heap_.front().key <= key) return;
    const auto f = [](double v) { return static_cast<float>(v); };
    heap_.push_back({key, order, f(at[0]), f(at[1]), f(at[2]), f(along[0]), f(along[1]),
                     f(along[2]), f(density)});
    std::push_heap(heap_.begin(), heap_.end());
    if (heap_.size() > max_samples) {
        std::pop_heap(heap_.begin(), heap_.end());
        heap_.pop_back();
    }
}

FieldSamples ArrowSample::take() {
    std::sort(heap_.begin(), heap_.end(),
              [](const Arrow& a, const Arrow& b) { return a.order < b.order; });
    FieldSamples out;
    for (const Arrow& a : heap_) {
        out.x.push_back(a.x);
        out.y.push_back(a.y);
        out.z.push_back(a.z);
        out.vx.push_back(a.vx);
        out.vy.push_back(a.vy);
        out.vz.push_back(a.vz);
        out.density.push_back(a.density);
    }
    heap_.clear();
    return out;
}

}  // namespace topple::safety

// SPDX-License-Identifier: MIT
#include "lab/scan/points.h"

#include <algorithm>
#include <cmath>

namespace topple::scenes {
namespace {

// Cubes are numbered along z, then y, then x; 17 bits each reach 600 m at 1 cm.
constexpr std::uint64_t axis_bits = 17, axis_cells = std::uint64_t{1} << axis_bits;

std::uint64_t cell_of(double x, double edge) {
    const double cell = std::floor(x / edge) + static_cast<double>(axis_cells / 2);
    return static_cast<std::uint64_t>(std::clamp(cell, 1.0, static_cast<double>(axis_cells - 2)));
}

// use(index, squared distance) for each point within `radius`, by its cubes of that edge.
template <class Point, class Use>
void for_each_near(const std::vector<Point>& points, const std::vector<Keyed>& order,
                   const Vec3& place, double radius, const Use& use) {
    const std::uint64_t middle = cube(place, radius);
    for (const std::int64_t dx : {-1, 0, 1}) {
        for (const std::int64_t dy : {-1, 0, 1}) {
            constexpr auto cells = static_cast<std::int64_t>(axis_cells);
            const auto row = middle + static_cast<std::uint64_t>((dx * cells + dy) * cells);
            auto k = std::lower_bound(order.begin(), order.end(), Keyed{row - 1, 0});
            for (; k != order.end() && k->key <= row + 1; ++k) {
                const Vec3& q = points[k->at].at;
                const double x = q[0] - place[0], y = q[1] - place[1], z = q[2] - place[2];
                const double squared = x * x + y * y + z * z;
                if (squared <= radius * radius) use(k->at, squared);
            }
        }
    }
}

// Sums of points, for means.
struct Sum {
    std::array<double, 6> of{};
    std::uint32_t count = 0;

    void add(const ColouredPoint& p) {
        for (std::size_t a = 0; a < 3; ++a) {
            of[a] += p.at[a];
            of[3 + a] += p.colour[a];
        }
        ++count;
    }
    ColouredPoint mean() const {
        ColouredPoint p;
        for (std::size_t a = 0; a < 3; ++a) {
            p.at[a] = of[a] / count;
            p.colour[a] = static_cast<std::uint8_t>(of[3 + a] / count);
        }
        return p;
    }
};

}  // namespace

std::uint64_t cube(const Vec3& p, double edge) {
    return (cell_of(p[0], edge) * axis_cells + cell_of(p[1], edge)) * axis_cells +
           cell_of(p[2], edge);
}

std::vector<ColouredPoint> fused(const std::vector<ColouredPoint>& points, double edge,
                                 std::uint32_t least) {
    std::vector<ColouredPoint> out;
    for_each_cube(points, edge, [&](std::span<const Keyed> cube) {
        if (cube.size() < least) return;
        Sum sum;
        for (const Keyed& one : cube) sum.add(points[one.at]);
        out.push_back(sum.mean());
    });
    return out;
}

void smooth_among(std::vector<ColouredPoint>& points, const std::vector<ColouredPoint>& among,
                  double radius, double share) {
    const auto order = by_cube(among, radius);
    for (ColouredPoint& p : points) {
        Sum sum;
        for_each_near(among, order, p.at, radius,
                      [&](std::uint32_t at, double) { sum.add(among[at]); });
        if (sum.count == 0) continue;
        const Vec3 mean = sum.mean().at;
        for (std::size_t a = 0; a < 3; ++a) p.at[a] += share * (mean[a] - p.at[a]);
    }
}

void tear_holes(std::vector<ColouredPoint>& points, unsigned count, double least_radius,
                double most_radius, Random& random) {
    for (unsigned n = 0; n < count && !points.empty(); ++n) {
        const auto middle =
            static_cast<std::size_t>(random.uniform() * static_cast<double>(points.size()));
        const Vec3 at = points[middle].at;
        const double radius = random(least_radius, most_radius);
        std::erase_if(points, [&](const ColouredPoint& p) {
            return std::hypot(p.at[0] - at[0], p.at[1] - at[1], p.at[2] - at[2]) < radius;
        });
    }
}

std::vector<LabelledPoint> thinned(const std::vector<LabelledPoint>& points, double things,
                                   double building) {
    struct Cell {
        std::uint64_t cube;
        std::int32_t object;
        std::uint32_t at;
    };
    std::vector<Cell> order(points.size());
    for (std::size_t n = 0; n < points.size(); ++n) {
        const double edge = points[n].object == 0 ? building : things;
        order[n] = {cube(points[n].at, edge), points[n].object, static_cast<std::uint32_t>(n)};
    }
    std::sort(order.begin(), order.end(), [](const Cell& a, const Cell& b) {
        if (a.object != b.object) return a.object < b.object;
        return a.cube != b.cube ? a.cube < b.cube : a.at < b.at;
    });
    std::vector<LabelledPoint> out;
    for (std::size_t n = 0; n < order.size(); ++n) {
        if (n > 0 && order[n].object == order[n - 1].object && order[n].cube == order[n - 1].cube)
            continue;
        out.push_back(points[order[n].at]);
    }
    return out;
}

std::vector<std::int32_t> nearest_objects(const std::vector<Vec3>& places,
                                          const std::vector<LabelledPoint>& truth, double radius) {
    const auto order = by_cube(truth, radius);
    std::vector<std::int32_t> out(places.size(), -1);
    for (std::size_t n = 0; n < places.size(); ++n) {
        double best = 2 * radius * radius;
        std::uint32_t first = 0;
        for_each_near(truth, order, places[n], radius, [&](std::uint32_t at, double squared) {
            if (squared > best || (squared == best && at > first)) return;
            best = squared;
            first = at;
            out[n] = truth[at].object;
        });
    }
    return out;
}

}  // namespace topple::scenes

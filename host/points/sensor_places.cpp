// SPDX-License-Identifier: MIT
#include "points/sensor_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "core/room_measures.h"
#include "core/vectors.h"

namespace topple::geometry {
namespace {

constexpr double place_m = 0.05;  // a sensor that moved by less stood still

double square_between(const Vec3& a, const Vec3& b) {
    const Vec3 d = minus(a, b);
    return dot(d, d);
}

std::uint32_t nearest(const std::vector<Vec3>& places, const Vec3& point) {
    const auto at = std::ranges::min_element(
        places, {}, [&](const Vec3& place) { return square_between(place, point); });
    return static_cast<std::uint32_t>(at - places.begin());
}

}  // namespace

SensorPlaces sensor_places(const CloudView& cloud) {
    struct Cell {
        std::uint32_t number = 0;
        std::uint64_t points = 0;
        Vec3 sum{};
    };
    SensorPlaces out;
    if (cloud.viewpoint_x.empty()) return out;
    std::map<std::array<std::int64_t, 3>, Cell> cells;
    const auto place = [&](std::size_t i) {
        return Vec3{cloud.viewpoint_x[i], cloud.viewpoint_y[i], cloud.viewpoint_z[i]};
    };
    const auto cell_of = [&](const Vec3& p) {
        std::array<std::int64_t, 3> cell{};
        for (std::size_t a = 0; a < 3; ++a)
            cell[a] = static_cast<std::int64_t>(std::floor(p[a] / place_m));
        return cell;
    };
    const auto known = [](const Vec3& p) {
        return std::ranges::all_of(p, [](double v) { return std::abs(v) <= farthest_m; });
    };
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Vec3 p = place(i);
        if (!known(p)) {
            ++out.unknown;
            continue;
        }
        Cell& cell = cells[cell_of(p)];
        ++cell.points;
        for (std::size_t a = 0; a < 3; ++a) cell.sum[a] += p[a];
    }
    if (cells.empty()) return out;
    for (auto& [key, cell] : cells) {  // in order, whatever the points' order
        cell.number = static_cast<std::uint32_t>(out.places.size());
        for (double& v : cell.sum) v /= static_cast<double>(cell.points);
        out.places.push_back(cell.sum);
    }
    out.of_point.reserve(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Vec3 p = place(i);
        out.of_point.push_back(known(p)
                                   ? cells[cell_of(p)].number
                                   : nearest(out.places, {cloud.x[i], cloud.y[i], cloud.z[i]}));
    }
    return out;
}

std::vector<std::uint32_t> places_apart(const SensorPlaces& sensors, std::size_t most) {
    std::vector<std::uint32_t> out;
    if (sensors.places.empty()) return out;
    std::vector<std::uint64_t> points(sensors.places.size(), 0);
    for (const std::uint32_t place : sensors.of_point) ++points[place];
    std::vector<double> apart(sensors.places.size(), std::numeric_limits<double>::infinity());
    auto next = static_cast<std::size_t>(std::ranges::max_element(points) - points.begin());
    while (out.size() < std::min(most, sensors.places.size())) {
        out.push_back(static_cast<std::uint32_t>(next));
        for (std::size_t p = 0; p < apart.size(); ++p)
            apart[p] = std::min(apart[p], square_between(sensors.places[p], sensors.places[next]));
        next = static_cast<std::size_t>(std::ranges::max_element(apart) - apart.begin());
    }
    return out;
}

}  // namespace topple::geometry

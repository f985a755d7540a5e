// SPDX-License-Identifier: MIT
#include "safety/human/passers_by.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "safety/human/grid_line.h"

namespace topple::safety {
namespace {

// Of the heights of a body, so many must be free for it to be met: scanned walls have holes.
constexpr double least_free = 0.1;

// The zone's nearest point to (x, y).
std::array<double, 2> nearest(const FallZone& zone, double x, double y) {
    const double dx = x - zone.from[0], dy = y - zone.from[1];
    const auto [wx, wy, wz] = zone.way;
    if (wx == 0 && wy == 0) {
        const double away = std::hypot(dx, dy);
        const double share = away > zone.ahead_m ? zone.ahead_m / away : 1;
        return {zone.from[0] + share * dx, zone.from[1] + share * dy};
    }
    const double ahead = std::clamp(dx * wx + dy * wy, 0.0, zone.ahead_m);
    const double left = std::clamp(dy * wx - dx * wy, -zone.right_m, zone.left_m);
    return {zone.from[0] + ahead * wx - left * wy, zone.from[1] + ahead * wy + left * wx};
}

// Whether a level line from (x, y) to (to_x, to_y) is free, at any of enough heights of a body that
// stands on floor_m.
bool in_sight(const Columns& columns, const HumanOptions& options, double floor_m, double x,
              double y, const std::array<double, 2>& to) {
    const double voxel = columns.voxel_m(), way = std::hypot(to[0] - x, to[1] - y);
    const auto lowest =
        static_cast<std::int64_t>(std::ceil((floor_m + options.step_height_m) / voxel));
    const auto count =
        static_cast<std::int64_t>((options.body_height_m - options.step_height_m) / voxel);
    const auto steps = static_cast<std::int64_t>(std::ceil(2 * way / voxel));
    std::int64_t shut = 0;
    for (std::int64_t first = 0; first < count; first += 64) {
        std::uint64_t solid = 0;
        for (std::int64_t s = 0; s <= steps; ++s) {
            const double share =
                steps > 0 ? static_cast<double>(s) / static_cast<double>(steps) : 0;
            solid |= columns.solid(
                static_cast<std::int64_t>(std::floor((x + share * (to[0] - x)) / voxel)),
                static_cast<std::int64_t>(std::floor((y + share * (to[1] - y)) / voxel)),
                lowest + first);
        }
        if (count - first < 64) solid &= (std::uint64_t{1} << (count - first)) - 1;
        shut += std::popcount(solid);
    }
    return static_cast<double>(shut) <= (1 - least_free) * static_cast<double>(count);
}

// The walkable cells within reach of one zone, and the rectangle of the map that holds them.
class Reached {
  public:
    explicit Reached(const WalkableMap& map) : map_(map), reached_(map.size()) {}

    void mark(const Columns& columns, const HumanOptions& options, const FallZone& zone) {
        for (const std::uint32_t cell : cells_) reached_[cell] = false;
        cells_.clear();
        const double furthest =
            zone.ahead_m + std::max(zone.left_m, zone.right_m) + passing_reach_m + map_.cell_m;
        const auto index = [&](double at, double corner, std::int64_t most) {
            const double cells = std::floor((at - corner) / map_.cell_m);
            return static_cast<std::int64_t>(
                std::clamp(cells, 0.0, static_cast<double>(std::max<std::int64_t>(most - 1, 0))));
        };
        low_ = {index(zone.from[0] - furthest, map_.x0, map_.nx),
                index(zone.from[1] - furthest, map_.y0, map_.ny)};
        high_ = {index(zone.from[0] + furthest, map_.x0, map_.nx),
                 index(zone.from[1] + furthest, map_.y0, map_.ny)};
        for (std::int64_t y = low_.y; y <= high_.y; ++y) {
            for (std::int64_t x = low_.x; x <= high_.x; ++x) {
                const std::uint32_t cell = map_.index({x, y});
                if (map_.component[cell] < 0 || !meets(columns, options, zone, cell)) continue;
                reached_[cell] = true;
                cells_.push_back(cell);
            }
        }
    }

    bool any() const { return !cells_.empty(); }

    // Whether a walk with such corners passes any of the cells.
    bool passed_by(const std::vector<std::uint32_t>& corners) const {
        for (std::size_t leg = 1; leg < corners.size(); ++leg) {
            const Place a = map_.place(corners[leg - 1]), b = map_.place(corners[leg]);
            if (std::max(a.x, b.x) < low_.x || std::min(a.x, b.x) > high_.x ||
                std::max(a.y, b.y) < low_.y || std::min(a.y, b.y) > high_.y)
                continue;
            if (!along_line(map_, a, b, [&](std::uint32_t cell) { return !reached_[cell]; }))
                return true;
        }
        return false;
    }

  private:
    bool meets(const Columns& columns, const HumanOptions& options, const FallZone& zone,
               std::uint32_t cell) const {
        const double floor = map_.floor_m[cell];
        if (floor >= zone.highest_m || floor + options.body_height_m <= zone.lowest_m) return false;
        const auto [x, y] = map_.center(map_.place(cell));
        const auto to = nearest(zone, x, y);
        return std::hypot(to[0] - x, to[1] - y) <= passing_reach_m &&
               in_sight(columns, options, floor, x, y, to);
    }

    const WalkableMap& map_;
    std::vector<bool> reached_;
    std::vector<std::uint32_t> cells_;
    Place low_{}, high_{};
};

}  // namespace

std::vector<double> passing_shares(const WalkableMap& map, const PrimaryMotion& motion,
                                   const Columns& columns, const HumanOptions& options,
                                   std::span<const FallZone> zones) {
    if (map.walkable.empty() || motion.paths == 0) return {};
    Reached reached(map);
    std::vector<double> out;
    for (const FallZone& zone : zones) {
        reached.mark(columns, options, zone);
        std::size_t passing = 0;
        if (reached.any()) {
            passing = static_cast<std::size_t>(std::ranges::count_if(
                motion.corners, [&](const auto& corners) { return reached.passed_by(corners); }));
        }
        out.push_back(static_cast<double>(passing) / motion.paths);
    }
    return out;
}

}  // namespace topple::safety

// SPDX-License-Identifier: MIT
#include "physics/slide_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "physics/tipping.h"

namespace topple::physics {
namespace {

// Columns of a footprint, and those that have some on all four sides.
std::vector<std::array<std::int32_t, 2>> enclosed_columns(
    std::span<const Footprint::Column> columns) {
    struct Span {
        std::int32_t low = std::numeric_limits<std::int32_t>::max();
        std::int32_t high = std::numeric_limits<std::int32_t>::min();
        void add(std::int32_t at) {
            low = std::min(low, at);
            high = std::max(high, at);
        }
    };
    std::map<std::int32_t, Span> along_j, along_i;  // by i, by j
    for (const Footprint::Column& c : columns) {
        along_j[c.i].add(c.j);
        along_i[c.j].add(c.i);
    }
    std::vector<std::array<std::int32_t, 2>> out;
    for (const auto& [i, row] : along_j) {
        for (std::int32_t j = row.low; j <= row.high; ++j) {
            const auto across = along_i.find(j);
            if (across != along_i.end() && i >= across->second.low && i <= across->second.high)
                out.push_back({i, j});
        }
    }
    return out;
}

}  // namespace

SlideMap::SlideMap(const SolidCells& cells, const CellColumns& columns,
                   std::span<const std::int32_t> object, std::int32_t self, const Footprint& foot,
                   const Vec3& center, double reach_m, const Unseen& unseen)
    : cells_(cells),
      columns_(columns),
      object_(object),
      self_(self),
      foot_(foot),
      center_(center),
      unseen_(unseen) {
    start_i_ = static_cast<std::int32_t>(std::floor(center[0] / cells.voxel_m));
    start_j_ = static_cast<std::int32_t>(std::floor(center[1] / cells.voxel_m));
    radius_ = static_cast<std::int32_t>(std::clamp(reach_m / cells.voxel_m, 1.0, 1500.0));
    // The window of columns is wider than that of positions by the footprint.
    margin_ = 0;
    for (const Footprint::Column& c : foot.columns) {
        margin_ = std::max({margin_, std::abs(c.i - start_i_), std::abs(c.j - start_j_)});
    }
    margin_ += radius_ + 1;
    side_ = 2 * margin_ + 1;
    ground_.resize(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_));
    const auto positions = static_cast<std::size_t>(2 * radius_ + 1);
    blocked_.assign(positions * positions, 0);
    falls_.assign(positions * positions, 0);
    const auto has = [&](std::int32_t i, std::int32_t j) {
        const auto at = std::lower_bound(
            foot.columns.begin(), foot.columns.end(), std::pair{i, j},
            [](const Footprint::Column& c, const std::pair<std::int32_t, std::int32_t>& p) {
                return std::pair{c.i, c.j} < p;
            });
        return at != foot.columns.end() && at->i == i && at->j == j;
    };
    for (std::size_t n = 0; n < foot.columns.size(); ++n) {
        const Footprint::Column& c = foot.columns[n];
        if (!has(c.i - 1, c.j) || !has(c.i + 1, c.j) || !has(c.i, c.j - 1) || !has(c.i, c.j + 1)) {
            outline_.push_back(n);
        }
    }
    // What reaches into the outline at the start moves with the object, also where it hides the
    // object's own middle.
    for (const auto& [i, j] : enclosed_columns(foot.columns)) {
        ground(i, j);
        ground_[static_cast<std::size_t>(i - start_i_ + margin_) * static_cast<std::size_t>(side_) +
                static_cast<std::size_t>(j - start_j_ + margin_)]
            .obstacle = false;
    }
}

void SlideMap::stand(const KnownFooting& stance) {
    if (stance.polygon.empty() || !(stance.unseen || falls(start_i_, start_j_))) return;
    const double h = cells_.voxel_m;
    std::array<std::int32_t, 2> low{start_i_ + margin_, start_j_ + margin_},
        high{start_i_ - margin_, start_j_ - margin_};
    const std::array start{start_i_, start_j_};
    for (const auto& point : stance.polygon) {
        for (std::size_t a = 0; a < 2; ++a) {
            const auto at = static_cast<std::int32_t>(std::floor(
                std::clamp<double>(point[a] / h, start[a] - margin_, start[a] + margin_)));
            low[a] = std::min(low[a], at);
            high[a] = std::max(high[a], at);
        }
    }
    for (std::int32_t i = low[0]; i <= high[0]; ++i) {
        for (std::int32_t j = low[1]; j <= high[1]; ++j) {
            // A column is ground where it is within the polygon, to half a voxel.
            if (footing(stance.polygon, (i + 0.5) * h, (j + 0.5) * h).margin_m < -0.5 * h) continue;
            ground(i, j);
            ground_[static_cast<std::size_t>(i - start_i_ + margin_) *
                        static_cast<std::size_t>(side_) +
                    static_cast<std::size_t>(j - start_j_ + margin_)]
                .holds = true;
        }
    }
    std::ranges::fill(falls_, std::uint8_t{0});
}

const SlideMap::Ground& SlideMap::ground(std::int32_t i, std::int32_t j) {
    const std::int32_t di = i - start_i_ + margin_, dj = j - start_j_ + margin_;
    if (di < 0 || dj < 0 || di >= side_ || dj >= side_) return outside_;
    Ground& g = ground_[static_cast<std::size_t>(di) * static_cast<std::size_t>(side_) +
                        static_cast<std::size_t>(dj)];
    if (g.known) return g;
    g.known = true;
    const auto [first, last] = columns_.at(i, j);
    for (std::size_t c = first; c < last; ++c) {
        if (object_[c] == self_) continue;
        const std::int64_t above = std::int64_t{cells_.k[c]} - foot_.support;
        if (above < -1) {
            g.below = static_cast<std::int32_t>(-above);  // the last one is the highest
        } else if (above <= 1) {
            g.holds = true;  // a voxel up or down is noise
        } else if (cells_.k[c] <= foot_.top) {
            g.obstacle = true;
        }
    }
    if (!g.holds && g.below > 0 && may_carry(unseen_, i, j, foot_.support)) g.below = 0;
    return g;
}

bool SlideMap::blocked(std::int32_t i, std::int32_t j) {
    const std::int32_t di = i - start_i_, dj = j - start_j_;
    std::uint8_t& known = blocked_[static_cast<std::size_t>(di + radius_) *
                                       static_cast<std::size_t>(2 * radius_ + 1) +
                                   static_cast<std::size_t>(dj + radius_)];
    if (known) return known == 2;
    bool hit = false;
    for (const std::size_t n : outline_) {
        if (ground(foot_.columns[n].i + di, foot_.columns[n].j + dj).obstacle) {
            hit = true;
            break;
        }
    }
    known = hit ? 2 : 1;
    return hit;
}

bool SlideMap::bears(std::int32_t shift_i, std::int32_t shift_j) {
    // Of each row of columns, sorted by (i, j), the outermost that still bear.
    std::vector<std::array<double, 2>> corners;
    const auto add_row = [&](std::int32_t i, std::int32_t from, std::int32_t to) {
        for (const std::int32_t x : {i, i + 1}) {
            corners.push_back({static_cast<double>(x), static_cast<double>(from)});
            corners.push_back({static_cast<double>(x), static_cast<double>(to + 1)});
        }
    };
    bool any = false;
    std::int32_t row = 0, from = 0, to = 0;
    for (const Footprint::Column& c : foot_.columns) {
        if (std::int64_t{c.low} - foot_.support > 2) continue;  // not a foot
        if (!ground(c.i + shift_i, c.j + shift_j).holds) continue;
        if (any && c.i != row) add_row(row, from, to);
        if (!any || c.i != row) from = c.j;
        any = true;
        row = c.i;
        to = c.j;
    }
    if (!any) return false;
    add_row(row, from, to);
    const auto polygon = convex_polygon(std::move(corners));
    return footing(polygon, center_[0] / cells_.voxel_m, center_[1] / cells_.voxel_m).margin_m > 0;
}

bool SlideMap::falls(std::int32_t i, std::int32_t j) {
    const std::int32_t di = i - start_i_, dj = j - start_j_;
    std::uint8_t& known =
        falls_[static_cast<std::size_t>(di + radius_) * static_cast<std::size_t>(2 * radius_ + 1) +
               static_cast<std::size_t>(dj + radius_)];
    if (known) return known == 2;
    // The column under the centre decides, but for holes that the foot spans.
    const bool fall = !ground(i, j).holds && !bears(di, dj);
    known = fall ? 2 : 1;
    return fall;
}

bool SlideMap::passable(std::int32_t i, std::int32_t j) {
    const Ground& under = ground(i, j);
    return (under.holds || under.below > 0) && !blocked(i, j);
}

bool SlideMap::any_edge() {
    for (std::int32_t i = start_i_ - radius_; i <= start_i_ + radius_; ++i) {
        for (std::int32_t j = start_j_ - radius_; j <= start_j_ + radius_; ++j) {
            const Ground& under = ground(i, j);
            if (!under.holds && under.below > 0) return true;
        }
    }
    return false;
}

}  // namespace topple::physics

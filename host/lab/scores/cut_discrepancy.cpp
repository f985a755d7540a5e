// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "lab/scores/majority.h"
#include "lab/scores/segmentation_score.h"
#include "topple/error.h"
#include "topple/input.h"

namespace topple::scenes {
namespace {

constexpr double unreached = std::numeric_limits<double>::infinity();
using Cell = std::array<std::int32_t, 3>;

// Points thinned to cells, sorted by cell, and which of them are neighbours.
struct Cells {
    std::vector<Cell> at;
    std::vector<Vec3> mean;
    std::vector<std::int32_t> truth, predicted;
    std::vector<std::uint32_t> first, neighbours;  // those of n: first[n] to first[n + 1]
};

Cells thinned(const Positions& points, std::span<const std::int32_t> truth,
              std::span<const std::int32_t> predicted, double cell_m) {
    const auto index = [&](float v) { return static_cast<std::int32_t>(std::floor(v / cell_m)); };
    std::vector<std::pair<Cell, std::uint32_t>> order;
    for (std::size_t n = 0; n < truth.size(); ++n) {
        if (truth[n] < 0) continue;
        order.push_back({{index(points.x[n]), index(points.y[n]), index(points.z[n])},
                         static_cast<std::uint32_t>(n)});
    }
    std::sort(order.begin(), order.end());
    Cells cells;
    std::vector<std::int32_t> t, p;
    for (std::size_t n = 0; n < order.size();) {
        const Cell cell = order[n].first;
        Vec3 sum{};
        t.clear();
        p.clear();
        for (; n < order.size() && order[n].first == cell; ++n) {
            const std::uint32_t k = order[n].second;
            sum[0] += points.x[k];
            sum[1] += points.y[k];
            sum[2] += points.z[k];
            t.push_back(truth[k]);
            p.push_back(std::max(predicted[k], -1));
        }
        for (double& s : sum) s /= static_cast<double>(t.size());
        cells.at.push_back(cell);
        cells.mean.push_back(sum);
        cells.truth.push_back(majority(t));
        cells.predicted.push_back(majority(p));
    }
    return cells;
}

void link(Cells& cells) {
    for (const Cell& c : cells.at) {
        cells.first.push_back(static_cast<std::uint32_t>(cells.neighbours.size()));
        for (std::int32_t i = -1; i <= 1; ++i) {
            for (std::int32_t j = -1; j <= 1; ++j) {
                // The three along z stand together in the order of the cells.
                auto near = std::lower_bound(cells.at.begin(), cells.at.end(),
                                             Cell{c[0] + i, c[1] + j, c[2] - 1});
                const Cell last{c[0] + i, c[1] + j, c[2] + 1};
                for (; near != cells.at.end() && *near <= last; ++near) {
                    if (*near != c)
                        cells.neighbours.push_back(
                            static_cast<std::uint32_t>(near - cells.at.begin()));
                }
            }
        }
    }
    cells.first.push_back(static_cast<std::uint32_t>(cells.neighbours.size()));
}

std::vector<std::uint32_t> cuts(const Cells& cells, const std::vector<std::int32_t>& label) {
    std::vector<std::uint32_t> out;
    for (std::uint32_t n = 0; n < label.size(); ++n) {
        bool cut = false;
        for (std::uint32_t k = cells.first[n]; k < cells.first[n + 1]; ++k)
            cut = cut || label[cells.neighbours[k]] != label[n];
        if (cut) out.push_back(n);
    }
    return out;
}

double apart(const Vec3& a, const Vec3& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// Shortest ways from all cells to the nearest of `sources` (Dijkstra).
std::vector<double> ways_to(const Cells& cells, const std::vector<std::uint32_t>& sources) {
    std::vector<double> way(cells.at.size(), unreached);
    using Item = std::pair<double, std::uint32_t>;
    std::priority_queue<Item, std::vector<Item>, std::greater<>> open;
    for (const std::uint32_t s : sources) {
        way[s] = 0;
        open.push({0, s});
    }
    while (!open.empty()) {
        const auto [reached, n] = open.top();
        open.pop();
        if (reached > way[n]) continue;
        for (std::uint32_t k = cells.first[n]; k < cells.first[n + 1]; ++k) {
            const std::uint32_t m = cells.neighbours[k];
            const double to = reached + apart(cells.mean[n], cells.mean[m]);
            if (to >= way[m]) continue;
            way[m] = to;
            open.push({to, m});
        }
    }
    return way;
}

double mean_radius(const std::vector<Vec3>& points) {
    Vec3 center{};
    for (const Vec3& p : points) {
        for (std::size_t a = 0; a < 3; ++a) center[a] += p[a] / static_cast<double>(points.size());
    }
    double sum = 0;
    for (const Vec3& p : points) sum += apart(p, center);
    return sum / static_cast<double>(points.size());
}

}  // namespace

double cut_discrepancy(const Positions& points, std::span<const std::int32_t> truth,
                       std::span<const std::int32_t> predicted, double cell_m) {
    const std::size_t count = truth.size();
    if (predicted.size() != count || points.x.size() != count || points.y.size() != count ||
        points.z.size() != count || !(cell_m > 0)) {
        throw Error(ErrorKind::usage,
                    "cut discrepancy: " + std::to_string(points.x.size()) + " points, " +
                        std::to_string(count) + " true and " + std::to_string(predicted.size()) +
                        " predicted labels, cells of " + std::to_string(cell_m) + " m");
    }
    Cells cells = thinned(points, truth, predicted, cell_m);
    link(cells);
    const auto true_cuts = cuts(cells, cells.truth), found_cuts = cuts(cells, cells.predicted);
    if (true_cuts.empty() && found_cuts.empty()) return 0;
    const double radius = mean_radius(cells.mean);
    const auto mean_way = [&](const auto& from, const auto& to) {
        if (from.empty()) return 0.0;
        const auto way = ways_to(cells, to);
        double sum = 0;
        for (const std::uint32_t n : from) sum += std::min(way[n], radius);
        return sum / static_cast<double>(from.size());
    };
    return (mean_way(found_cuts, true_cuts) + mean_way(true_cuts, found_cuts)) / radius;
}

}  // namespace topple::scenes

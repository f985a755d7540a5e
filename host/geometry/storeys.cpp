// SPDX-License-Identifier: MIT
#include "geometry/storeys.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/room_measures.h"

namespace topple::geometry {
namespace {

// A level holds at least this share of the largest one's surface.
constexpr double least_peak_share = 0.3;
// Nobody builds thicker or thinner slabs.
constexpr double thickest_slab_m = 0.8, thinnest_slab_m = 0.08;

struct Level {
    double height_m = 0, area_m2 = 0;
};

// Levels by rising height: where a window of the spread holds more surface than any other that it
// touches, the lowest of equals; at the middle of that surface.
std::vector<Level> find_levels(const std::vector<double>& area, double low, double step) {
    const auto reach =
        static_cast<std::ptrdiff_t>(std::max(1.0, std::round(level_spread_m / step)));
    const auto count = static_cast<std::ptrdiff_t>(area.size());
    const auto at = [](const std::vector<double>& values, std::ptrdiff_t n) { return values[n]; };
    std::vector<double> window(area.size(), 0.0), middle(area.size(), 0.0);
    for (std::ptrdiff_t n = 0; n < count; ++n) {
        double moment = 0;
        const std::ptrdiff_t last = std::min(count - 1, n + reach);
        for (std::ptrdiff_t m = std::max<std::ptrdiff_t>(0, n - reach); m <= last; ++m) {
            window[n] += at(area, m);
            moment += at(area, m) * (low + (static_cast<double>(m) + 0.5) * step);
        }
        if (at(window, n) > 0) middle[n] = moment / at(window, n);
    }
    const double most = window.empty() ? 0 : *std::ranges::max_element(window);
    std::vector<Level> levels;
    for (std::ptrdiff_t n = 0; n < count; ++n) {
        const double here = at(window, n);
        if (here < least_peak_share * most || here <= 0) continue;
        bool peak = true;
        for (std::ptrdiff_t m = n - 2 * reach - 1; m <= n + 2 * reach + 1 && peak; ++m) {
            if (m < 0 || m >= count || m == n) continue;
            peak = at(window, m) < here || (at(window, m) == here && m > n);
        }
        if (peak) levels.push_back({at(middle, n), here});
    }
    return levels;
}

}  // namespace

std::vector<Storey> find_storeys(const std::vector<double>& area_m2, double low_m, double step_m) {
    const std::vector<Level> levels = find_levels(area_m2, low_m, step_m);
    std::vector<Storey> storeys{
        {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}};
    if (levels.empty()) return storeys;
    storeys.front().floor_m = levels.front().height_m;
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    double ceiling = none;  // of the storey in hand
    for (const Level& level : levels) {
        const double height = level.height_m;
        const double slab = height - ceiling;  // NaN is in no range
        if (slab >= thinnest_slab_m && slab <= thickest_slab_m) {
            storeys.push_back({height, (ceiling + height) / 2});
            ceiling = none;
        } else if (height - storeys.back().floor_m >= lowest_room_m) {
            ceiling = height;
        }
    }
    return storeys;
}

}  // namespace topple::geometry

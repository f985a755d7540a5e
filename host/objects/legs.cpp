// SPDX-License-Identifier: MIT
#include "objects/legs.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace topple {
namespace {

// Set by hand: height to width, and the share of the way to the underside.
constexpr double slim = 4, most_of_the_way = 0.75;

bool is_slim(const Body& object) {
    const auto& [wide, deep, high] = object.box.size_m;
    return !object.grounded && object.seen_enough() && std::max(wide, deep) > 0 &&
           high >= slim * std::max(wide, deep);
}

}  // namespace

std::vector<std::int32_t> find_legs(const SolidScene& solids,
                                    std::span<const std::int32_t> object_of_primitive,
                                    std::span<const Body> objects) {
    const SolidCells& cells = solids.cells();
    const auto object = [&](std::size_t n) {
        const std::int32_t p = cells.primitive[n];
        return p < 0 ? -1 : object_of_primitive[static_cast<std::size_t>(p)];
    };
    std::vector<bool> slim_ones;
    for (const Body& o : objects) slim_ones.push_back(is_slim(o));
    // Columns of each slim object, and how many of them have what next above it.
    std::vector<std::int32_t> columns(objects.size());
    std::map<std::int32_t, std::map<std::int32_t, std::int32_t>> below;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const std::int32_t o = object(n);
        if (o < 0 || !slim_ones[static_cast<std::size_t>(o)]) continue;
        const bool goes_on =
            n + 1 < cells.size() && cells.i[n + 1] == cells.i[n] && cells.j[n + 1] == cells.j[n];
        const std::int32_t next = goes_on ? object(n + 1) : -1;
        if (next == o) continue;  // its column ends further up
        ++columns[static_cast<std::size_t>(o)];
        if (next < 0) continue;
        const Body &leg = objects[static_cast<std::size_t>(o)],
                   &top = objects[static_cast<std::size_t>(next)];
        if (top.grounded || top.seen_enough() ||
            top.candidate.body.mass_kg <= leg.candidate.body.mass_kg)
            continue;
        const double underside = cells.k[n + 1] * cells.voxel_m - leg.lowest_m;
        if (leg.highest_m - leg.lowest_m >= most_of_the_way * underside) ++below[o][next];
    }
    std::vector<std::int32_t> out(objects.size(), -1);
    for (const auto& [o, tops] : below) {
        for (const auto& [top, count] : tops)
            if (2 * count >= columns[static_cast<std::size_t>(o)])
                out[static_cast<std::size_t>(o)] = top;
    }
    return out;
}

}  // namespace topple

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

std::vector<std::int32_t> find_legs(const SolidScene& solids, ObjectOf object_of,
                                    TableView<ObjectId, Body> objects) {
    const SolidCells& cells = solids.cells();
    Table<ObjectId, bool> slim_ones;
    for (const Body& o : objects) slim_ones.push_back(is_slim(o));
    // Columns of each slim object, and how many of them have what next above it.
    Table<ObjectId, std::int32_t> columns(objects.size());
    std::map<std::int32_t, std::map<std::int32_t, std::int32_t>> below;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const ObjectId o = object_of(cells.primitive[n]);
        if (o < 0 || !slim_ones[o]) continue;
        const bool goes_on =
            n + 1 < cells.size() && cells.i[n + 1] == cells.i[n] && cells.j[n + 1] == cells.j[n];
        const ObjectId next = goes_on ? object_of(cells.primitive[n + 1]) : ObjectId();
        if (next == o) continue;  // its column ends further up
        ++columns[o];
        if (next < 0) continue;
        const Body &leg = objects[o], &top = objects[next];
        if (top.grounded || top.seen_enough() ||
            top.candidate.body.mass_kg <= leg.candidate.body.mass_kg)
            continue;
        const double underside = cells.k[n + 1] * cells.voxel_m - leg.lowest_m;
        if (leg.highest_m - leg.lowest_m >= most_of_the_way * underside) ++below[o][next];
    }
    Table<ObjectId, std::int32_t> out(objects.size(), -1);
    for (const auto& [o, tops] : below) {
        for (const auto& [top, count] : tops)
            if (2 * count >= columns[o]) out[o] = top;
    }
    return out;
}

}  // namespace topple

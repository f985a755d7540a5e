// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "vdb/grids.h"

// Legs of which only the lower end was seen: a camera above the seat looks under it to the floor
// beyond, but not up.
namespace topple::vdb {
namespace {

constexpr double widest_m = 0.1;   // a leg's side
constexpr double longest_m = 0.6;  // of the part that nobody saw
// Share of a leg's columns that must end hidden, below things that are at least so many times as
// wide, by columns: the leg at a chair's rear ends below the seat and below the back.
constexpr double least_hidden = 0.5;
constexpr std::uint64_t least_wider = 4;

// A column of one primitive, and what is above it through voxels that nobody saw.
struct Column {
    std::int32_t i, j, top;
    std::int32_t above = -1;  // primitive
    std::int32_t hidden = 0;  // voxels between
};

}  // namespace

std::uint64_t VoxelScene::extend(const std::vector<bool>& hollow) {
    Grids& g = *grids_;
    const SolidCellArrays cells = solid_cells();
    auto state = g.state->getAccessor();
    auto primitive = g.primitive->getAccessor();
    const auto plain = [&](std::int32_t p) {
        return p >= 0 && !(static_cast<std::size_t>(p) < hollow.size() &&
                           hollow[static_cast<std::size_t>(p)]);
    };
    std::map<std::int32_t, std::vector<Column>> columns;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        if (!plain(cells.primitive[n])) continue;
        std::vector<Column>& own = columns[cells.primitive[n]];
        if (own.empty() || own.back().i != cells.i[n] || own.back().j != cells.j[n])
            own.push_back({cells.i[n], cells.j[n], cells.k[n]});
        own.back().top = cells.k[n];
    }
    const double h = g.frame.voxel_m;
    // A side covers a voxel more where it does not begin with one.
    const double most_columns = std::pow(widest_m / h + 1, 2);
    const auto longest = static_cast<std::int32_t>(longest_m / h);
    std::uint64_t completed = 0;
    for (auto& [leg, own] : columns) {
        if (static_cast<double>(own.size()) > most_columns) continue;
        std::size_t ending = 0;
        for (Column& c : own) {
            openvdb::Coord voxel(c.i, c.j, c.top + 1);
            while (c.hidden <= longest && !state.isValueOn(voxel) &&
                   state.getValue(voxel) == static_cast<std::int32_t>(State::invisible)) {
                ++c.hidden;
                ++voxel.z();
            }
            if (c.hidden > longest || !state.isValueOn(voxel)) continue;
            const std::int32_t above = primitive.getValue(voxel);
            if (!plain(above) || above == leg) continue;
            if (columns.at(above).size() < least_wider * own.size()) continue;
            c.above = above;
            ++ending;
        }
        if (static_cast<double>(ending) < least_hidden * static_cast<double>(own.size())) continue;
        for (const Column& c : own) {
            if (c.above < 0) continue;
            for (std::int32_t k = 1; k <= c.hidden; ++k) {
                const openvdb::Coord voxel(c.i, c.j, c.top + k);
                state.setValueOn(voxel, static_cast<std::int32_t>(State::completed));
                primitive.setValueOn(voxel, leg);
                ++completed;
            }
        }
    }
    return completed;
}

}  // namespace topple::vdb

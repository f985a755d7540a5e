// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include "vdb/completion.h"

// Legs of which only the lower end was seen: a camera above the seat looks under it to the floor
// beyond, but not up.
namespace topple::vdb {
namespace {

constexpr double widest_m = 0.1;   // a leg's side
constexpr double longest_m = 0.6;  // of the part that nobody saw
// Share of a leg's columns that must end hidden, below things that are at least so many times as
// wide, by columns: the leg at a chair's rear ends below the seat and below the back.
constexpr double least_hidden = 0.5;
constexpr std::size_t least_wider = 4;

// A column of one primitive.
struct Column {
    std::int32_t i, j, top;
};

// Bodies' columns, by primitive.
std::vector<std::vector<Column>> columns_of(const VolumeView& view) {
    const SolidCells& cells = view.cells();
    std::vector<std::vector<Column>> columns(view.primitives());
    for (std::size_t n = 0; n < cells.size(); ++n) {
        if (!view.is_body(cells.primitive[n])) continue;
        std::vector<Column>& own = columns[cells.primitive[n]];
        if (own.empty() || own.back().i != cells.i[n] || own.back().j != cells.j[n])
            own.push_back({cells.i[n], cells.j[n], cells.k[n]});
        own.back().top = cells.k[n];
    }
    return columns;
}

}  // namespace

std::vector<Claim> leg_claims(const VolumeView& view) {
    const std::vector<std::vector<Column>> columns = columns_of(view);
    const double h = view.voxel_m();
    // A side covers a voxel more where it does not begin with one.
    const double most_columns = std::pow(widest_m / h + 1, 2);
    const auto longest = static_cast<std::int32_t>(longest_m / h);
    std::vector<Claim> claims;
    for (std::size_t leg = 0; leg < columns.size(); ++leg) {
        const std::vector<Column>& own = columns[leg];
        if (static_cast<double>(own.size()) > most_columns) continue;
        const std::size_t before = claims.size();
        std::size_t ending = 0;
        for (const Column& c : own) {
            const std::int32_t hidden = view.unseen_run({c.i, c.j, c.top + 1}, 2, 1, longest + 1);
            const Voxel next{c.i, c.j, c.top + 1 + hidden};
            if (hidden > longest || !view.solid(next)) continue;
            const std::int32_t above = view.primitive(next);
            if (!view.is_body(above) || static_cast<std::size_t>(above) == leg) continue;
            if (columns[above].size() < least_wider * own.size()) continue;
            ++ending;
            for (std::int32_t k = c.top + 1; k < next[2]; ++k)
                claims.push_back({{c.i, c.j, k}, static_cast<std::int32_t>(leg), Basis::leg});
        }
        if (static_cast<double>(ending) < least_hidden * static_cast<double>(own.size()))
            claims.resize(before);
    }
    // No voxel lies between two legs and what is right above each.
    std::ranges::sort(claims, {}, &Claim::at);
    return claims;
}

}  // namespace topple::vdb

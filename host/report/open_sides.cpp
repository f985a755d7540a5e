// SPDX-License-Identifier: MIT
#include "report/open_sides.h"

#include <algorithm>
#include <cmath>

namespace topple::report {
namespace {

constexpr double room_m = 1;         // free space that is at least so wide may be a room's
constexpr double void_m = 0.3;       // a hollow floor or wall, and noise beside one
constexpr float stretched_m = 0.25;  // along a sheet
constexpr double sheet_m = 0.75;  // edge of the squares that sheets vote in, with the eight around

// Along one axis: how thick the solid is there, and to which side a room lies, by how much.
struct Facing {
    float thick_m = 0;
    float room = 0;  // signed; its size is the vote's weight
};

// Cells in a row with no more than small voids between them, and the free space before and behind
// them: 0 where nothing follows.
struct Run {
    std::int32_t low = 0, high = 0;
    double before_m = 0, behind_m = 0;
};

// Which way the run's cell at `index` faces: -1 or 1.
int side(const Run& run, std::int32_t index, bool upright, double centre) {
    const int nearer = 2 * index < run.low + run.high ? -1 : 1;
    if (run.before_m >= room_m && run.behind_m >= room_m) return nearer;
    // A floor is a floor over any void, and under a table.
    if (upright) return run.before_m >= room_m ? -1 : 1;
    if (run.before_m != run.behind_m) return run.before_m > run.behind_m ? -1 : 1;
    return centre < (run.low + run.high) / 2.0 ? -1 : 1;
}

// Of every cell of the background, along the axis; of others it stays {}.
std::vector<Facing> facing_along(const std::vector<Cell>& cells, std::size_t axis, double centre,
                                 double edge_m) {
    const std::size_t second = (axis + 1) % 3, third = (axis + 2) % 3;
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < cells.size(); ++i) {
        if (cells[i].background) order.push_back(i);
    }
    const auto line = [&](std::uint32_t i) {
        return std::array{cells[i].index[second], cells[i].index[third]};
    };
    const auto at = [&](std::size_t n) { return cells[order[n]].index[axis]; };
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
        return line(a) != line(b) ? line(a) < line(b) : cells[a].index[axis] < cells[b].index[axis];
    });
    const auto gap_m = [&](std::size_t n) { return (at(n) - at(n - 1) - 1) * edge_m; };
    std::vector<Facing> facing(cells.size());
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        const auto together = [&](std::size_t n) { return line(order[n]) == line(order[begin]); };
        end = begin + 1;
        while (end < order.size() && together(end) && gap_m(end) <= void_m) ++end;
        Run run{at(begin), at(end - 1)};
        if (begin > 0 && together(begin - 1)) run.before_m = gap_m(begin);
        if (end < order.size() && together(end)) run.behind_m = gap_m(end);
        const double weight = std::clamp(std::abs(run.before_m - run.behind_m), 0.1, 2 * room_m);
        for (std::size_t first = begin, next = begin; first < end; first = next) {
            for (next = first + 1; next < end && at(next) == at(next - 1) + 1;) ++next;
            const double thick = static_cast<double>(next - first) * edge_m;
            for (std::size_t n = first; n < next; ++n) {
                const double room = side(run, at(n), axis == 2, centre) * weight;
                facing[order[n]] = {static_cast<float>(thick), static_cast<float>(room)};
            }
        }
    }
    return facing;
}

// The axis that the sheet of a cell lies across: the one that it is thinnest along, where it
// stretches along both others. What stands out of a sheet, or lies beside it, is thin along others:
// those around it tell.
std::size_t thinnest_axis(const std::vector<Cell>& cells, const CellTable& table,
                          const std::array<std::vector<Facing>, 3>& facing, std::uint32_t cell) {
    std::array<float, 3> thick{};
    const auto add = [&](std::uint32_t other) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            thick[axis] += std::min(facing[axis][other].thick_m, 4 * stretched_m);
    };
    const auto thinnest = [&] {
        return std::size_t(thick[2] <= std::min(thick[0], thick[1]) ? 2 : thick[1] < thick[0]);
    };
    add(cell);
    const std::size_t own = thinnest();
    if (std::min(thick[(own + 1) % 3], thick[(own + 2) % 3]) >
        std::max(stretched_m, 2 * thick[own]))
        return own;
    constexpr int reach = 2, side = 2 * reach + 1;
    for (int n = 0; n < side * side * side; ++n) {
        auto beside = cells[cell].index;
        beside[0] += n % side - reach;
        beside[1] += n / side % side - reach;
        beside[2] += n / side / side - reach;
        const auto other = table.find(beside);
        if (other != CellTable::absent && cells[other].background) add(other);
    }
    return thinnest();
}

// The votes of sheets across one axis, by squares of each layer of cells.
class Votes {
  public:
    Votes(std::size_t axis, double edge_m)
        : axis_(axis), square_(std::max(1, static_cast<int>(std::lround(sheet_m / edge_m)))) {}

    void add(const Cell& cell, float vote) {
        const auto at = table_.insert(square_of(cell), static_cast<std::uint32_t>(sums_.size()));
        if (at == sums_.size()) sums_.push_back(0);
        sums_[at] += double{vote};
    }
    double around(const Cell& cell) const {
        double sum = 0;
        for (int n = 0; n < 9; ++n) {
            auto square = square_of(cell);
            square[(axis_ + 1) % 3] += n % 3 - 1;
            square[(axis_ + 2) % 3] += n / 3 - 1;
            const auto at = table_.find(square);
            if (at != CellTable::absent) sum += sums_[at];
        }
        return sum;
    }

  private:
    std::array<std::int32_t, 3> square_of(const Cell& cell) const {
        std::array<std::int32_t, 3> square = cell.index;
        for (const std::size_t across : {(axis_ + 1) % 3, (axis_ + 2) % 3})
            square[across] = static_cast<std::int32_t>(
                std::floor(static_cast<double>(square[across]) / square_));
        return square;
    }

    std::size_t axis_;
    int square_;
    CellTable table_;
    std::vector<double> sums_;
};

}  // namespace

void face_open_sides(std::vector<Cell>& cells, const CellTable& table,
                     std::span<const std::uint32_t> which, const std::array<double, 3>& centre,
                     double edge_m) {
    if (which.empty()) return;
    std::array<std::vector<Facing>, 3> facing;
    for (std::size_t axis = 0; axis < 3; ++axis)
        facing[axis] = facing_along(cells, axis, centre[axis], edge_m);
    std::vector<std::uint8_t> across(cells.size());
    for (const auto i : which)
        across[i] = static_cast<std::uint8_t>(thinnest_axis(cells, table, facing, i));
    std::array<Votes, 3> votes{Votes(0, edge_m), Votes(1, edge_m), Votes(2, edge_m)};
    for (const auto i : which) votes[across[i]].add(cells[i], facing[across[i]][i].room);
    for (const auto i : which) {
        const std::size_t axis = across[i];
        cells[i].normal[axis] = votes[axis].around(cells[i]) < 0 ? -1.0f : 1.0f;
    }
}

}  // namespace topple::report

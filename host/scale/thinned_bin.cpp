// SPDX-License-Identifier: MIT
#include "scale/thinned_bin.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <string_view>

#include "core/field_rules.h"
#include "core/sorted_order.h"
#include "scale/binary_file.h"

namespace topple::tiles {
namespace {

namespace fs = std::filesystem;

std::string name_of(const Bin& bin) {
    return std::to_string(bin[0]) + "_" + std::to_string(bin[1]) + "_" + std::to_string(bin[2]);
}

constexpr const char *cells_prefix = "cells-", *numbers_prefix = "numbers-";

template <class Io, class Cells>
void cell_fields(Io& io, Cells& cells) {
    using namespace rules;
    io(cells.x, finite);
    const std::size_t count = cells.x.size();
    for (auto* values : {&cells.y, &cells.z}) io(*values, length(count), finite);
    io(cells.points, length(count));
    io(cells.red, length_or_none(count));
    for (auto* channel : {&cells.green, &cells.blue}) io(*channel, length(cells.red.size()));
}

template <class Io, class Numbers>
void number_fields(Io& io, Numbers& slab, Numbers& in_slab) {
    io(slab, [](const auto& firsts) { return std::ranges::is_sorted(firsts) && !firsts.empty(); });
    io(in_slab);
    io.expect(slab.back() == in_slab.size());
}

// Sums of the points in each cell, found by key through open addressing. Places are given out in
// the order in which cells are met.
class CellSums {
  public:
    CellSums() { grow(1u << 12); }

    std::uint32_t add(std::uint64_t key, const Vec3& point) {
        if (2 * cells_.size() >= slots_.size()) grow(2 * slots_.size());
        std::size_t at = slot(key);
        if (slots_[at] == none) {
            slots_[at] = static_cast<std::uint32_t>(cells_.size());
            cells_.push_back({key, {}, 0});
        }
        const std::uint32_t place = slots_[at];
        Cell& cell = cells_[place];
        for (std::size_t a = 0; a < 3; ++a) cell.sum[a] += point[a];
        ++cell.count;
        return place;
    }
    // Points of a scan are spread over cells: what add() will look at of a key is asked for before,
    // first the slot, then the cell in it.
    void expect(std::uint64_t key) const { __builtin_prefetch(&slots_[home(key)]); }
    void expect_cell(std::uint64_t key) const {
        const std::uint32_t place = slots_[home(key)];
        if (place != none) __builtin_prefetch(&cells_[place]);
    }
    std::vector<std::uint64_t> keys() const {
        std::vector<std::uint64_t> out;
        out.reserve(cells_.size());
        for (const Cell& cell : cells_) out.push_back(cell.key);
        return out;
    }
    void add_colour(std::uint32_t place, const Rgb8& colour) {
        if (colours_.size() <= place) colours_.resize(cells_.size());
        if (colour == Rgb8{0, 0, 0}) return;
        for (std::size_t c = 0; c < 3; ++c) colours_[place][c] += colour[c];
        ++colours_[place][3];
    }
    Rgb8 colour(std::uint32_t place) const {
        if (place >= colours_.size() || colours_[place][3] == 0) return {};
        Rgb8 out{};
        for (std::size_t c = 0; c < 3; ++c) {
            out[c] = static_cast<std::uint8_t>((colours_[place][c] + colours_[place][3] / 2) /
                                               colours_[place][3]);
        }
        return out;
    }
    std::uint32_t count(std::uint32_t place) const { return cells_[place].count; }
    double mean(std::uint32_t place, std::size_t axis) const {
        return cells_[place].sum[axis] / cells_[place].count;
    }

  private:
    static constexpr std::uint32_t none = UINT32_MAX;

    struct Cell {
        std::uint64_t key;
        Vec3 sum;
        std::uint32_t count;
    };

    std::size_t home(std::uint64_t key) const {
        return (key * 0x9e3779b97f4a7c15ULL >> 20) & (slots_.size() - 1);
    }
    // The slot that holds the key, or the free one for it.
    std::size_t slot(std::uint64_t key) const {
        std::size_t at = home(key);
        while (slots_[at] != none && cells_[slots_[at]].key != key)
            at = (at + 1) & (slots_.size() - 1);
        return at;
    }
    void grow(std::size_t size) {
        slots_.assign(size, none);
        for (std::uint32_t n = 0; n < cells_.size(); ++n) slots_[slot(cells_[n].key)] = n;
    }

    std::vector<std::uint32_t> slots_;                   // places; a power of two of them
    std::vector<Cell> cells_;                            // by place
    std::vector<std::array<std::uint64_t, 4>> colours_;  // sums of channels, and how many
};

}  // namespace

double dividing_cell(double cell_m) {
    return bin_edge_m / std::ceil(bin_edge_m / cell_m - 1e-9);
}

std::string thinned_name(const Bin& bin) {
    return cells_prefix + name_of(bin);
}

std::vector<std::string> files_of_thinned(const std::string& name) {
    if (!name.starts_with(cells_prefix)) return {};
    return {name, numbers_prefix + name.substr(std::string_view(cells_prefix).size())};
}

void thin_bin(const SpilledPoints& points, std::size_t bin, double cell_m, const fs::path& folder) {
    const Bin& at = points.bins()[bin].bin;
    const BinGrid grid(at, cell_m);
    constexpr std::size_t at_once = 32;  // points whose cells are asked for before they are needed
    CellSums sums;
    points.read(bin, [&](std::span<const Point> portion, std::span<const Rgb8> colours) {
        std::array<std::uint64_t, at_once> keys{};
        std::array<Vec3, at_once> inside{};
        for (std::size_t first = 0; first < portion.size(); first += at_once) {
            const std::size_t count = std::min(at_once, portion.size() - first);
            for (std::size_t n = 0; n < count; ++n) {
                inside[n] = grid.inside(portion[first + n]);
                keys[n] = grid.cell_at(inside[n]);
                sums.expect(keys[n]);
            }
            for (std::size_t n = 0; n < count; ++n) sums.expect_cell(keys[n]);
            for (std::size_t n = 0; n < count; ++n) {
                const std::uint32_t place = sums.add(keys[n], inside[n]);
                if (!colours.empty()) sums.add_colour(place, colours[first + n]);
            }
        }
    });
    const std::vector<std::uint64_t> keys = sums.keys();
    const std::uint64_t of_slab = grid.side * grid.side;
    std::vector<std::uint32_t> slab(grid.side + 1, 0), in_slab;
    ThinnedBin out;
    for (const std::uint32_t place : sorted_order(keys)) {
        ++slab[keys[place] / of_slab + 1];
        in_slab.push_back(static_cast<std::uint32_t>(keys[place] % of_slab));
        out.x.push_back(grid.outside(sums.mean(place, 0), 0));
        out.y.push_back(grid.outside(sums.mean(place, 1), 1));
        out.z.push_back(grid.outside(sums.mean(place, 2), 2));
        out.points.push_back(sums.count(place));
        if (!points.coloured()) continue;
        const Rgb8 colour = sums.colour(place);
        out.red.push_back(colour[0]);
        out.green.push_back(colour[1]);
        out.blue.push_back(colour[2]);
    }
    std::partial_sum(slab.begin(), slab.end(), slab.begin());
    BinaryWriter numbers(folder / (numbers_prefix + name_of(at)));
    number_fields(numbers, slab, in_slab);
    numbers.finish();
    BinaryWriter file(folder / thinned_name(at));
    cell_fields(file, out);
    file.finish();
}

CellsOfPoints::CellsOfPoints(const fs::path& folder, const Bin& bin, double cell_m)
    : grid_(bin, cell_m) {
    BinaryReader in(folder / (numbers_prefix + name_of(bin)));
    number_fields(in, slab_, in_slab_);
    in.expect(slab_.size() == grid_.side + 1);
}

std::optional<std::uint32_t> CellsOfPoints::find(const Point& point) const {
    const std::uint64_t cell = grid_.cell_at(grid_.inside(point));
    const std::uint64_t of_slab = grid_.side * grid_.side, x = cell / of_slab;
    const auto end = in_slab_.begin() + slab_[x + 1];
    const auto found = std::lower_bound(in_slab_.begin() + slab_[x], end, cell % of_slab);
    if (found == end || *found != cell % of_slab) return std::nullopt;
    return static_cast<std::uint32_t>(found - in_slab_.begin());
}

ThinnedBin read_thinned(const fs::path& folder, const Bin& bin) {
    BinaryReader in(folder / thinned_name(bin));
    ThinnedBin out;
    cell_fields(in, out);
    return out;
}

}  // namespace topple::tiles

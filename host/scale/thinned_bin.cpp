// SPDX-License-Identifier: MIT
#include "scale/thinned_bin.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <system_error>

#include "core/field_rules.h"
#include "core/sorted_order.h"
#include "geometry/cell_grid.h"
#include "scale/binary_file.h"

namespace topple::tiles {
namespace {

namespace fs = std::filesystem;

std::string name_of(const Bin& bin) {
    return std::to_string(bin[0]) + "_" + std::to_string(bin[1]) + "_" + std::to_string(bin[2]);
}

// For each point, in order, the place of its cell; and the cell of each place.
fs::path places_file(const fs::path& folder, const Bin& bin) {
    return folder / ("places-" + name_of(bin));
}
fs::path order_file(const fs::path& folder, const Bin& bin) {
    return folder / ("order-" + name_of(bin));
}
fs::path cells_file(const fs::path& folder, const Bin& bin) {
    return folder / thinned_name(bin);
}

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

// Points whose cells are read at a time.
constexpr std::size_t thinned_portion = 1u << 13;

// Sums of the points in each cell, found by key through open addressing. Places are given out in
// the order in which cells are met.
class CellSums {
  public:
    CellSums() { grow(1u << 12); }

    std::uint32_t add(std::uint64_t key, const std::array<double, 3>& point) {
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
        std::array<double, 3> sum;
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

// Writes places, portion by portion.
class PlacesWriter {
  public:
    explicit PlacesWriter(const fs::path& file) : out_(file) { portion_.reserve(thinned_portion); }
    void add(std::uint32_t place) {
        portion_.push_back(place);
        ++points_;
        if (portion_.size() == thinned_portion) flush();
    }
    void finish() {
        if (!portion_.empty()) flush();
        out_.finish();
    }
    std::uint64_t points() const { return points_; }
    const std::vector<PortionWriter::Sum>& sums() const { return sums_; }

  private:
    void flush() {
        sums_.push_back(out_.add(portion_));
        portion_.clear();
    }

    PortionWriter out_;
    std::vector<std::uint32_t> portion_;
    std::vector<PortionWriter::Sum> sums_;
    std::uint64_t points_ = 0;
};

}  // namespace

double dividing_cell(double cell_m) {
    return bin_edge_m / std::ceil(bin_edge_m / cell_m - 1e-9);
}

std::string thinned_name(const Bin& bin) {
    return "cells-" + name_of(bin);
}

void thin_bin(const SpilledPoints& points, std::size_t bin, double cell_m, const fs::path& folder) {
    const Bin& at = points.bins()[bin].bin;
    const auto cells = static_cast<std::int64_t>(std::llround(bin_edge_m / cell_m));
    const std::array<double, 3> low{at[0] * bin_edge_m, at[1] * bin_edge_m, at[2] * bin_edge_m};
    constexpr std::size_t at_once = 32;  // points whose cells are asked for before they are needed
    CellSums sums;
    PlacesWriter places(places_file(folder, at));
    points.read(bin, [&](std::span<const Point> portion, std::span<const Rgb8> colours) {
        std::array<std::uint64_t, at_once> keys{};
        std::array<std::array<double, 3>, at_once> in_bin{};
        for (std::size_t first = 0; first < portion.size(); first += at_once) {
            const std::size_t count = std::min(at_once, portion.size() - first);
            for (std::size_t n = 0; n < count; ++n) {
                const Point& p = portion[first + n];
                // Relative to the bin, so that the mean keeps the floats' accuracy.
                in_bin[n] = {p.x - low[0], p.y - low[1], p.z - low[2]};
                keys[n] = 0;
                for (const double c : in_bin[n]) {
                    const auto cell = std::clamp<std::int64_t>(
                        static_cast<std::int64_t>(std::floor(c / cell_m)), 0, cells - 1);
                    keys[n] = keys[n] * static_cast<std::uint64_t>(cells) +
                              static_cast<std::uint64_t>(cell);
                }
                sums.expect(keys[n]);
            }
            for (std::size_t n = 0; n < count; ++n) sums.expect_cell(keys[n]);
            for (std::size_t n = 0; n < count; ++n) {
                const std::uint32_t place = sums.add(keys[n], in_bin[n]);
                if (!colours.empty()) sums.add_colour(place, colours[first + n]);
                places.add(place);
            }
        }
    });
    places.finish();
    const std::vector<std::uint32_t> order = sorted_order(sums.keys());
    std::vector<std::uint32_t> rank(order.size());
    ThinnedBin out;
    for (std::uint32_t n = 0; n < order.size(); ++n) {
        rank[order[n]] = n;
        out.x.push_back(static_cast<float>(low[0] + sums.mean(order[n], 0)));
        out.y.push_back(static_cast<float>(low[1] + sums.mean(order[n], 1)));
        out.z.push_back(static_cast<float>(low[2] + sums.mean(order[n], 2)));
        out.points.push_back(sums.count(order[n]));
        if (!points.coloured()) continue;
        const Rgb8 colour = sums.colour(order[n]);
        out.red.push_back(colour[0]);
        out.green.push_back(colour[1]);
        out.blue.push_back(colour[2]);
    }
    BinaryWriter order_out(order_file(folder, at));
    order_out(rank);
    order_out(places.points());
    order_out(places.sums());
    order_out.finish();
    BinaryWriter file(cells_file(folder, at));
    cell_fields(file, out);
    file.finish();
}

CellsOfPoints::CellsOfPoints(const fs::path& folder, const Bin& bin)
    : file_(places_file(folder, bin)) {
    BinaryReader order(order_file(folder, bin));
    order(cell_of_place_, [](const auto& cells) { return rules::ids(cells.size())(cells); });
    order(points_);
    order(sums_, rules::length(points_ / thinned_portion + (points_ % thinned_portion > 0)));
    if (!PortionReader::holds<std::uint32_t>(file_, points_)) damaged_file(file_);
}

std::uint32_t CellsOfPoints::next() {
    if (at_ == portion_.size()) {
        if (read_ == points_)
            io::fail(file_, "has fewer points than the scan: the scan changed while it was parsed");
        portion_.resize(std::min<std::uint64_t>(thinned_portion, points_ - read_));
        PortionReader(file_).read(read_, sums_[read_ / thinned_portion], portion_);
        read_ += portion_.size();
        at_ = 0;
    }
    const std::uint32_t place = portion_[at_++];
    if (place >= cell_of_place_.size()) damaged_file(file_);
    return cell_of_place_[place];
}

void check_thinned(const fs::path& folder, const Bin& bin) {
    const std::size_t count = read_thinned(folder, bin).size();
    CellsOfPoints cells(folder, bin);
    if (cells.cells() != count) damaged_file(order_file(folder, bin));
    for (std::uint64_t n = 0; n < cells.points(); ++n) cells.next();
}

std::optional<Bin> bin_of_name(const std::string& name) {
    Bin bin{};
    if (std::sscanf(name.c_str(), "cells-%d_%d_%d", &bin[0], &bin[1], &bin[2]) != 3 ||
        thinned_name(bin) != name)
        return std::nullopt;
    return bin;
}

void remove_thinned(const fs::path& folder, const Bin& bin) {
    std::error_code error;
    for (const fs::path& file :
         {cells_file(folder, bin), order_file(folder, bin), places_file(folder, bin)})
        fs::remove(file, error);
}

ThinnedBin read_thinned(const fs::path& folder, const Bin& bin) {
    BinaryReader in(cells_file(folder, bin));
    ThinnedBin out;
    cell_fields(in, out);
    return out;
}

}  // namespace topple::tiles

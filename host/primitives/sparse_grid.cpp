// SPDX-License-Identifier: MIT
#include "topple/kernels/primitives/sparse_grid.h"

#include <array>
#include <bit>
#include <optional>
#include <string>

#include "grid_bounds.hpp"
#include "grid_find.hpp"
#include "grid_keys.hpp"
#include "grid_masks.hpp"
#include "grid_pack.hpp"
#include "grid_shift.hpp"
#include "grid_unpack.hpp"
#include "search_keys.hpp"
#include "topple/kernels/primitives/reduce.h"
#include "topple/kernels/primitives/runs.h"
#include "topple/kernels/primitives/sort.h"

namespace topple::primitives {
namespace {

constexpr std::uint32_t leaf_bits = ~511u;

// Keys moved by cells; of their low words these bits.
using Offset = std::array<std::int32_t, 3>;
void shift(device::Queue& queue, const Words& low, const Words& high, const Offset& by,
           std::uint32_t bits, const Words& low_to, const Words& high_to) {
    for (const Tile& tile : tiles(queue.device(), size(low)))
        queue.add<kernels::GridShift>(tile.count,
                                      {.low = part(low, tile),
                                       .high = part(high, tile),
                                       .low_to = part(low_to, tile),
                                       .high_to = part(high_to, tile)},
                                      {tile.count, by[0], by[1], by[2], bits});
}

// Arrays of the first keys alone.
void keep(device::Queue& queue, const Words& low, const Words& high, std::uint32_t count,
          SparseGrid::Array& low_to, SparseGrid::Array& high_to) {
    low_to = SparseGrid::Array(queue.device(), count, "low words of keys");
    high_to = SparseGrid::Array(queue.device(), count, "high words of keys");
    shift(queue, part(low, 0, count), part(high, 0, count), {}, ~0u, low_to, high_to);
}

std::uint32_t word_of(const SparseGrid::Array& array, std::uint64_t at) {
    std::uint32_t word = 0;
    array.download(std::span(&word, 1), at);
    return word;
}

// Keys in one word each, as far as the leaves between the least and the greatest can be told apart
// by so few bits.
class Packing {
  public:
    // Waits. None where a word is too short.
    static std::optional<Packing> of(device::Queue& queue, Scratch& scratch, const Words& low,
                                     const Words& high) {
        constexpr std::uint64_t group = 1024;  // REDUCE_WORDS
        const std::uint64_t groups = (size(low) + group - 1) / group;
        const std::uint64_t stride = (groups + slice_words - 1) / slice_words * slice_words;
        const auto bounds = scratch.take(6 * stride);
        for (const Tile& tile : tiles(queue.device(), size(low), group * slice_words)) {
            const std::uint64_t first = tile.first / group,
                                count = (tile.count + group - 1) / group;
            queue.add<kernels::GridBounds>(count,
                                           {.low = part(low, tile),
                                            .high = part(high, tile),
                                            .dst = part(bounds, first, 6 * stride - first)},
                                           {tile.count, static_cast<std::uint32_t>(stride)});
        }
        const SparseGrid::Array ends(queue.device(), 6 * slice_words, "bounds of leaves");
        for (std::uint64_t a = 0; a < 6; ++a)
            reduce(queue, scratch, a < 3 ? Reduction::least : Reduction::greatest,
                   part(bounds, a * stride, groups), ends.slice(a * slice_words, 1));
        queue.run();
        const std::vector<std::uint32_t> words = ends.download();
        const auto at = [&](std::size_t a) { return words[a * slice_words]; };
        const auto bits = [&](std::size_t a) {
            return static_cast<std::uint32_t>(std::bit_width(at(a + 3) - at(a)));
        };
        if (at(0) > at(3)) return Packing({}, cell_bits);  // of none
        const unsigned all = bits(0) + bits(1) + bits(2) + cell_bits;
        if (all >= 32) return std::nullopt;
        return Packing({.count = 0,
                        .x = at(0),
                        .y = at(1),
                        .z = at(2),
                        .bits_y = bits(1),
                        .bits_z = bits(2),
                        .none = 0},
                       all);
    }

    // What stands for no cell is above all others.
    std::uint32_t none() const { return params_.none; }
    unsigned bits() const { return bits_ + 1; }

    void pack(device::Queue& queue, const Words& low, const Words& high, const Words& to) const {
        for (const Tile& tile : tiles(queue.device(), size(low)))
            queue.add<kernels::GridPack>(
                tile.count,
                {.low = part(low, tile), .high = part(high, tile), .packed = part(to, tile)},
                of(tile));
    }
    // The first ones, as many as there is room for.
    void unpack(device::Queue& queue, const Words& from, const Words& low,
                const Words& high) const {
        for (const Tile& tile : tiles(queue.device(), size(low)))
            queue.add<kernels::GridUnpack>(
                tile.count,
                {.packed = part(from, tile), .low = part(low, tile), .high = part(high, tile)},
                of(tile));
    }

  private:
    static constexpr unsigned cell_bits = 9;
    Packing(kernels::GridPackParams params, unsigned bits) : params_(params), bits_(bits) {
        params_.none = 1u << bits;
    }
    kernels::GridPackParams of(const Tile& tile) const {
        kernels::GridPackParams params = params_;
        params.count = tile.count;
        return params;
    }
    kernels::GridPackParams params_;
    unsigned bits_;  // of a cell
};

}  // namespace

void search(device::Queue& queue, const Words& low, const Words& high, const Words& low_of,
            const Words& high_of, const Words& place) {
    check_size(high, size(low), "the high words of keys");
    check_size(high_of, size(low_of), "the high words of keys that are looked for");
    check_size(place, size(low_of), "the places of keys");
    for (const Tile& tile : tiles(queue.device(), size(low_of)))
        queue.add<kernels::SearchKeys>(tile.count,
                                       {.low = low,
                                        .high = high,
                                        .low_of = part(low_of, tile),
                                        .high_of = part(high_of, tile),
                                        .place = part(place, tile)},
                                       {tile.count, static_cast<std::uint32_t>(size(low))});
}

SparseGrid SparseGrid::of_points(device::Device& device, const device::Slice<float>& x,
                                 const device::Slice<float>& y, const device::Slice<float>& z,
                                 float edge_m) {
    if (!(edge_m > 0))
        throw Error(ErrorKind::usage, "edge_m: " + std::to_string(edge_m) +
                                          " is no edge of a cell; give one above 0");
    const std::uint64_t count = x.range.bytes / sizeof(float);
    const Array low(device, count, "low words of points' cells"),
        high(device, count, "high words of points' cells");
    device::Queue queue(device);
    for (const Tile& tile : tiles(device, count)) {
        queue.add<kernels::GridKeys>(tile.count,
                                     {.x = part(x, tile),
                                      .y = part(y, tile),
                                      .z = part(z, tile),
                                      .low = part(low, tile),
                                      .high = part(high, tile)},
                                     {tile.count, 1 / edge_m});
    }
    queue.run();
    return of_keys(device, low, high);
}

SparseGrid SparseGrid::of_keys(device::Device& device, const Words& low, const Words& high) {
    const std::uint64_t count = size(low);
    check_size(high, count, "the high words of cells");
    device::Queue queue(device);
    Scratch scratch(device);
    SparseGrid out;
    const Array number(device, 1, "number of cells, then of leaves");
    const auto run_for_number = [&] {
        queue.run();
        return word_of(number, 0);
    };
    {
        // A sort takes a pass for each 8 bits, so as few bits as may be.
        const std::optional<Packing> packing = Packing::of(queue, scratch, low, high);
        const bool wide = !packing;
        const auto packed = scratch.take(wide ? 0 : count), starts = scratch.take(count + 1),
                   sorted_low = scratch.take(count), sorted_high = scratch.take(wide ? count : 0);
        Array low_of(device, count, "low words of cells"),
            high_of(device, wide ? count : 0, "high words of cells");
        if (wide) {
            sort(queue, scratch, {low, high}, {sorted_low, sorted_high});
        } else {
            packing->pack(queue, low, high, packed);
            sort(queue, scratch, {packed}, {sorted_low}, packing->bits());
        }
        unique(queue, scratch,
               wide ? Segments::of_keys(sorted_low, sorted_high) : Segments::of_keys(sorted_low),
               low_of, high_of, starts, number);
        out.cells = run_for_number();
        // What is no cell stands behind all.
        const std::uint32_t no_cell = wide ? none : packing->none();
        if (out.cells > 0 && word_of(wide ? high_of : low_of, out.cells - 1) == no_cell)
            --out.cells;
        if (wide) {
            keep(queue, low_of, high_of, out.cells, out.cell_low, out.cell_high);
        } else {
            out.cell_low = Array(device, out.cells, "low words of cells");
            out.cell_high = Array(device, out.cells, "high words of cells");
            packing->unpack(queue, low_of, out.cell_low, out.cell_high);
        }
        queue.run();
    }
    const auto of_low = scratch.take(out.cells), of_high = scratch.take(out.cells),
               low_to = scratch.take(out.cells), high_to = scratch.take(out.cells);
    out.first = Array(device, out.cells + std::uint64_t{1}, "first cells of leaves");
    shift(queue, out.cell_low, out.cell_high, {}, leaf_bits, of_low, of_high);
    unique(queue, scratch, Segments::of_keys(of_low, of_high), low_to, high_to, out.first, number);
    out.leaves = run_for_number();
    keep(queue, low_to, high_to, out.leaves, out.leaf_low, out.leaf_high);
    out.mask = Array(device, 16 * std::uint64_t{out.leaves}, "leaves' cells");
    const Words ends = out.first.slice(0, out.leaves + std::uint64_t{1});
    queue.add<kernels::GridMasks>(
        out.leaves, {.low = out.cell_low, .first = ends, .mask = out.mask}, {out.leaves});
    queue.run();
    return out;
}

SparseGrid SparseGrid::dilated() const {
    device::Device& device = cell_low.device();
    // Each part begins where a slice may.
    const std::uint64_t step = (cells + slice_words - 1) / slice_words * slice_words;
    Array low(device, 7 * step, "low words of cells and those beside"),
        high(device, 7 * step, "high words of cells and those beside");
    low.fill(none);
    high.fill(none);
    device::Queue queue(device);
    constexpr Offset ways[7] = {{},        {-1, 0, 0}, {1, 0, 0}, {0, -1, 0},
                                {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
    for (std::uint64_t way = 0; way < 7; ++way)
        shift(queue, cell_low, cell_high, ways[way], ~0u, low.slice(way * step, cells),
              high.slice(way * step, cells));
    queue.run();
    return of_keys(device, low, high);
}

void SparseGrid::find(device::Queue& queue, const Coordinates& i, const Coordinates& j,
                      const Coordinates& k, const Words& place) const {
    for (const Coordinates* c : {&j, &k})
        check_size(Words{c->range}, i.range.bytes / sizeof(std::int32_t), "a coordinate of cells");
    check_size(place, size(Words{i.range}), "the places of cells");
    for (const Tile& tile : tiles(queue.device(), size(Words{i.range}))) {
        queue.add<kernels::GridFind>(tile.count,
                                     {.i = part(i, tile),
                                      .j = part(j, tile),
                                      .k = part(k, tile),
                                      .grid = *this,
                                      .place = part(place, tile)},
                                     {tile.count, leaves});
    }
}

void SparseGrid::neighbours(device::Queue& queue, Scratch& scratch, std::int32_t di,
                            std::int32_t dj, std::int32_t dk, const Words& leaf) const {
    check_size(leaf, leaves, "the neighbours of leaves");
    const auto low_of = scratch.take(leaves), high_of = scratch.take(leaves);
    shift(queue, leaf_low, leaf_high, {8 * di, 8 * dj, 8 * dk}, leaf_bits, low_of, high_of);
    search(queue, leaf_low, leaf_high, low_of, high_of, leaf);
}

}  // namespace topple::primitives

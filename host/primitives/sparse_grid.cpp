// SPDX-License-Identifier: MIT
#include "topple/kernels/primitives/sparse_grid.h"

#include <array>
#include <string>

#include "grid_keys.hpp"
#include "grid_masks.hpp"
#include "grid_shift.hpp"
#include "search_keys.hpp"
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
                                      {.low = part(low, tile.first, tile.count),
                                       .high = part(high, tile.first, tile.count),
                                       .low_to = part(low_to, tile.first, tile.count),
                                       .high_to = part(high_to, tile.first, tile.count)},
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
                                        .low_of = part(low_of, tile.first, tile.count),
                                        .high_of = part(high_of, tile.first, tile.count),
                                        .place = part(place, tile.first, tile.count)},
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
        const auto of = [&](const device::Slice<float>& all) {
            return device::Slice<float>{part(Words{all.range}, tile.first, tile.count).range};
        };
        queue.add<kernels::GridKeys>(tile.count,
                                     {.x = of(x),
                                      .y = of(y),
                                      .z = of(z),
                                      .low = part(low, tile.first, tile.count),
                                      .high = part(high, tile.first, tile.count)},
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
        const auto sorted_low = scratch.take(count), sorted_high = scratch.take(count),
                   starts = scratch.take(count + 1);
        Array low_of(device, count, "low words of cells"), high_of(device, count, "high words");
        sort(queue, scratch, {low, high}, {sorted_low, sorted_high});
        unique(queue, scratch, Segments::of_keys(sorted_low, sorted_high), low_of, high_of, starts,
               number);
        out.cells = run_for_number();
        // What is no cell stands behind all.
        if (out.cells > 0 && word_of(high_of, out.cells - 1) == none) --out.cells;
        keep(queue, low_of, high_of, out.cells, out.cell_low, out.cell_high);
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

void SparseGrid::find(device::Queue& queue, const Words& low_of, const Words& high_of,
                      const Words& place) const {
    search(queue, cell_low, cell_high, low_of, high_of, place);
}

void SparseGrid::neighbours(device::Queue& queue, Scratch& scratch, std::int32_t di,
                            std::int32_t dj, std::int32_t dk, const Words& leaf) const {
    check_size(leaf, leaves, "the neighbours of leaves");
    const auto low_of = scratch.take(leaves), high_of = scratch.take(leaves);
    shift(queue, leaf_low, leaf_high, {8 * di, 8 * dj, 8 * dk}, leaf_bits, low_of, high_of);
    search(queue, leaf_low, leaf_high, low_of, high_of, leaf);
}

}  // namespace topple::primitives

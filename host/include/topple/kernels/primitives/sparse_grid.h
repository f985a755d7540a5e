// SPDX-License-Identifier: MIT
#pragma once

#include "topple/kernels/buffer.h"
#include "topple/kernels/primitives/words.h"

namespace topple::primitives {

// place[i]: where key i stands in a sorted list of keys that has each once; none: not in it. Keys
// have 64 bits, in two words. The list must fit into one binding.
inline constexpr std::uint32_t none = 0xffffffffu;
void search(device::Queue& queue, const Words& low, const Words& high, const Words& low_of,
            const Words& high_of, const Words& place);

// Occupied cells of a regular grid of any extent up to 2^20 cells each way from its origin, by
// leaves of 8 x 8 x 8 as OpenVDB has them. Made on the device, where it stays: all of it is in
// order of the cells' keys (grid_key), so that what is known of cells is an array beside it.
struct SparseGrid {
    using Array = device::Buffer<std::uint32_t>;

    // Of the cells that hold a point: floor(x / edge_m) along each axis, the quotient as a product
    // with 1 / edge_m in single precision. What is not finite, or too far, is left out. Waits.
    // Throws Error(usage) where edge_m is not above 0.
    static SparseGrid of_points(device::Device& device, const device::Slice<float>& x,
                                const device::Slice<float>& y, const device::Slice<float>& z,
                                float edge_m);
    // Of cells by their keys, in any order, and as often as they like. Waits.
    static SparseGrid of_keys(device::Device& device, const Words& low, const Words& high);
    // With all cells that share a side with one of its own. Waits.
    SparseGrid dilated() const;

    // place[n]: the cell (i[n], j[n], k[n]), by its place in the order of the cells, or none.
    using Coordinates = device::Slice<std::int32_t>;
    void find(device::Queue& queue, const Coordinates& i, const Coordinates& j,
              const Coordinates& k, const Words& place) const;
    // What a kernel takes by GRID_IN, to look up cells by GRID_FIND (docs/dialect.md).
    operator device::GridArgument() const { return {leaf_low, leaf_high, first, mask}; }
    // leaf[i]: the leaf that lies beside leaf i, (di, dj, dk) leaves away, or none.
    void neighbours(device::Queue& queue, Scratch& scratch, std::int32_t di, std::int32_t dj,
                    std::int32_t dk, const Words& leaf) const;

    std::uint32_t cells = 0, leaves = 0;
    Array cell_low, cell_high;  // words of the cells' keys
    Array leaf_low, leaf_high;  // of the leaves', which are those of their first places
    Array first;  // of each leaf its first cell, then the number of cells; the rest is unused
    Array mask;   // 16 words for each leaf: bit 64 i + 8 j + k of cell (i, j, k)
};

// 64 bits: coordinates plus 2^20, 21 bits each: those of the leaf, x above y above z, and below
// them the three lowest of each, in the same order. Coordinates are below 2^20 either way.
constexpr std::uint64_t grid_key(std::int32_t i, std::int32_t j, std::int32_t k) {
    const auto biased = [](std::int32_t c) { return static_cast<std::uint64_t>(c + (1 << 20)); };
    const std::uint64_t x = biased(i), y = biased(j), z = biased(k);
    return (x >> 3) << 45 | (y >> 3) << 27 | (z >> 3) << 9 | (x & 7) << 6 | (y & 7) << 3 | (z & 7);
}

}  // namespace topple::primitives

// SPDX-License-Identifier: MIT
#include "geometry/frames_cells.h"

#include <algorithm>

namespace topple::geometry {
namespace {

// A block and the table that holds its cells.
struct BlockPlace {
    const CellTable::Block* block;
    const CellTable* table;
};

// Bits 0 to 20, 21 to 41 and 42 to 62 of a block's key are its z, y and x.
constexpr unsigned y_bits = 21, x_bits = 42;

// The first of the blocks after `begin` whose key differs above the lowest `bits` bits.
std::size_t end_of_group(const std::vector<BlockPlace>& blocks, std::size_t begin, std::size_t end,
                         unsigned bits) {
    std::size_t at = begin;
    while (at < end && blocks[at].block->key >> bits == blocks[begin].block->key >> bits) ++at;
    return at;
}

// Writes the cells of blocks [begin, end), which share their x, by ascending key.
void write_slab(const std::vector<BlockPlace>& blocks, std::size_t begin, std::size_t end,
                CellSums* out) {
    for (std::size_t x = 0; x < 4; ++x) {
        for (std::size_t column = begin, next = begin; column < end; column = next) {
            next = end_of_group(blocks, column, end, y_bits);
            for (std::size_t y = 0; y < 4; ++y) {
                for (std::size_t b = column; b < next; ++b) {
                    for (std::size_t z = 0; z < 4; ++z) {
                        const std::uint32_t at = blocks[b].block->at[16 * x + 4 * y + z];
                        if (at != 0) *out++ = blocks[b].table->cells()[at - 1];
                    }
                }
            }
        }
    }
}

}  // namespace

void CellSums::add(const CellSums& other) {
    for (std::size_t a = 0; a < 3; ++a) offset[a] += other.offset[a];
    weight += other.weight;
    count += other.count;
    if (other.best_weight > best_weight ||
        (other.best_weight == best_weight && other.best_frame < best_frame)) {
        best_weight = other.best_weight;
        best_frame = other.best_frame;
    }
}

CellTable::Block& CellTable::find(std::uint64_t key) {
    if (last_ < blocks_.size() && blocks_[last_].key == key) return blocks_[last_];
    if (2 * (blocks_.size() + 1) > slots_.size()) grow();
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = hash(key) & mask;
    while (slots_[at] != 0 && blocks_[slots_[at] - 1].key != key) at = (at + 1) & mask;
    if (slots_[at] == 0) {
        blocks_.push_back({.key = key});
        slots_[at] = static_cast<std::uint32_t>(blocks_.size());
    }
    last_ = slots_[at] - 1;
    return blocks_[last_];
}

void CellTable::add(const CellSums& sums) {
    Block& block = find(block_of(sums.key));
    const std::size_t local =
        (sums.key >> x_bits & 3) << 4 | (sums.key >> y_bits & 3) << 2 | (sums.key & 3);
    std::uint32_t& at = block.at[local];
    if (at != 0) {
        cells_[at - 1].add(sums);
        return;
    }
    cells_.push_back(sums);
    at = static_cast<std::uint32_t>(cells_.size());
    ++block.count;
}

void CellTable::grow() {
    slots_.assign(std::max<std::size_t>(2 * slots_.size(), 256), 0);
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t block = 0; block < blocks_.size(); ++block) {
        std::size_t at = hash(blocks_[block].key) & mask;
        while (slots_[at] != 0) at = (at + 1) & mask;
        slots_[at] = static_cast<std::uint32_t>(block + 1);
    }
}

std::vector<CellSums> CellTables::sorted(device::ThreadPool& pool) const {
    std::vector<BlockPlace> blocks;
    for (const CellTable& table : shards) {
        for (const CellTable::Block& block : table.blocks()) blocks.push_back({&block, &table});
    }
    std::sort(blocks.begin(), blocks.end(),
              [](const BlockPlace& a, const BlockPlace& b) { return a.block->key < b.block->key; });
    // Slabs of blocks with one x: where each begins among the blocks and among the cells.
    std::vector<std::size_t> slab{0}, first{0};
    while (slab.back() < blocks.size()) {
        const std::size_t end = end_of_group(blocks, slab.back(), blocks.size(), x_bits);
        std::size_t count = 0;
        for (std::size_t b = slab.back(); b < end; ++b) count += blocks[b].block->count;
        slab.push_back(end);
        first.push_back(first.back() + count);
    }
    std::vector<CellSums> cells(first.back());
    pool.run(slab.size() - 1, 1, [&](std::uint64_t begin, std::uint64_t end) {
        for (std::uint64_t s = begin; s < end; ++s) {
            write_slab(blocks, slab[s], slab[s + 1], cells.data() + first[s]);
        }
    });
    return cells;
}

}  // namespace topple::geometry

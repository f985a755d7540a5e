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
    if (other.colour_weight > 0) add_colour(other.colour, other.colour_weight);
}

void CellSums::add_colour(const std::array<std::uint32_t, 3>& sums, std::uint32_t weights) {
    constexpr std::uint32_t most_weight = UINT32_MAX / 255;
    if (weights > most_weight - colour_weight) return;
    for (std::size_t c = 0; c < 3; ++c) colour[c] += sums[c];
    colour_weight += weights;
}

std::size_t CellTable::find(std::uint64_t key) {
    if (last_ < blocks_.size() && blocks_[last_].key == key) return last_;
    if (2 * (blocks_.size() + 1) > slots_.size()) grow();
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = hash(key) & mask;
    while (slots_[at] != 0 && blocks_[slots_[at] - 1].key != key) at = (at + 1) & mask;
    if (slots_[at] == 0) {
        blocks_.push_back({.key = key});
        slots_[at] = static_cast<std::uint32_t>(blocks_.size());
    }
    last_ = slots_[at] - 1;
    return last_;
}

void CellTable::add(std::span<const CellSums> sums, std::span<const std::uint32_t> which) {
    // Tables are larger than caches: some sums at a time, so that the memory of each step is
    // fetched while the others are under way.
    constexpr std::size_t at_once = 16;
    std::array<std::uint32_t*, at_once> place{};
    std::array<std::size_t, at_once> block{};
    for (; !which.empty(); which = which.subspan(std::min(at_once, which.size()))) {
        const auto some = which.first(std::min(at_once, which.size()));
        const auto local = [&](std::size_t i) {
            const std::uint64_t key = sums[some[i]].key;
            return (key >> x_bits & 3) << 4 | (key >> y_bits & 3) << 2 | (key & 3);
        };
        if (!slots_.empty()) {
            for (const std::uint32_t s : some)
                __builtin_prefetch(&slots_[hash(block_of(sums[s].key)) & (slots_.size() - 1)]);
        }
        for (std::size_t i = 0; i < some.size(); ++i) block[i] = find(block_of(sums[some[i]].key));
        for (std::size_t i = 0; i < some.size(); ++i) {
            place[i] = &blocks_[block[i]].at[local(i)];
            __builtin_prefetch(place[i]);
        }
        for (std::size_t i = 0; i < some.size(); ++i) {
            if (*place[i] != 0) __builtin_prefetch(&cells_[*place[i] - 1]);
        }
        for (std::size_t i = 0; i < some.size(); ++i) {
            if (*place[i] != 0) {
                cells_[*place[i] - 1].add(sums[some[i]]);
                continue;
            }
            cells_.push_back(sums[some[i]]);
            *place[i] = static_cast<std::uint32_t>(cells_.size());
            ++blocks_[block[i]].count;
        }
    }
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

void CellTables::add(std::span<const std::span<const CellSums>> parts, ThreadPool& pool) {
    std::vector<std::array<std::vector<std::uint32_t>, shard_count>> of(parts.size());
    pool.each(parts.size(), 1, [&](std::size_t p) {
        for (std::size_t n = 0; n < parts[p].size(); ++n)
            of[p][shard_of(parts[p][n].key)].push_back(static_cast<std::uint32_t>(n));
    });
    pool.each(shard_count, 1, [&](std::size_t shard) {
        for (std::size_t p = 0; p < parts.size(); ++p) shards[shard].add(parts[p], of[p][shard]);
    });
}

std::vector<CellSums> CellTables::sorted(ThreadPool& pool) const {
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

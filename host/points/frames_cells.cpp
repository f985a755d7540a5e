// SPDX-License-Identifier: MIT
#include "points/frames_cells.h"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <utility>

namespace topple::geometry {
namespace {

// A block and the table that holds its cells.
struct BlockPlace {
    const CellTable::Block* block;
    CellTable* table;
};

// Blocks' keys hold their indices where cells' do.
constexpr unsigned y_bits = key_shift[1], x_bits = key_shift[0];

// A cell's place in its block, and a block's in its cube.
std::size_t place_in_block(std::uint64_t key) {
    return (key >> x_bits & 3) << 4 | (key >> y_bits & 3) << 2 | (key & 3);
}
std::size_t place_in_cube(std::uint64_t key) {
    return (key >> (x_bits + 2) & 7) << 6 | (key >> (y_bits + 2) & 7) << 3 | (key >> 2 & 7);
}

// The first of the blocks after `begin` whose key differs above the lowest `bits` bits.
std::size_t end_of_group(const std::vector<BlockPlace>& blocks, std::size_t begin, std::size_t end,
                         unsigned bits) {
    std::size_t at = begin;
    while (at < end && blocks[at].block->key >> bits == blocks[begin].block->key >> bits) ++at;
    return at;
}

// Writes the cells of blocks [begin, end), which share their x, by ascending key.
void write_slab(const std::vector<BlockPlace>& blocks, std::size_t begin, std::size_t end,
                CellSums** out) {
    for (std::size_t x = 0; x < 4; ++x) {
        for (std::size_t column = begin, next = begin; column < end; column = next) {
            next = end_of_group(blocks, column, end, y_bits);
            for (std::size_t y = 0; y < 4; ++y) {
                for (std::size_t b = column; b < next; ++b) {
                    for (std::size_t z = 0; z < 4; ++z) {
                        const std::uint32_t at = blocks[b].block->at[16 * x + 4 * y + z];
                        if (at != 0) *out++ = &blocks[b].table->cells()[at - 1];
                    }
                }
            }
        }
    }
}

}  // namespace

std::array<double, 3> mean_of(const CellSums& cell) {
    std::array<double, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) {
        at[a] = static_cast<double>(index_in(cell.key, a)) + mean_offset(cell, a) / cell_parts;
    }
    return at;
}

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

CellTable::Cube& CellTable::cube(std::uint64_t key) {
    if (last_ < cubes_.size() && cubes_[last_].key == key) return cubes_[last_];
    if (2 * (cubes_.size() + 1) > slots_.size()) grow();
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = hash(key) & mask;
    while (slots_[at] != 0 && cubes_[slots_[at] - 1].key != key) at = (at + 1) & mask;
    if (slots_[at] == 0) {
        cubes_.push_back({.key = key});
        slots_[at] = static_cast<std::uint32_t>(cubes_.size());
    }
    last_ = slots_[at] - 1;
    return cubes_[last_];
}

CellTable::Block& CellTable::block(std::uint64_t key) {
    std::uint32_t& place = cube(cube_of(key)).at[place_in_cube(key)];
    if (place == 0) {
        blocks_.push_back({.key = block_of(key)});
        place = static_cast<std::uint32_t>(blocks_.size());
    }
    return blocks_[place - 1];
}

std::uint32_t CellTable::place_of(std::uint64_t key) {
    Block& home = block(key);
    std::uint32_t& place = home.at[place_in_block(key)];
    if (place == 0) {
        CellSums none{};
        none.key = key;
        cells_.push_back(none);
        place = static_cast<std::uint32_t>(cells_.size());
        ++home.count;
    }
    return place - 1;
}

template <class Sums>
void CellTable::add(const Sums& sums, std::span<const std::uint32_t> which) {
    constexpr std::size_t at_once = 32;
    std::array<std::uint32_t, at_once> place{};
    for (; !which.empty(); which = which.subspan(std::min(at_once, which.size()))) {
        const auto some = which.first(std::min(at_once, which.size()));
        const auto beyond = which.subspan(some.size());
        for (std::size_t n = 0; n < some.size(); ++n) {
            if (n < beyond.size()) __builtin_prefetch(&sums(beyond[n]));
            place[n] = place_of(sums(some[n]).key);
            __builtin_prefetch(&cells_[place[n]]);
        }
        for (std::size_t n = 0; n < some.size(); ++n) cells_[place[n]].add(sums(some[n]));
    }
}

void CellTable::grow() {
    slots_.assign(std::max<std::size_t>(2 * slots_.size(), 256), 0);
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t cube = 0; cube < cubes_.size(); ++cube) {
        std::size_t at = hash(cubes_[cube].key) & mask;
        while (slots_[at] != 0) at = (at + 1) & mask;
        slots_[at] = static_cast<std::uint32_t>(cube + 1);
    }
}

namespace {

const CellSums& sums_at(std::span<const CellSums> cells, std::size_t n) {
    return cells[n];
}
const CellSums& sums_at(std::span<CellSums* const> cells, std::size_t n) {
    return cell_at(cells, n);
}

template <class Part>
void add_parts(CellTables& tables, std::span<const Part> parts, ThreadPool& pool,
               std::size_t most_bytes) {
    constexpr std::size_t count = CellTables::shard_count;
    std::vector<std::array<std::vector<std::uint32_t>, count>> of(parts.size());
    pool.each(parts.size(), 1, [&](std::size_t p) {
        for (std::size_t n = 0; n < parts[p].size(); ++n)
            of[p][CellTables::shard_of(sums_at(parts[p], n).key)].push_back(
                static_cast<std::uint32_t>(n));
    });
    std::atomic<std::size_t> held = tables.bytes();
    pool.each(count, 1, [&](std::size_t shard) {
        if (held > most_bytes) return;
        CellTable& table = tables.shards[shard];
        const std::size_t before = table.bytes();
        for (std::size_t p = 0; p < parts.size(); ++p) {
            const auto sums = [&](std::uint32_t n) -> const CellSums& {
                return sums_at(parts[p], n);
            };
            table.add(sums, of[p][shard]);
        }
        held += table.bytes() - before;
    });
}

}  // namespace

void CellTables::add(std::span<const std::span<const CellSums>> parts, ThreadPool& pool,
                     std::size_t most_bytes) {
    add_parts(*this, parts, pool, most_bytes);
}
void CellTables::add(std::span<const std::span<CellSums* const>> parts, ThreadPool& pool) {
    add_parts(*this, parts, pool, SIZE_MAX);
}

void NeighbourSums::add(const RowReadings& row, const std::uint8_t* rgb, std::uint32_t frame,
                        std::vector<CellSums>& sums, std::uint64_t& outside) {
    Home left;
    for (std::size_t u = 0; u < above_.size(); ++u) {
        Home& above = above_[u];
        if (row.kept[u] == 0 || row.inside[u] == 0) {
            outside += row.kept[u];
            left = above = {};
            continue;
        }
        std::array<std::uint64_t, 3> index{};
        std::array<std::uint32_t, 3> part{};
        for (std::size_t a = 0; a < 3; ++a) {
            index[a] = static_cast<std::uint32_t>(row.cell[a][u]);
            part[a] = static_cast<std::uint32_t>(row.part[a][u]);
        }
        const std::uint64_t key = key_of(index);
        const std::size_t at = key == left.key    ? left.at
                               : key == above.key ? above.at
                                                  : sums.size();
        if (at == sums.size()) {
            CellSums& none = sums.emplace_back();
            none.key = key;
            none.best_frame = frame;
        }
        sums[at].add(row.weight[u], part);
        left = above = {key, at};
        if (!rgb) continue;
        const std::uint8_t* const pixel = rgb + 3 * u;
        if ((pixel[0] | pixel[1] | pixel[2]) == 0) continue;  // not known
        const std::uint32_t coarse = (row.weight[u] + 255) >> 8;
        sums[at].add_colour({coarse * pixel[0], coarse * pixel[1], coarse * pixel[2]}, coarse);
    }
}

std::size_t CellTable::bytes() const {
    return slots_.capacity() * sizeof(std::uint32_t) + cubes_.capacity() * sizeof(Cube) +
           blocks_.size() * (sizeof(Block) + sizeof(BlockPlace)) +
           2 * cells_.size() * sizeof(CellSums);
}

void CellTable::drop_index() {
    slots_ = {};
    cubes_ = {};
    blocks_ = {};
}

std::size_t CellTables::bytes() const {
    std::size_t sum = 0;
    for (const CellTable& table : shards) sum += table.bytes();
    return sum;
}

CellPlaces CellTables::sorted(ThreadPool& pool) {
    std::vector<BlockPlace> blocks;
    for (CellTable& table : shards) {
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
    CellPlaces cells(first.back(), boost::container::default_init);
    pool.run(slab.size() - 1, 1, [&](std::uint64_t begin, std::uint64_t end) {
        for (std::uint64_t s = begin; s < end; ++s) {
            write_slab(blocks, slab[s], slab[s + 1], cells.data() + first[s]);
        }
    });
    return cells;
}

FusedCells::FusedCells(CellTables of, double edge_m, ThreadPool& pool)
    : cell_m(edge_m), tables(std::move(of)), cells(tables.sorted(pool)) {
    for (CellTable& table : tables.shards) table.drop_index();
#ifdef __GLIBC__
    // It lies scattered among the cells, where nothing large has room.
    ::malloc_trim(0);
#endif
}

}  // namespace topple::geometry

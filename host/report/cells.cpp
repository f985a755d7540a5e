// SPDX-License-Identifier: MIT
#include "report/cells.h"

#include <cmath>

namespace topple::report {
namespace {

constexpr std::uint64_t no_key = UINT64_MAX;

// Of the block that a cell lies in.
std::uint64_t block_of(const std::array<std::int32_t, 3>& index) {
    std::uint64_t key = 0;
    for (const auto value : index)
        key = key << 18 | (static_cast<std::uint32_t>(value + (1 << 20)) >> 3 & 0x3FFFF);
    return key;
}
// The cell's place within its block.
std::size_t place_of(const std::array<std::int32_t, 3>& index) {
    std::size_t place = 0;
    for (const auto value : index)
        place = place << 3 | (static_cast<std::uint32_t>(value + (1 << 20)) & 7);
    return place;
}

bool unit(std::array<float, 3>& v) {
    const float length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (!(length > 1e-6f)) return false;
    for (auto& value : v) value /= length;
    return true;
}

}  // namespace

CellTable::CellTable() : keys_(64, no_key), blocks_(64, absent), shift_(64 - 6) {}

std::size_t CellTable::slot_of(std::uint64_t key) const {
    // The highest bits of the product depend on all of the key's.
    auto slot = (key * 0x9E3779B97F4A7C15u) >> shift_;
    while (keys_[slot] != no_key && keys_[slot] != key) slot = (slot + 1) & (keys_.size() - 1);
    return slot;
}

std::uint32_t CellTable::find(const std::array<std::int32_t, 3>& index) const {
    const auto block = blocks_[slot_of(block_of(index))];
    return block == absent ? absent : values_[block * block_cells + place_of(index)];
}

std::uint32_t CellTable::insert(const std::array<std::int32_t, 3>& index, std::uint32_t value) {
    const auto key = block_of(index);
    const auto slot = slot_of(key);
    std::size_t block = blocks_[slot];
    if (keys_[slot] == no_key) {
        block = values_.size() / block_cells;
        keys_[slot] = key;
        blocks_[slot] = static_cast<std::uint32_t>(block);
        values_.resize(values_.size() + block_cells, absent);
        if (2 * (block + 1) > keys_.size()) grow();
    }
    auto& stored = values_[block * block_cells + place_of(index)];
    if (stored == absent) stored = value;
    return stored;
}

void CellTable::grow() {
    std::vector<std::uint64_t> keys(2 * keys_.size(), no_key);
    std::vector<std::uint32_t> blocks(keys.size(), absent);
    keys.swap(keys_);
    blocks.swap(blocks_);
    --shift_;
    for (std::size_t old = 0; old < keys.size(); ++old) {
        if (keys[old] == no_key) continue;
        const auto slot = slot_of(keys[old]);
        keys_[slot] = keys[old];
        blocks_[slot] = blocks[old];
    }
}

std::array<std::array<std::int32_t, 3>, 6> beside(const std::array<std::int32_t, 3>& index) {
    const auto [i, j, k] = index;
    return {
        {{i - 1, j, k}, {i + 1, j, k}, {i, j - 1, k}, {i, j + 1, k}, {i, j, k - 1}, {i, j, k + 1}}};
}

std::size_t mark_exposed(std::vector<Cell>& cells, const CellTable& table) {
    std::size_t count = 0;
    for (auto& cell : cells) {
        unsigned faces = 0, bit = 1;
        for (const auto& other : beside(cell.index)) {
            if (table.find(other) == CellTable::absent) faces |= bit;
            bit <<= 1;
        }
        cell.exposed = static_cast<std::uint8_t>(faces);
        count += cell.exposed != 0;
    }
    return count;
}

std::vector<std::uint32_t> spread_normals(std::vector<Cell>& cells, const CellTable& table) {
    std::vector<std::uint32_t> missing;
    for (std::uint32_t i = 0; i < cells.size(); ++i) {
        if (unit(cells[i].normal)) continue;
        cells[i].normal = {};
        if (cells[i].background) missing.push_back(i);
    }
    for (int ring = 0; ring < 8 && !missing.empty(); ++ring) {
        // All of a ring read the ring before: the result does not depend on the order of the cells.
        std::vector<std::array<float, 3>> found(missing.size());
        for (std::size_t k = 0; k < missing.size(); ++k) {
            each_beside(cells[missing[k]].index, table, [&](std::uint32_t other) {
                if (!cells[other].background) return;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    found[k][axis] += cells[other].normal[axis];
            });
        }
        std::vector<std::uint32_t> still;
        for (std::size_t k = 0; k < missing.size(); ++k) {
            if (unit(found[k])) {
                cells[missing[k]].normal = found[k];
            } else {
                still.push_back(missing[k]);
            }
        }
        if (still.size() == missing.size()) break;
        missing = std::move(still);
    }
    return missing;
}

}  // namespace topple::report

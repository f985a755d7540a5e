// SPDX-License-Identifier: MIT
#include "solids/patch_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/sort_unique.h"

namespace topple::solids {
namespace {

constexpr std::uint64_t map_chunk = 1 << 14;  // points or cells handed to a thread at once

using Sighting = std::pair<std::uint64_t, std::int32_t>;  // a cell's key, a patch

// 21 bits of each; cells that share a key are far from one another.
std::uint64_t cell_key(const Place& at) {
    std::uint64_t out = 0;
    for (const std::int32_t a : at) out = out << 21 | (static_cast<std::uint32_t>(a) & 0x1fffff);
    return out;
}

}  // namespace

PatchMap::PatchMap(const GridPoints& points, std::span<const std::int32_t> patch_of_point,
                   std::span<const std::int32_t> counts, double cell_m, ThreadPool& threads)
    : cell_m_(cell_m) {
    std::vector<std::vector<Sighting>> parts(points.size() / map_chunk + 1);
    threads.run(points.size(), map_chunk, [&](std::uint64_t first, std::uint64_t last) {
        std::vector<Sighting>& part = parts[first / map_chunk];
        for (std::uint64_t n = first; n < last; ++n) {
            if (patch_of_point[n] < 0 || counts[n] < 0) continue;
            const Sighting s(cell_key(cell_of(points[n])), patch_of_point[n]);
            if (part.empty() || part.back() != s) part.push_back(s);  // as most points of a scan
        }
        sort_unique(part);
    });
    std::vector<Sighting> all = joined(parts);
    sort_unique(all);
    for (const auto& [key, patch] : all) {
        if (key_.empty() || key_.back() != key) {
            key_.push_back(key);
            first_.push_back(static_cast<std::uint32_t>(patch_.size()));
        }
        patch_.push_back(patch);
    }
    first_.push_back(static_cast<std::uint32_t>(patch_.size()));
    hash_cells();
    gather_all(threads);
}

Place PatchMap::cell_of(const Eigen::Vector3d& p) const {
    Place out{};
    for (int a = 0; a < 3; ++a)
        out[a] = static_cast<std::int32_t>(std::clamp(std::floor(p[a] / cell_m_), -2e9, 2e9));
    return out;
}

std::span<const std::int32_t> PatchMap::around(const Eigen::Vector3d& p,
                                               std::vector<std::int32_t>& room) const {
    const Place at = cell_of(p);
    const std::uint32_t cell = find(cell_key(at));
    if (cell != none)
        return std::span(near_).subspan(near_first_[cell],
                                        near_first_[cell + 1] - near_first_[cell]);
    gather(at, room);
    return room;
}

std::uint32_t PatchMap::find(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t at = key * 0x9e3779b97f4a7c15U >> 32 & mask;; at = (at + 1) & mask)
        if (slots_[at] == none || key_[slots_[at]] == key) return slots_[at];
}

void PatchMap::hash_cells() {
    slots_.assign(std::bit_ceil(2 * key_.size() + 1), none);
    const std::size_t mask = slots_.size() - 1;
    for (std::uint32_t cell = 0; cell < key_.size(); ++cell) {
        std::size_t at = key_[cell] * 0x9e3779b97f4a7c15U >> 32 & mask;
        while (slots_[at] != none) at = (at + 1) & mask;
        slots_[at] = cell;
    }
}

void PatchMap::gather(const Place& at, std::vector<std::int32_t>& out) const {
    out.clear();
    for (const Place& beside : topple::around(at)) {
        const std::uint32_t cell = find(cell_key(beside));
        if (cell == none) continue;
        for (const std::int32_t patch : seen_in(cell))
            if (std::ranges::find(out, patch) == out.end()) out.push_back(patch);
    }
    std::ranges::sort(out);
}

// Most of them are asked for more than once.
void PatchMap::gather_all(ThreadPool& threads) {
    struct Part {
        std::vector<std::int32_t> near;
        std::vector<std::uint32_t> count;
    };
    std::vector<Part> parts(key_.size() / map_chunk + 1);
    threads.run(key_.size(), map_chunk, [&](std::uint64_t first, std::uint64_t last) {
        Part& part = parts[first / map_chunk];
        std::vector<std::int32_t> near;
        for (std::uint64_t cell = first; cell < last; ++cell) {
            // Of the same key as the cell itself, and so are those beside it.
            gather({static_cast<std::int32_t>(key_[cell] >> 42 & 0x1fffff),
                    static_cast<std::int32_t>(key_[cell] >> 21 & 0x1fffff),
                    static_cast<std::int32_t>(key_[cell] & 0x1fffff)},
                   near);
            part.near.insert(part.near.end(), near.begin(), near.end());
            part.count.push_back(static_cast<std::uint32_t>(near.size()));
        }
    });
    near_first_.push_back(0);
    for (const Part& part : parts) {
        for (const std::uint32_t count : part.count)
            near_first_.push_back(near_first_.back() + count);
        near_.insert(near_.end(), part.near.begin(), part.near.end());
    }
}

}  // namespace topple::solids

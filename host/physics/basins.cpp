// SPDX-License-Identifier: MIT
#include "physics/basins.h"

#include <bit>
#include <limits>
#include <numeric>

namespace topple::physics {
namespace {

// Follows every descent to its end, by steps that double; the ends by rising number.
std::vector<std::uint32_t> follow(std::span<std::uint32_t> down) {
    for (std::uint32_t changed = 1; changed != 0;) {
        changed = 0;
        for (std::uint32_t& to : down) {
            const std::uint32_t next = down[to];
            changed |= next ^ to;
            to = next;
        }
    }
    std::vector<std::uint32_t> minima;
    for (std::uint32_t v = 0; v < down.size(); ++v) {
        if (down[v] == v) minima.push_back(v);
    }
    return minima;
}

struct Saddle {
    float height = 0;
    std::uint32_t a = 0, b = 0;  // basins, a < b
};

std::vector<Saddle> saddles(std::span<const float> height, const SphereMesh& mesh,
                            std::span<const std::uint32_t> basin_of, std::size_t basins) {
    // Basins hang together, so that on a sphere fewer than three pairs for each of them can meet: a
    // hash table of eight has room.
    constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> table(std::bit_ceil(8 * basins), none);
    std::vector<Saddle> all;
    for (std::uint32_t v = 0; v < basin_of.size(); ++v) {
        const std::uint32_t a = basin_of[v];
        const auto around = std::span(mesh.neighbour).subspan(std::size_t{v} * 6, 6);
        std::uint32_t last = a;
        for (const std::uint32_t w : around) last = std::max(last, basin_of[w]);
        if (last == a) continue;  // most are inside of their basin
        for (const std::uint32_t w : around) {
            const std::uint32_t b = basin_of[w];
            if (b <= a) continue;
            const float over = std::max(height[v], height[w]);
            std::size_t slot = (a * 0x9E3779B1U + b * 0x85EBCA77U) >> 7;
            for (;; ++slot) {
                std::uint32_t& s = table[slot &= table.size() - 1];
                if (s == none) {
                    s = static_cast<std::uint32_t>(all.size());
                    all.push_back({over, a, b});
                } else if (all[s].a != a || all[s].b != b) {
                    continue;
                }
                all[s].height = std::min(all[s].height, over);
                break;
            }
        }
    }
    return all;
}

}  // namespace

Basins::Basins(std::span<const float> height, const SphereMesh& mesh, std::span<std::uint32_t> down,
               std::uint32_t start)
    : height_(height), basin_of_(down), minima_(follow(down)) {
    const std::size_t count = minima_.size();
    std::vector<std::uint32_t> number(down.size());
    for (std::uint32_t b = 0; b < count; ++b) number[minima_[b]] = b;
    for (std::uint32_t& basin : down) basin = number[basin];

    std::vector<Saddle> rising = saddles(height, mesh, basin_of_, count);
    std::sort(rising.begin(), rising.end(),
              [](const Saddle& s, const Saddle& t) { return s.height < t.height; });
    level_.assign(count, std::numeric_limits<float>::infinity());
    const std::uint32_t home = basin_of_[start];
    level_[home] = height[start];
    // Joined basins are a ring, whose members share its name.
    std::vector<std::uint32_t> ring(count), name(count), size(count, 1);
    std::iota(ring.begin(), ring.end(), 0U);
    std::iota(name.begin(), name.end(), 0U);
    for (const Saddle& s : rising) {
        std::uint32_t kept = s.a, joins = s.b;
        if (name[kept] == name[joins]) continue;
        if (name[joins] == name[home] ||
            (name[kept] != name[home] && size[name[joins]] > size[name[kept]]))
            std::swap(kept, joins);
        const bool reached = name[kept] == name[home];
        size[name[kept]] += size[name[joins]];
        std::uint32_t member = joins;
        do {
            name[member] = name[kept];
            if (reached) level_[member] = std::max(s.height, height[start]);
            member = ring[member];
        } while (member != joins);
        std::swap(ring[kept], ring[joins]);
    }
}

}  // namespace topple::physics

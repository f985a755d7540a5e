// SPDX-License-Identifier: MIT
#include "physics/basins.h"

#include <limits>
#include <numeric>

namespace topple::physics {
namespace {

// Follows every descent to its end, by steps that double; the ends by rising number. Passes go up
// and down the numbers in turn: a descent on which they rise or fall all the way takes only one.
std::vector<std::uint32_t> follow(std::span<std::uint32_t> down) {
    const std::size_t size = down.size();
    std::uint32_t changed = 1;
    const auto step = [&](std::uint32_t& to) {
        const std::uint32_t next = down[to];
        changed |= next ^ to;
        to = next;
    };
    for (bool rising = true; changed != 0; rising = !rising) {
        changed = 0;
        if (rising) {
            for (std::size_t v = 0; v < size; ++v) step(down[v]);
        } else {
            for (std::size_t v = size; v-- > 0;) step(down[v]);
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
    // Most of the mesh's edges are inside of a basin; which ones no branch could foretell.
    std::vector<std::uint32_t> border(mesh.edge.size() + 1);
    std::size_t count = 0;
    for (std::uint32_t e = 0; e < mesh.edge.size(); ++e) {
        border[count] = e;
        count += basin_of[mesh.edge[e][0]] != basin_of[mesh.edge[e][1]];
    }
    border.resize(count);
    std::vector<Saddle> all;
    const auto visit = [&](const auto& take) {
        for (const std::uint32_t e : border) {
            const auto [v, w] = mesh.edge[e];
            const auto [a, b] = std::minmax(basin_of[v], basin_of[w]);
            take(a, b, std::max(height[v], height[w]));
        }
    };
    // Landscapes have few basins, so that a square table holds the saddles of all pairs. Of many
    // basins every edge counts as a saddle, which makes the same of them.
    constexpr std::size_t few = 128;
    if (basins > few) {
        visit([&](std::uint32_t a, std::uint32_t b, float over) { all.push_back({over, a, b}); });
        return all;
    }
    constexpr float none = std::numeric_limits<float>::infinity();
    std::vector<float> lowest(basins * basins, none);
    visit([&](std::uint32_t a, std::uint32_t b, float over) {
        float& least = lowest[a * basins + b];
        least = std::min(least, over);
    });
    for (std::uint32_t a = 0; a < basins; ++a) {
        for (std::uint32_t b = a + 1; b < basins; ++b) {
            const float over = lowest[a * basins + b];
            if (over < none) all.push_back({over, a, b});
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

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>
#include <tuple>
#include <unordered_map>

#include "core/thread_pool.h"
#include "physics/bodies.h"
#include "topple/error.h"
#include "topple/kernels/device.h"

namespace topple::physics {
namespace {

struct PairSums {
    std::array<std::uint32_t, 6> faces{};
    std::array<std::int64_t, 3> twice{};                // twice the face centres, in voxels
    std::array<std::array<std::int64_t, 3>, 4> ends{};  // those furthest along -x, +x, -y, +y
    std::uint64_t count = 0;
};

using Sums = std::unordered_map<std::uint64_t, PairSums>;  // sorted by key before it is used

bool before(const SolidCells& c, std::size_t n, std::int64_t i, std::int64_t j, std::int64_t k) {
    if (c.i[n] != i) return c.i[n] < i;
    if (c.j[n] != j) return c.j[n] < j;
    return c.k[n] < k;
}

// Of ends that are as far, the first stands.
void add(const PairSums& more, PairSums& pair) {
    for (std::size_t e = 0; e < 4; ++e) {
        const std::int64_t sign = e % 2 ? 1 : -1;
        if (pair.count == 0 || sign * more.ends[e][e / 2] > sign * pair.ends[e][e / 2])
            pair.ends[e] = more.ends[e];
    }
    for (std::size_t k = 0; k < 3; ++k) pair.twice[k] += more.twice[k];
    for (std::size_t d = 0; d < 6; ++d) pair.faces[d] += more.faces[d];
    pair.count += more.count;
}

void record(const SolidCells& c, std::size_t n, std::size_t m, std::size_t axis, Sums& sums) {
    std::int32_t a = c.primitive[n], b = c.primitive[m];
    if (a < 0 || b < 0 || a == b) return;
    std::size_t direction = axis * 2 + 1;  // n lies on the low side of m
    if (a > b) {
        std::swap(a, b);
        direction -= 1;
    }
    const std::uint64_t key = (static_cast<std::uint64_t>(a) << 32) | static_cast<std::uint32_t>(b);
    const std::array<std::int64_t, 3> twice{std::int64_t{c.i[n]} + c.i[m] + 1,
                                            std::int64_t{c.j[n]} + c.j[m] + 1,
                                            std::int64_t{c.k[n]} + c.k[m] + 1};
    PairSums face{.twice = twice, .count = 1};
    face.faces[direction] = 1;
    face.ends.fill(twice);
    add(face, sums[key]);
}

// Finds for every cell the next solid cell along +axis, at most gap empty voxels away. The cells
// are sorted, and so are the places looked for: one walk with two pointers for each distance.
void sweep(const SolidCells& c, std::size_t axis, unsigned gap, Sums& sums) {
    std::vector<bool> met(c.size(), false);
    for (std::int64_t step = 1; step <= std::int64_t{gap} + 1; ++step) {
        std::size_t m = 0;
        for (std::size_t n = 0; n < c.size(); ++n) {
            const std::int64_t i = c.i[n] + (axis == 0 ? step : 0);
            const std::int64_t j = c.j[n] + (axis == 1 ? step : 0);
            const std::int64_t k = c.k[n] + (axis == 2 ? step : 0);
            while (m < c.size() && before(c, m, i, j, k)) ++m;
            if (m == c.size()) break;
            if (c.i[m] != i || c.j[m] != j || c.k[m] != k || met[n]) continue;
            met[n] = true;
            record(c, n, m, axis, sums);
        }
    }
}

TouchingPair finish(std::uint64_t key, const PairSums& sums, double voxel_m) {
    TouchingPair pair;
    pair.a = static_cast<std::int32_t>(key >> 32);
    pair.b = static_cast<std::int32_t>(key & 0xffffffffU);
    pair.faces = sums.faces;
    // Equal counts go to the vertical first: it is what carries weight.
    std::size_t best = 5;
    for (const std::size_t d : {5UL, 4UL, 0UL, 1UL, 2UL, 3UL}) {
        if (pair.faces[d] > pair.faces[best]) best = d;
    }
    pair.area_m2 = pair.faces[best] * voxel_m * voxel_m;
    pair.normal[best / 2] = best % 2 ? 1.0 : -1.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        pair.center[axis] = static_cast<double>(sums.twice[axis]) /
                            (2.0 * static_cast<double>(sums.count)) * voxel_m;
        for (std::size_t e = 0; e < 4; ++e)
            pair.ends[e][axis] = static_cast<double>(sums.ends[e][axis]) / 2 * voxel_m;
    }
    return pair;
}

}  // namespace

std::vector<TouchingPair> touching_pairs(device::Device& device, const SolidCells& cells,
                                         std::int32_t count, unsigned gap) {
    for (std::size_t n = 0; n < cells.size(); ++n) {
        if (cells.primitive[n] >= count) {
            throw Error(ErrorKind::input, "solid cells: primitive " +
                                              std::to_string(cells.primitive[n]) +
                                              " is not below " + std::to_string(count));
        }
        if (n > 0 && !before(cells, n - 1, cells.i[n], cells.j[n], cells.k[n])) {
            throw Error(ErrorKind::input, "solid cells: cell " + std::to_string(n) +
                                              " is not after the one before it; sort by (i, j, k)");
        }
    }
    std::array<Sums, 3> along;
    device.threads().each(3, 1, [&](std::size_t axis) { sweep(cells, axis, gap, along[axis]); });
    Sums& sums = along[0];
    for (const std::size_t axis : {1UL, 2UL}) {
        for (const auto& [key, value] : along[axis]) add(value, sums[key]);
    }
    std::vector<TouchingPair> pairs;
    pairs.reserve(sums.size());
    for (const auto& [key, value] : sums) pairs.push_back(finish(key, value, cells.voxel_m));
    std::sort(pairs.begin(), pairs.end(), [](const TouchingPair& p, const TouchingPair& q) {
        return std::tie(p.a, p.b) < std::tie(q.a, q.b);
    });
    return pairs;
}

}  // namespace topple::physics

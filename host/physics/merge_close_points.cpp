// SPDX-License-Identifier: MIT
#include "physics/merge_close_points.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace topple::physics {
namespace {

std::uint64_t hash(const std::array<std::int64_t, 3>& cell) {
    std::uint64_t out = 0;
    for (const std::int64_t a : cell)
        out = (std::rotl(out, 21) ^ static_cast<std::uint64_t>(a)) * 0x9e3779b97f4a7c15U;
    return out >> 20;
}

}  // namespace

std::vector<Vec3> merge_close_points(const std::vector<Vec3>& points, double tolerance_m) {
    // Cells of twice the tolerance, so that what is within it lies in two of them along each axis.
    // Chains of kept points by their cell's hash: which cell they are of, their distance tells.
    constexpr std::uint32_t none = ~0U;
    std::vector<std::uint32_t> first(std::bit_ceil(2 * points.size() + 1), none), next;
    const std::uint64_t mask = first.size() - 1;
    std::vector<Vec3> out;
    for (const Vec3& p : points) {
        std::array<std::int64_t, 3> cell{}, beside{};
        for (std::size_t a = 0; a < 3; ++a) {
            const double at = p[a] / (2 * tolerance_m);
            cell[a] = static_cast<std::int64_t>(std::floor(at));
            beside[a] = at - std::floor(at) < 0.5 ? -1 : 1;
        }
        bool near = false;
        for (unsigned n = 0; n < 8 && !near; ++n) {
            std::array<std::int64_t, 3> other = cell;
            for (std::size_t a = 0; a < 3; ++a)
                if (n >> a & 1) other[a] += beside[a];
            for (std::uint32_t k = first[hash(other) & mask]; k != none && !near; k = next[k]) {
                const Vec3& q = out[k];
                const double x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2];
                near = x * x + y * y + z * z <= tolerance_m * tolerance_m;
            }
        }
        if (near) continue;
        std::uint32_t& head = first[hash(cell) & mask];
        next.push_back(head);
        head = static_cast<std::uint32_t>(out.size());
        out.push_back(p);
    }
    return out;
}

}  // namespace topple::physics

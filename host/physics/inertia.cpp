// SPDX-License-Identifier: MIT
#include "physics/inertia.h"

#include <cmath>
#include <cstddef>

#include "physics/solid_pieces.h"

namespace topple::physics {
namespace {

constexpr std::array<std::array<std::size_t, 2>, 6> axes{
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};

// share: of a cube of edge h, about `at`.
void add(const Vec3& at, double share, double h, Symmetric& to) {
    const double volume = share * h * h * h, width = std::cbrt(share) * h;
    for (std::size_t e = 0; e < 6; ++e) to[e] += volume * at[axes[e][0]] * at[axes[e][1]];
    for (std::size_t a = 0; a < 3; ++a) to[a] += volume * width * width / 12;
}

}  // namespace

std::vector<Symmetric> second_moments(const SolidCells& cells, std::int32_t count,
                                      const BoundaryCells& boundary) {
    std::vector<Symmetric> out(static_cast<std::size_t>(count), Symmetric{});
    each_solid_piece(cells, boundary, [&](const SolidPiece& piece) {
        add(piece.centre, piece.share, cells.voxel_m, out[piece.primitive]);
    });
    return out;
}

std::vector<Symmetric> inertia_of_objects(std::span<const Symmetric> moments,
                                          std::span<const MassProperties> bodies,
                                          std::span<const std::int32_t> object_of_primitive,
                                          std::span<const double> density_kg_m3) {
    struct Sum {
        double volume = 0;
        Vec3 first{};
        Symmetric second{};
    };
    std::vector<Sum> sums(density_kg_m3.size());
    for (std::size_t p = 0; p < bodies.size(); ++p) {
        if (object_of_primitive[p] < 0) continue;
        Sum& sum = sums[object_of_primitive[p]];
        sum.volume += bodies[p].volume_m3;
        for (std::size_t a = 0; a < 3; ++a)
            sum.first[a] += bodies[p].volume_m3 * bodies[p].center[a];
        for (std::size_t e = 0; e < 6; ++e) sum.second[e] += moments[p][e];
    }
    std::vector<Symmetric> out(sums.size(), Symmetric{});
    for (std::size_t o = 0; o < sums.size(); ++o) {
        Sum& sum = sums[o];
        if (!(sum.volume > 0)) continue;
        for (std::size_t e = 0; e < 6; ++e)
            sum.second[e] -= sum.first[axes[e][0]] * sum.first[axes[e][1]] / sum.volume;
        const double trace = sum.second[0] + sum.second[1] + sum.second[2];
        for (std::size_t e = 0; e < 6; ++e)
            out[o][e] = density_kg_m3[o] * ((e < 3 ? trace : 0) - sum.second[e]);
    }
    return out;
}

}  // namespace topple::physics

// SPDX-License-Identifier: MIT
#include "physics/landscape.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "group_landscape.hpp"
#include "lab/random.h"
#include "perf/cases/cases.h"
#include "steepest_descent.hpp"
#include "support_function.hpp"

namespace topple::perf {
namespace {

using scenes::Random;
using Floats = std::vector<float>;

// Directions of a geodesic mesh, the last one repeated up to `padded`.
struct Directions {
    Floats x, y, z;
    std::size_t used = 0;
};
Directions directions(unsigned frequency, std::size_t padded) {
    const physics::SphereMesh mesh = physics::geodesic_sphere(frequency);
    Directions d{mesh.x, mesh.y, mesh.z, mesh.size()};
    for (Floats* axis : {&d.x, &d.y, &d.z}) axis->resize(padded, axis->back());
    return d;
}

// Support function of a box with these half sides, its centre being the origin: -min v.d = sum |d|
// h.
float box_height(const Directions& d, std::size_t at, const std::array<float, 3>& half) {
    return std::abs(d.x[at]) * half[0] + std::abs(d.y[at]) * half[1] + std::abs(d.z[at]) * half[2];
}

}  // namespace

// One primitive with 512 hull vertices over a mesh of frequency 80.
Prepared support_function(device::Device& device) {
    constexpr std::uint32_t vertices = 512, padded = 64064;
    const Directions d = directions(80, padded);
    Random random(1);
    Floats v[3];
    for (std::uint32_t n = 0; n < vertices; ++n) {
        double p[3], length = 0;
        for (double& c : p) {
            c = random.normal();
            length += c * c;
        }
        for (int k = 0; k < 3; ++k)
            v[k].push_back(static_cast<float>(0.3 * p[k] / std::sqrt(length)));
    }
    struct Buffers {
        device::Buffer<float> vx, vy, vz, dx, dy, dz, s;
    };
    auto on = std::make_shared<Buffers>(Buffers{upload(device, v[0], "vx"),
                                                upload(device, v[1], "vy"),
                                                upload(device, v[2], "vz"),
                                                upload(device, d.x, "dx"),
                                                upload(device, d.y, "dy"),
                                                upload(device, d.z, "dz"),
                                                {device, padded, "s"}});
    const double dots = double{vertices} * padded;
    return {{dots, "dot products", 16.0 * padded + 12.0 * vertices, 6 * dots},
            [on](device::Queue& queue) {
                queue.add<kernels::SupportFunction>(padded,
                                                    {.vx = on->vx,
                                                     .vy = on->vy,
                                                     .vz = on->vz,
                                                     .dx = on->dx,
                                                     .dy = on->dy,
                                                     .dz = on->dz,
                                                     .s = on->s},
                                                    {.vertex_count = vertices,
                                                     .vertex_first = 0,
                                                     .direction_count = padded,
                                                     .output_first = 0});
            },
            {},
            [on] { return Hash().add(on->s.download()).value(); }};
}

// 1,024 candidates of 1 to 8 members out of 96 primitives, on the mesh that the sampler uses.
Prepared group_landscape(device::Device& device) {
    constexpr std::uint32_t primitives = 96, candidates = 1024, padded = 2688;
    const Directions d = directions(16, padded);
    Random random(2);
    Floats s(std::size_t{primitives} * padded), origin[3];
    for (std::uint32_t p = 0; p < primitives; ++p) {
        std::array<float, 3> half{};
        for (float& h : half) h = static_cast<float>(random(0.02, 0.5));
        for (std::size_t n = 0; n < padded; ++n)
            s[std::size_t{p} * padded + n] = -box_height(d, n, half);
    }
    std::vector<std::uint32_t> first{0}, row;
    for (std::uint32_t c = 0; c < candidates; ++c) {
        const int members = random.integer(1, 8);
        for (int m = 0; m < members; ++m) {
            row.push_back(static_cast<std::uint32_t>(random.integer(0, primitives - 1)));
            for (Floats& o : origin) o.push_back(static_cast<float>(random(-0.5, 0.5)));
        }
        first.push_back(static_cast<std::uint32_t>(row.size()));
    }
    struct Buffers {
        device::Buffer<float> s, dx, dy, dz;
        device::Buffer<std::uint32_t> first, row;
        device::Buffer<float> ox, oy, oz, energy;
    };
    auto on =
        std::make_shared<Buffers>(Buffers{upload(device, s, "s"),
                                          upload(device, d.x, "dx"),
                                          upload(device, d.y, "dy"),
                                          upload(device, d.z, "dz"),
                                          upload(device, first, "first"),
                                          upload(device, row, "row"),
                                          upload(device, origin[0], "ox"),
                                          upload(device, origin[1], "oy"),
                                          upload(device, origin[2], "oz"),
                                          {device, std::uint64_t{candidates} * padded, "energy"}});
    const double updates = static_cast<double>(row.size()) * padded;
    return {{updates, "member directions",
             4.0 * (static_cast<double>(s.size()) + double{candidates} * padded), 7 * updates},
            [on](device::Queue& queue) {
                queue.add<kernels::GroupLandscape>(std::uint64_t{candidates} * padded,
                                                   {.s = on->s,
                                                    .dx = on->dx,
                                                    .dy = on->dy,
                                                    .dz = on->dz,
                                                    .first = on->first,
                                                    .row = on->row,
                                                    .ox = on->ox,
                                                    .oy = on->oy,
                                                    .oz = on->oz,
                                                    .energy = on->energy},
                                                   {.candidate_count = candidates,
                                                    .tile_directions = padded,
                                                    .padded_directions = padded,
                                                    .tile_first = 0});
            },
            {},
            [on] { return Hash().add(on->energy.download()).value(); }};
}

// Landscapes of 1,024 boxes, on the mesh that the sampler uses.
Prepared steepest_descent(device::Device& device) {
    constexpr std::uint32_t candidates = 1024, padded = 2688;
    const physics::SphereMesh mesh = physics::geodesic_sphere(16);
    const Directions d = directions(16, padded);
    Random random(3);
    Floats energy(std::size_t{candidates} * padded, 3.0e38f);
    for (std::uint32_t c = 0; c < candidates; ++c) {
        std::array<float, 3> half{};
        for (float& h : half) h = static_cast<float>(random(0.05, 0.5));
        for (std::size_t n = 0; n < d.used; ++n)
            energy[std::size_t{c} * padded + n] = box_height(d, n, half);
    }
    std::vector<std::uint32_t> neighbour(6 * padded);
    for (std::uint32_t k = 0; k < 6; ++k) {
        for (std::uint32_t n = 0; n < padded; ++n) {
            neighbour[k * padded + n] = n < d.used ? mesh.neighbour[6 * n + k] : n;
        }
    }
    struct Buffers {
        device::Buffer<float> energy;
        device::Buffer<std::uint32_t> neighbour, down;
    };
    auto on = std::make_shared<Buffers>(Buffers{upload(device, energy, "energy"),
                                                upload(device, neighbour, "neighbour"),
                                                {device, energy.size(), "down"}});
    const double all = double{candidates} * padded;
    return {{all, "directions", 8 * all + 24.0 * padded, 7 * all, 0, 6 * all},
            [on](device::Queue& queue) {
                queue.add<kernels::SteepestDescent>(
                    std::uint64_t{candidates} * padded,
                    {.energy = on->energy, .neighbour = on->neighbour, .down = on->down},
                    {.candidate_count = candidates, .padded_directions = padded});
            },
            {},
            [on] { return Hash().add(on->down.download()).value(); }};
}

}  // namespace topple::perf

// SPDX-License-Identifier: MIT
#include <cmath>
#include <memory>
#include <numbers>

#include "group_stance.hpp"
#include "lab/random.h"
#include "perf/cases/cases.h"
#include "support_function.hpp"

namespace topple::perf {
namespace {

using scenes::Random;
using Coordinates = std::array<std::vector<float>, 3>;

Coordinates on_sphere(Random& random, std::size_t count, double radius) {
    Coordinates out;
    for (std::size_t n = 0; n < count; ++n) {
        double p[3], length2 = 0;
        for (double& c : p) {
            c = random.normal();
            length2 += c * c;
        }
        for (std::size_t a = 0; a < 3; ++a)
            out[a].push_back(static_cast<float>(radius * p[a] / std::sqrt(length2)));
    }
    return out;
}

}  // namespace

// One primitive with 512 hull vertices, all on a sphere.
Prepared support_function(device::Device& device) {
    constexpr std::uint32_t vertices = 512, padded = 64064;
    Random random(1);
    const Coordinates v = on_sphere(random, vertices, 0.3), d = on_sphere(random, padded, 1);
    struct Buffers {
        device::Buffer<float> vx, vy, vz, dx, dy, dz, s;
    };
    auto on = std::make_shared<Buffers>(Buffers{upload(device, v[0], "vx"),
                                                upload(device, v[1], "vy"),
                                                upload(device, v[2], "vz"),
                                                upload(device, d[0], "dx"),
                                                upload(device, d[1], "dy"),
                                                upload(device, d[2], "dz"),
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

// 65,536 groups of 1 to 8 footings out of 2,000, as the sampler proposes them in a large room.
Prepared group_stance(device::Device& device) {
    constexpr std::uint32_t groups = 65536, rows = 2000, directions = 64;
    Random random(2);
    std::vector<float> ux, uy, reach, cx, cy;
    for (std::uint32_t d = 0; d < directions; ++d) {
        ux.push_back(static_cast<float>(std::cos(2 * std::numbers::pi * d / directions)));
        uy.push_back(static_cast<float>(std::sin(2 * std::numbers::pi * d / directions)));
    }
    for (std::uint32_t f = 0; f < rows; ++f) {
        const auto x = static_cast<float>(random(-5, 5)), y = static_cast<float>(random(-5, 5)),
                   radius = static_cast<float>(random(0.02, 0.5));
        for (std::uint32_t d = 0; d < directions; ++d)
            reach.push_back(x * ux[d] + y * uy[d] + radius);
    }
    std::vector<std::uint32_t> first{0}, footing;
    for (std::uint32_t g = 0; g < groups; ++g) {
        // Those of a group lie near each other in the list, as those of a room do.
        const int begin = random.integer(0, rows - 9);
        for (int n = random.integer(1, 8); n > 0; --n)
            footing.push_back(static_cast<std::uint32_t>(begin + n));
        first.push_back(static_cast<std::uint32_t>(footing.size()));
        cx.push_back(static_cast<float>(random(-5, 5)));
        cy.push_back(static_cast<float>(random(-5, 5)));
    }
    struct Buffers {
        device::Buffer<float> reach, ux, uy;
        device::Buffer<std::uint32_t> first, footing;
        device::Buffer<float> cx, cy, margin;
    };
    auto on = std::make_shared<Buffers>(Buffers{upload(device, reach, "reach"),
                                                upload(device, ux, "ux"),
                                                upload(device, uy, "uy"),
                                                upload(device, first, "first"),
                                                upload(device, footing, "footing"),
                                                upload(device, cx, "cx"),
                                                upload(device, cy, "cy"),
                                                {device, groups, "margin"}});
    const double maxima = static_cast<double>(footing.size()) * directions;
    return {{double{groups}, "groups",
             4.0 * (static_cast<double>(reach.size() + footing.size()) + 4.0 * groups),
             maxima + 5.0 * groups * directions},
            [on](device::Queue& queue) {
                queue.add<kernels::GroupStance>(groups,
                                                {.reach = on->reach,
                                                 .ux = on->ux,
                                                 .uy = on->uy,
                                                 .first = on->first,
                                                 .footing = on->footing,
                                                 .cx = on->cx,
                                                 .cy = on->cy,
                                                 .margin = on->margin},
                                                {.groups = groups, .directions = directions});
            },
            {},
            [on] { return Hash().add(on->margin.download()).value(); }};
}

}  // namespace topple::perf

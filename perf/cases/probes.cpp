// SPDX-License-Identifier: MIT
#include <memory>

#include "multiply_add.hpp"
#include "perf/cases/cases.h"
#include "triad.hpp"

namespace topple::perf {

// 3 x 64 MiB: larger than any cache of the machines this is meant for.
Prepared triad(device::Device& device) {
    constexpr std::uint32_t count = 1u << 24;
    std::vector<float> a(count), b(count);
    for (std::uint32_t n = 0; n < count; ++n) {
        a[n] = static_cast<float>(n & 1023u);
        b[n] = static_cast<float>(n >> 10);
    }
    struct Buffers {
        device::Buffer<float> a, b, dst;
    };
    auto on = std::make_shared<Buffers>(
        Buffers{upload(device, a, "a"), upload(device, b, "b"), {device, count, "dst"}});
    return {{count, "elements", 12.0 * count, 2.0 * count},
            [on](device::Queue& queue) {
                queue.add<kernels::Triad>(count, {.a = on->a, .b = on->b, .dst = on->dst},
                                          {.count = count, .scale = 0.5f});
            },
            {},
            [on] { return Hash().add(on->dst.download()).value(); }};
}

// Small in memory, long in arithmetic.
Prepared multiply_add(device::Device& device) {
    constexpr std::uint32_t count = 1u << 18, rounds = 1024;
    std::vector<float> x(count);
    for (std::uint32_t n = 0; n < count; ++n) x[n] = static_cast<float>(n) * 0.001f;
    auto on = std::make_shared<device::Buffer<float>>(upload(device, x, "x"));
    return {{count, "elements", 8.0 * count, 2.0 * count * rounds},
            [on](device::Queue& queue) {
                queue.add<kernels::MultiplyAdd>(count, {.x = *on},
                                                {.count = count, .rounds = rounds});
            },
            [on, x] { on->upload(std::span<const float>(x)); },
            [on] { return Hash().add(on->download()).value(); }};
}

}  // namespace topple::perf

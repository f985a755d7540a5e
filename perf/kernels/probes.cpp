// SPDX-License-Identifier: MIT
#include "perf/kernels/probes.h"

#include <memory>

#include "divide.hpp"
#include "gather.hpp"
#include "multiply_add.hpp"
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

Prepared divide(device::Device& device) {
    constexpr std::uint32_t count = 1u << 18, rounds = 256;
    std::vector<float> x(count);
    for (std::uint32_t n = 0; n < count; ++n) x[n] = 0.5f + static_cast<float>(n) * 1e-6f;
    auto on = std::make_shared<device::Buffer<float>>(upload(device, x, "x"));
    const double divisions = double{count} * rounds;
    return {{.items = count, .unit = "elements", .bytes = 8.0 * count, .divisions = divisions},
            [on](device::Queue& queue) {
                queue.add<kernels::Divide>(count, {.x = *on}, {.count = count, .rounds = rounds});
            },
            [on, x] { on->upload(std::span<const float>(x)); },
            [on] { return Hash().add(on->download()).value(); }};
}

// 16 KiB: in the nearest cache of the machines this is meant for.
Prepared gather(device::Device& device) {
    constexpr std::uint32_t count = 1u << 18, rounds = 128, words = 1u << 12, shift = 20;
    std::vector<std::uint32_t> table(words);
    for (std::uint32_t n = 0; n < words; ++n) table[n] = n;
    struct Buffers {
        device::Buffer<std::uint32_t> table, sum;
    };
    auto on =
        std::make_shared<Buffers>(Buffers{upload(device, table, "table"), {device, count, "sum"}});
    const double gathers = double{count} * rounds;
    return {{.items = count, .unit = "elements", .bytes = 4.0 * count, .gathers = gathers},
            [on](device::Queue& queue) {
                queue.add<kernels::Gather>(count, {.table = on->table, .sum = on->sum},
                                           {.count = count, .rounds = rounds, .shift = shift});
            },
            {},
            [on] { return Hash().add(on->sum.download()).value(); }};
}

}  // namespace topple::perf

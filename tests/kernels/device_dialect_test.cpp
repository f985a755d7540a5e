// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "device/queue.h"
#include "device_compare.h"
#include "device_harness.h"
#include "dialect_probe.hpp"

// What docs/dialect.md promises of arithmetic: the same bits on every backend, and IEEE 754's.
namespace topple::test {
namespace {

struct Numbers {
    std::vector<float> a, b;
    std::vector<std::uint32_t> m, n;
};

// All pairs of special numbers, then random bit patterns.
Numbers numbers() {
    const float inf = std::numeric_limits<float>::infinity();
    const float special[] = {0.0f, -0.0f, 1.0f,     -1.0f, 1e-40f, -1e-40f,   3.4e38f, -3.4e38f,
                             0.5f, -2.5f, 1.5e-38f, inf,   -inf,   8388609.f, 0.1f,    -0.3f};
    const std::uint32_t words[] = {0, 1, 31, 32, 0x7fffffff, 0x80000000, 0xffffffff, 12345};
    Numbers out;
    for (const float x : special) {
        for (const float y : special) {
            out.a.push_back(x);
            out.b.push_back(y);
        }
    }
    Random random(11);
    while (out.a.size() < 100'003) {
        const auto x = std::bit_cast<float>(random.word()), y = std::bit_cast<float>(random.word());
        if (std::isnan(x) || std::isnan(y)) continue;
        out.a.push_back(x);
        out.b.push_back(y);
    }
    for (std::size_t i = 0; i < out.a.size(); ++i) {
        out.m.push_back(i < 64 ? words[i / 8] : random.word());
        out.n.push_back(i < 64 ? words[i % 8] : random.word());
    }
    return out;
}

// The sum, difference, product or quotient of two floats is exact enough in double precision that
// rounding it once more to float gives the float operation's result (Figueroa 1995).
std::vector<float> expected_floats(const Numbers& in) {
    std::vector<float> out;
    for (std::size_t i = 0; i < in.a.size(); ++i) {
        const double x = in.a[i], y = in.b[i];
        const auto product = static_cast<float>(x * y), sum = static_cast<float>(x + y);
        out.insert(out.end(),
                   {sum, static_cast<float>(x - y), product, static_cast<float>(x / y),
                    static_cast<float>(double{product} + x), static_cast<float>(double{sum} - x),
                    static_cast<float>(std::sqrt(std::abs(x))), static_cast<float>(std::floor(x)),
                    y < x ? in.b[i] : in.a[i], x < y ? in.b[i] : in.a[i]});
    }
    return out;
}

std::vector<std::uint32_t> expected_words(const Numbers& in) {
    std::vector<std::uint32_t> out;
    for (std::size_t i = 0; i < in.m.size(); ++i) {
        const std::uint32_t u = in.m[i], v = in.n[i];
        const auto clamped = static_cast<std::int32_t>(-std::min<std::int64_t>(u & 0xffff, 1000));
        out.insert(out.end(),
                   {bits(in.a[i]), u + v, u * v, u / (v / 2 + 1), (u >> v % 32) ^ (u << v % 32),
                    static_cast<std::uint32_t>(clamped) + (v & 0xffff)});
    }
    return out;
}

bool denormal(float v) {
    return std::fpclassify(v) == FP_SUBNORMAL;
}

// Vulkan drivers of real GPUs may take denormals for zeros, where they don't promise to keep them.
// All else is IEEE 754's: only results of denormals, and denormal ones, are taken from `want`.
std::vector<float> but_for_denormals(std::vector<float> got, const std::vector<float>& want,
                                     const Numbers& in) {
    const std::size_t each = want.size() / in.a.size();
    for (std::size_t i = 0; i < got.size(); ++i) {
        const std::size_t n = i / each;
        const float sum = in.a[n] + in.b[n], product = in.a[n] * in.b[n];
        if (denormal(in.a[n]) || denormal(in.b[n]) || denormal(want[i]) || denormal(sum) ||
            denormal(product)) {
            got[i] = want[i];
        }
    }
    return got;
}

class DeviceDialect : public EachBackend {};
TOPPLE_ON_EACH_FORM(DeviceDialect);

TEST_P(DeviceDialect, RoundsAsIeee754OnEveryBackend) {
    const Numbers in = numbers();
    const auto count = static_cast<std::uint32_t>(in.a.size());
    const device::Buffer<float> a(*device, in.a, "a"), b(*device, in.b, "b");
    const device::Buffer<std::uint32_t> m(*device, in.m, "m"), n(*device, in.n, "n");
    const Guarded<float> f(*device, 10ull * count, "f");
    const Guarded<std::uint32_t> w(*device, 6ull * count, "w");
    device::Queue queue(*device);
    queue.add<kernels::DialectProbe>(
        count, {.a = a, .b = b, .m = m, .n = n, .f = f.slice(), .w = w.slice()}, {.count = count});
    queue.run();
    const std::vector<float> want = expected_floats(in);
    std::vector<float> got = f.download();
    if (device->info().gpu && device->info().backend == device::Backend::vulkan) {
        got = but_for_denormals(std::move(got), want, in);
    }
    EXPECT_TRUE(same(got, want));
    EXPECT_TRUE(same(w.download(), expected_words(in)));
    EXPECT_TRUE(f.untouched());
    EXPECT_TRUE(w.untouched());
}

}  // namespace
}  // namespace topple::test

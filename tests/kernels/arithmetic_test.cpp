// SPDX-License-Identifier: MIT
#include "device/devices.h"
#include "divide.hpp"
#include "errors.h"
#include "gather.hpp"
#include "multiply_add.hpp"
#include "normal_cluster.hpp"
#include "oracle/arithmetic_oracle.h"
#include "oracle/normal_cluster_oracle.h"
#include "oracle/segmented_sum_oracle.h"
#include "segmented_sum.hpp"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"
#include "triad.hpp"

// The kernels that measure a device: its arithmetic and its memory.
namespace topple::test {
namespace {

class Arithmetic : public EachBackend {
  protected:
    // `check` is given counts of elements, multiples of those that one work-item holds, and of
    // rounds.
    template <class Kernel, class Check>
    void at_all_sizes(std::uint32_t many_rounds, const Check& check) const {
        const std::uint32_t items = device->items_per_lane(Kernel::source());
        for (const std::uint32_t lanes : {0u, 1u, 63u, 64u, 65u, 101u}) {
            for (const std::uint32_t rounds : {0u, 1u, many_rounds}) {
                SCOPED_TRACE(testing::Message() << lanes << " work-items, " << rounds << " rounds");
                check(lanes * items, rounds);
            }
        }
    }
    template <class Kernel, class Oracle>
    void expect_in_place(std::uint32_t many_rounds, float low, float high,
                         const Oracle& oracle) const {
        at_all_sizes<Kernel>(many_rounds, [&](std::uint32_t count, std::uint32_t rounds) {
            const std::vector<float> x = Random(count).floats(count, low, high);
            Guarded<float> array(*device, count, "x");
            array.upload(x);
            run_kernel<Kernel>(*device, count, {.x = array.slice()},
                               {.count = count, .rounds = rounds});
            std::vector<double> want, bound;
            oracle(x, rounds, want, bound);
            EXPECT_TRUE(within(array.download(), want, bound));
            EXPECT_TRUE(array.untouched());
        });
    }
};
TOPPLE_ON_EACH_FORM(Arithmetic);

TEST_P(Arithmetic, MultiplyAddMatchesTheOracle) {
    expect_in_place<kernels::MultiplyAdd>(1000, -600, 600, oracle::multiply_add);
}

TEST_P(Arithmetic, DivideMatchesTheOracle) {
    expect_in_place<kernels::Divide>(333, 0.01f, 50, oracle::divide);
}

TEST_P(Arithmetic, GatherMatchesTheOracle) {
    const std::uint32_t shift = 25;
    std::vector<std::uint32_t> table(1u << (32 - shift));
    Random random(3);
    for (std::uint32_t& word : table) word = random.word();
    const device::Buffer<std::uint32_t> words(*device, table, "table");
    at_all_sizes<kernels::Gather>(77, [&](std::uint32_t count, std::uint32_t rounds) {
        const Guarded<std::uint32_t> sum(*device, count, "sum");
        run_kernel<kernels::Gather>(*device, count, {.table = words, .sum = sum.slice()},
                                    {.count = count, .rounds = rounds, .shift = shift});
        EXPECT_EQ(sum.download(), oracle::gather(table, count, rounds));
        EXPECT_TRUE(sum.untouched());
    });
}

TEST_P(Arithmetic, TriadMatchesTheOracle) {
    for (const std::size_t count : {0, 1, 63, 64, 65, 997, 100'003}) {
        SCOPED_TRACE(count);
        Random random(count);
        const std::vector<float> a = random.floats(count, -3, 3), b = random.floats(count, -3, 3);
        const device::Buffer<float> in_a(*device, a, "a"), in_b(*device, b, "b");
        const Guarded<float> out(*device, count, "dst");
        run_kernel<kernels::Triad>(*device, count, {.a = in_a, .b = in_b, .dst = out.slice()},
                                   {.count = static_cast<std::uint32_t>(count), .scale = 1.7f});
        std::vector<double> want, bound;
        oracle::triad(a, b, 1.7f, want, bound);
        EXPECT_TRUE(within(out.download(), want, bound));
        EXPECT_TRUE(out.untouched());
    }
}

class SegmentedSum : public EachBackend {
  protected:
    void check(const std::vector<std::uint32_t>& lengths, std::int32_t origin,
               std::uint32_t extent) {
        std::vector<std::uint32_t> first{0};
        for (const std::uint32_t n : lengths) first.push_back(first.back() + n);
        const std::uint32_t cells = first.back();
        Random random(cells + 1);
        std::vector<std::int32_t> axis[3];
        for (auto& a : axis) {
            for (std::uint32_t n = 0; n < cells; ++n)
                a.push_back(origin + static_cast<std::int32_t>(random.word() % extent));
        }
        std::vector<std::uint32_t> order(cells);
        std::iota(order.begin(), order.end(), 0U);
        for (std::uint32_t n = cells; n > 1; --n) std::swap(order[n - 1], order[random.word() % n]);
        const device::Buffer<std::int32_t> ci(*device, axis[0], "ci"), cj(*device, axis[1], "cj"),
            ck(*device, axis[2], "ck");
        const device::Buffer<std::uint32_t> order_buffer(*device, order, "order"),
            starts(*device, first, "first");
        const Guarded<std::uint32_t> sum(*device, lengths.size() * 3, "sum");
        run_kernel<kernels::SegmentedSum>(
            *device, lengths.size(),
            {.ci = ci,
             .cj = cj,
             .ck = ck,
             .order = order_buffer,
             .first = starts,
             .sum = sum.slice()},
            {.origin_i = origin, .origin_j = origin, .origin_k = origin});
        std::vector<std::uint32_t> want;
        for (std::size_t s = 0; s < lengths.size(); ++s) {
            for (const auto& a : axis)
                want.push_back(oracle::segment_sum(a, order, first[s], first[s + 1], origin));
        }
        EXPECT_TRUE(same(sum.download(), want));
        EXPECT_TRUE(sum.untouched());
    }
};
TOPPLE_ON_EACH_FORM(SegmentedSum);

TEST_P(SegmentedSum, MatchesTheOracle) {
    for (const std::vector<std::uint32_t>& lengths : std::vector<std::vector<std::uint32_t>>{
             {}, {0}, {1}, {63}, {64}, {65}, {997}, {0, 1, 63, 64, 65, 2047, 2048, 0, 7}}) {
        SCOPED_TRACE(lengths.size());
        check(lengths, -1000, 5000);
    }
    check(std::vector<std::uint32_t>(1009, 37), 12, 600);
}

TEST_P(SegmentedSum, LongestSegmentOfTheWidestSceneFits) {
    check({2048, 2048}, -(1 << 20), 1u << 21);
}

class NormalCluster : public EachBackend {};
TOPPLE_ON_EACH_FORM(NormalCluster);

std::array<double, 3> direction(Random& random) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    const double length = std::sqrt(x * x + y * y + z * z) + 1e-9;
    return {x / length, y / length, z / length};
}

TEST_P(NormalCluster, MatchesTheOracle) {
    constexpr std::size_t per_group = 1024;
    const auto native = device::open_native();
    for (const std::size_t count : {0, 1, 63, 64, 65, 1023, 1024, 1025, 5003}) {
        for (const std::size_t k : {1, 3, 12, 32}) {
            SCOPED_TRACE(testing::Message() << count << " normals, " << k << " axes");
            Random random(count + k);
            std::vector<std::array<double, 3>> axes;
            std::vector<float> flat, nx, ny, nz;
            for (std::size_t i = 0; i < k; ++i) {
                axes.push_back(direction(random));
                for (double& v : axes.back()) flat.push_back(static_cast<float>(v));
            }
            for (std::size_t i = 0; i < count; ++i) {
                const auto n = i % 17 == 5 ? std::array<double, 3>{0, 0, 0} : direction(random);
                nx.push_back(static_cast<float>(n[0]));
                ny.push_back(static_cast<float>(n[1]));
                nz.push_back(static_cast<float>(n[2]));
            }
            const std::vector<float> weight = random.floats(count, 0, 1);
            const std::size_t groups = (count + per_group - 1) / per_group;

            const auto run = [&](device::Device& on, std::vector<std::uint32_t>& cluster) {
                const device::Buffer<float> x(on, nx, "nx"), y(on, ny, "ny"), z(on, nz, "nz"),
                    w(on, weight, "weight"), a(on, flat, "axes");
                const Guarded<std::int32_t> partial(on, groups * 4 * k, "partial");
                const Guarded<std::uint32_t> choice(on, count, "cluster");
                run_kernel<kernels::NormalCluster>(
                    on, groups,
                    {.nx = x,
                     .ny = y,
                     .nz = z,
                     .weight = w,
                     .axes = a,
                     .partial = partial.slice(),
                     .cluster = choice.slice()},
                    {.count = static_cast<std::uint32_t>(count),
                     .cluster_count = static_cast<std::uint32_t>(k)});
                EXPECT_TRUE(partial.untouched());
                EXPECT_TRUE(choice.untouched());
                cluster = choice.download();
                return partial.download();
            };
            std::vector<std::uint32_t> cluster, native_cluster;
            const std::vector<std::int32_t> partial = run(*device, cluster);
            EXPECT_TRUE(same(partial, run(*native, native_cluster)));
            EXPECT_TRUE(same(cluster, native_cluster));

            std::vector<double> sums(groups * 4 * k);
            for (std::size_t i = 0; i < count; ++i) {
                const auto want = oracle::nearest_axis({nx[i], ny[i], nz[i]}, axes);
                if (want.lead > 1e-6 || want.cluster == k) {
                    ASSERT_EQ(cluster[i], want.cluster) << "normal " << i;
                }
                // Sums follow the kernel's own choice: the oracle checked it where it is clear.
                if (cluster[i] == k) continue;
                const auto& axis = axes[cluster[i]];
                const double sign =
                    nx[i] * axis[0] + ny[i] * axis[1] + nz[i] * axis[2] < 0 ? -1 : 1;
                double* sum = &sums[(i / per_group * k + cluster[i]) * 4];
                sum[0] += sign * weight[i] * nx[i];
                sum[1] += sign * weight[i] * ny[i];
                sum[2] += sign * weight[i] * nz[i];
                sum[3] += weight[i];
            }
            for (std::size_t i = 0; i < sums.size(); ++i) {
                // Half a unit of rounding for each of up to 1024 normals.
                ASSERT_NEAR(partial[i] / 1048576.0, sums[i], 1024 * 0.51 / 1048576) << "sum " << i;
            }
        }
    }
}

}  // namespace
}  // namespace topple::test

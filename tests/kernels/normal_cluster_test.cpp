// SPDX-License-Identifier: MIT
#include "normal_cluster.hpp"

#include "device/queue.h"
#include "device_compare.h"
#include "device_harness.h"
#include "oracle/normal_cluster_oracle.h"

namespace topple::test {
namespace {

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
                device::Queue queue(on);
                queue.add<kernels::NormalCluster>(groups,
                                                  {.nx = x,
                                                   .ny = y,
                                                   .nz = z,
                                                   .weight = w,
                                                   .axes = a,
                                                   .partial = partial.slice(),
                                                   .cluster = choice.slice()},
                                                  {.count = static_cast<std::uint32_t>(count),
                                                   .cluster_count = static_cast<std::uint32_t>(k)});
                queue.run();
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

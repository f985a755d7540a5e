// SPDX-License-Identifier: MIT
#include "geometry/manhattan_normals.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include "core/ranked.h"
#include "geometry/manhattan.h"
#include "normal_cluster.hpp"
#include "topple/kernels/queue.h"

namespace topple::geometry {

WeightedNormals weigh_normals(const Surfels& s, std::size_t most) {
    WeightedNormals normals;
    const std::size_t step = s.size() / std::max<std::size_t>(most, 1) + 1;
    for (std::size_t i = 0; i < s.size(); i += step) {
        if (s.nx[i] == 0 && s.ny[i] == 0 && s.nz[i] == 0) continue;
        normals.x.push_back(s.nx[i]);
        normals.y.push_back(s.ny[i]);
        normals.z.push_back(s.nz[i]);
        normals.surfel.push_back(static_cast<std::uint32_t>(i));
    }
    if (normals.size() == 0) return normals;
    std::vector<float> roughness;
    for (const std::uint32_t i : normals.surfel) roughness.push_back(s.roughness_m[i]);
    // A hundredth of a cell: below it, roughness is rounding.
    const float usual = std::max(upper_median(roughness), static_cast<float>(0.01 * s.cell_m));
    for (const std::uint32_t i : normals.surfel) {
        const float ratio = s.roughness_m[i] / usual;
        normals.weight.push_back(2.0f / (2.0f + ratio * ratio));
        normals.total += normals.weight.back();
    }
    return normals;
}

double weight_near(const WeightedNormals& normals, const Vec3& axis, double degrees) {
    const double least = std::cos(degrees * std::numbers::pi / 180);
    double sum = 0;
    for (std::size_t i = 0; i < normals.size(); ++i) {
        if (std::abs(dot(normals[i], axis)) >= least) sum += normals.weight[i];
    }
    return sum;
}

Vec3 refine_axis(const WeightedNormals& normals, const Vec3& axis) {
    Vec3 now = axis;
    for (const double window : {10.0, 7.0, 5.0, 4.0}) {
        const double widest = std::pow(std::sin(window * std::numbers::pi / 180), 2);
        for (int round = 0; round < 5; ++round) {
            Vec3 sum{};
            for (std::size_t i = 0; i < normals.size(); ++i) {
                const double d = dot(normals[i], now);
                const double off = 1 - d * d;  // sin^2 of the angle
                if (off >= widest) continue;
                const double taper = 1 - off / widest;
                const double w = normals.weight[i] * taper * taper * (d < 0 ? -1 : 1);
                sum = along(sum, w, normals[i]);
            }
            const Vec3 next = unit_or_zero(sum);
            if (next == Vec3{0, 0, 0}) return now;
            const bool still = dot(next, now) > 1 - 1e-12;
            now = next;
            if (still) break;
        }
    }
    return now;
}

namespace {

// Folded directions near the cells of a grid on the half cube: enough to see where normals pile up.
constexpr int bins_per_side = 24;

struct Histogram {
    std::vector<Vec3> sum;  // of weight * normal, folded to the bin's side
    std::vector<double> weight;
};

// The bin of a direction: the face of its largest component, then a grid over that face.
std::size_t bin_of(const Vec3& n, bool& negative) {
    std::size_t face = 0;
    for (std::size_t a = 1; a < 3; ++a) {
        if (std::abs(n[a]) > std::abs(n[face])) face = a;
    }
    negative = n[face] < 0;
    const auto cell = [&](std::size_t a) {
        const double t = (n[a] / n[face] + 1) / 2 * bins_per_side;
        return static_cast<std::size_t>(std::clamp(t, 0.0, bins_per_side - 1.0));
    };
    return (face * bins_per_side + cell((face + 1) % 3)) * bins_per_side + cell((face + 2) % 3);
}

// Seeds for k-means: the strongest directions at least 20 degrees apart, as greedy as k-means++ but
// without chance.
std::vector<Vec3> seeds(const WeightedNormals& normals, unsigned k) {
    Histogram bins;
    bins.sum.resize(3 * bins_per_side * bins_per_side);
    bins.weight.resize(bins.sum.size());
    for (std::size_t i = 0; i < normals.size(); ++i) {
        bool negative = false;
        const Vec3 n = normals[i];
        const std::size_t at = bin_of(n, negative);
        const double w = normals.weight[i] * (negative ? -1 : 1);
        bins.sum[at] = along(bins.sum[at], w, n);
        bins.weight[at] += normals.weight[i];
    }
    std::vector<std::size_t> used;
    for (std::size_t b = 0; b < bins.weight.size(); ++b) {
        if (bins.weight[b] > 0) used.push_back(b);
    }
    // Smoothed over 6 degrees, so that a peak across a bin's border counts in full.
    std::vector<double> smooth(used.size());
    std::vector<Vec3> at(used.size());
    for (std::size_t i = 0; i < used.size(); ++i) at[i] = unit_or_zero(bins.sum[used[i]]);
    const double near = std::cos(6 * std::numbers::pi / 180);
    for (std::size_t i = 0; i < used.size(); ++i) {
        for (std::size_t j = 0; j < used.size(); ++j) {
            if (std::abs(dot(at[i], at[j])) >= near) smooth[i] += bins.weight[used[j]];
        }
    }
    std::vector<Vec3> chosen;
    const double apart = std::cos(20 * std::numbers::pi / 180);
    while (chosen.size() < k) {
        std::size_t best = used.size();
        for (std::size_t i = 0; i < used.size(); ++i) {
            const bool free = std::none_of(chosen.begin(), chosen.end(), [&](const Vec3& c) {
                return std::abs(dot(c, at[i])) > apart;
            });
            if (free && smooth[i] > 0 && (best == used.size() || smooth[i] > smooth[best]))
                best = i;
        }
        if (best == used.size()) break;
        chosen.push_back(at[best]);
    }
    return chosen;
}

constexpr std::uint32_t normals_per_group = 1024;  // 64 lanes of 16 items, on every backend

// Sums of each cluster after one assignment: weight * n, and weight.
std::vector<std::array<double, 4>> assign(device::Device& device, const device::Buffer<float>& nx,
                                          const device::Buffer<float>& ny,
                                          const device::Buffer<float>& nz,
                                          const device::Buffer<float>& weight,
                                          const std::vector<Vec3>& axes) {
    std::vector<float> flat;
    for (const Vec3& axis : axes) {
        for (const double v : axis) flat.push_back(static_cast<float>(v));
    }
    const auto count = static_cast<std::uint32_t>(nx.size());
    const std::size_t groups = (count + normals_per_group - 1) / normals_per_group;
    const std::size_t record = 4 * axes.size();
    const device::Buffer<float> d_axes(device, std::span<const float>(flat), "axes");
    const device::Buffer<std::int32_t> d_partial(device, groups * record, "partial");
    const device::Buffer<std::uint32_t> d_cluster(device, count, "cluster");
    device::Queue queue(device);
    queue.add<kernels::NormalCluster>(
        groups,
        {.nx = nx,
         .ny = ny,
         .nz = nz,
         .weight = weight,
         .axes = d_axes,
         .partial = d_partial,
         .cluster = d_cluster},
        {.count = count, .cluster_count = static_cast<std::uint32_t>(axes.size())});
    queue.run();
    const std::vector<std::int32_t> partial = d_partial.download();
    std::vector<std::array<std::int64_t, 4>> sums(axes.size());
    for (std::size_t i = 0; i < partial.size(); ++i) sums[i % record / 4][i % 4] += partial[i];
    std::vector<std::array<double, 4>> result(axes.size());
    for (std::size_t k = 0; k < axes.size(); ++k) {
        for (std::size_t a = 0; a < 4; ++a)
            result[k][a] = static_cast<double>(sums[k][a]) / (1 << 20);
    }
    return result;
}

}  // namespace

NormalClusters cluster_normals(device::Device& device, const Surfels& surfels, unsigned k) {
    NormalClusters result;
    // As many as fit one binding.
    const WeightedNormals normals =
        weigh_normals(surfels, device.info().limits.max_binding_bytes / sizeof(float));
    k = std::min(k, 32u);
    if (normals.size() == 0 || k == 0) return result;
    std::vector<Vec3> axes = seeds(normals, k);
    const auto buffer = [&](const std::vector<float>& data, const char* name) {
        return device::Buffer<float>(device, std::span<const float>(data), name);
    };
    const auto nx = buffer(normals.x, "nx"), ny = buffer(normals.y, "ny"),
               nz = buffer(normals.z, "nz"), weight = buffer(normals.weight, "weight");
    std::vector<std::array<double, 4>> sums;
    constexpr int most_rounds = 30;
    for (int round = 0; round < most_rounds; ++round) {
        sums = assign(device, nx, ny, nz, weight, axes);
        bool still = true;
        for (std::size_t i = 0; i < axes.size(); ++i) {
            const Vec3 next = unit_or_zero({sums[i][0], sums[i][1], sums[i][2]});
            if (next == Vec3{0, 0, 0}) continue;  // an empty cluster stays where it is
            still &= dot(next, axes[i]) > 1 - 1e-10;
            axes[i] = next;
        }
        if (still) break;
    }
    std::vector<std::size_t> order(axes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater{}, [&](std::size_t i) { return sums[i][3]; });
    for (const std::size_t i : order) {
        result.direction.push_back(axes[i]);
        result.weight.push_back(sums[i][3]);
    }
    return result;
}

}  // namespace topple::geometry

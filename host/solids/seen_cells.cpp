// SPDX-License-Identifier: MIT
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "solids/grid_points.h"
#include "solids/patches.h"

namespace topple::solids {
namespace {

struct SeenPoint {
    std::int32_t i, j, k, primitive;
    float x, y, z;
    auto key() const { return std::tie(i, j, k, primitive); }
    auto order() const { return std::tie(i, j, k, primitive, x, y, z); }
};

// The mean of points of one patch in one cell, and where it belongs.
struct SeenMean {
    std::int32_t i, j, k, primitive, patch;
    float count, x, y, z;
    auto key() const { return std::tie(i, j, k, primitive, patch); }
};

void add_means(std::span<const SeenPoint> sorted, std::int32_t patch, std::vector<SeenMean>& out) {
    for (std::size_t n = 0; n < sorted.size();) {
        const SeenPoint& first = sorted[n];
        std::size_t end = n;
        double sum[3] = {0, 0, 0};
        for (; end < sorted.size() && sorted[end].key() == first.key(); ++end) {
            sum[0] += sorted[end].x;
            sum[1] += sorted[end].y;
            sum[2] += sorted[end].z;
        }
        const auto count = static_cast<double>(end - n);
        out.push_back({first.i, first.j, first.k, first.primitive, patch, static_cast<float>(count),
                       static_cast<float>(sum[0] / count), static_cast<float>(sum[1] / count),
                       static_cast<float>(sum[2] / count)});
        n = end;
    }
}

}  // namespace

SeenCells seen_cells(const CloudView& cloud, std::span<const std::int32_t> primitive_of_point,
                     std::span<const std::int32_t> patch_of_point, const std::array<Vec3, 3>& axes,
                     double voxel_m, ThreadPool& threads) {
    std::int32_t patches = 0;
    for (const std::int32_t p : patch_of_point) patches = std::max(patches, p + 1);
    const PointsByLabel members(patch_of_point, static_cast<std::size_t>(patches));
    // Patch by patch: there are many fewer means to sort than points.
    std::vector<std::vector<SeenMean>> of_patch(static_cast<std::size_t>(patches));
    threads.run(of_patch.size(), 4, [&](std::uint64_t from, std::uint64_t to) {
        std::vector<SeenPoint> places;
        for (std::uint64_t patch = from; patch < to; ++patch) {
            places.clear();
            for (const std::uint32_t n : members.of(patch)) {
                if (primitive_of_point[n] < 0) continue;
                const Eigen::Vector3d p = rotated(axes, cloud.x[n], cloud.y[n], cloud.z[n]);
                const auto cell = [&](double v) {
                    return static_cast<std::int32_t>(
                        std::clamp(std::floor(v / voxel_m), -2e9, 2e9));
                };
                places.push_back({cell(p.x()), cell(p.y()), cell(p.z()), primitive_of_point[n],
                                  static_cast<float>(p.x()), static_cast<float>(p.y()),
                                  static_cast<float>(p.z())});
            }
            std::ranges::sort(places, {}, &SeenPoint::order);
            add_means(places, static_cast<std::int32_t>(patch), of_patch[patch]);
        }
    });
    std::vector<SeenMean> means;
    for (const auto& some : of_patch) means.insert(means.end(), some.begin(), some.end());
    std::ranges::sort(means, {}, &SeenMean::key);
    SeenCells out;
    for (auto* values : {&out.i, &out.j, &out.k, &out.primitive, &out.patch})
        values->reserve(means.size());
    for (auto* values : {&out.count, &out.x, &out.y, &out.z}) values->reserve(means.size());
    for (const SeenMean& m : means) {
        out.i.push_back(m.i);
        out.j.push_back(m.j);
        out.k.push_back(m.k);
        out.primitive.push_back(m.primitive);
        out.patch.push_back(m.patch);
        out.count.push_back(m.count);
        out.x.push_back(m.x);
        out.y.push_back(m.y);
        out.z.push_back(m.z);
    }
    return out;
}

std::vector<bool> one_sided(const SeenCells& seen, std::span<const SurfacePatch> patches,
                            std::size_t primitives) {
    constexpr double least = 0.95;  // length of the mean normal
    std::vector<Eigen::Vector3d> sum(primitives, Eigen::Vector3d::Zero());
    std::vector<double> count(primitives, 0.0);
    for (std::size_t n = 0; n < seen.size(); ++n) {
        const auto p = static_cast<std::size_t>(seen.primitive[n]);
        const Vec3 g = patches[static_cast<std::size_t>(seen.patch[n])].gradient(
            {seen.x[n], seen.y[n], seen.z[n]});
        sum[p] += seen.count[n] * Eigen::Vector3d(g[0], g[1], g[2]).normalized();
        count[p] += seen.count[n];
    }
    std::vector<bool> out;
    for (std::size_t p = 0; p < primitives; ++p) out.push_back(sum[p].norm() >= least * count[p]);
    return out;
}

}  // namespace topple::solids

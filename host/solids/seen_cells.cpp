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
    std::int32_t i, j, k, primitive, patch;
    float x, y, z;
    auto key() const { return std::tie(i, j, k, primitive, patch); }
    auto order() const { return std::tie(i, j, k, primitive, patch, x, y, z); }
};

}  // namespace

SeenCells seen_cells(const CloudView& cloud, std::span<const std::int32_t> primitive_of_point,
                     std::span<const std::int32_t> patch_of_point, const std::array<Vec3, 3>& axes,
                     double voxel_m) {
    std::vector<SeenPoint> places;
    for (std::size_t n = 0; n < cloud.size(); ++n) {
        if (primitive_of_point[n] < 0 || patch_of_point[n] < 0) continue;
        const Eigen::Vector3d p = rotated(axes, cloud.x[n], cloud.y[n], cloud.z[n]);
        const auto cell = [&](double v) {
            return static_cast<std::int32_t>(std::clamp(std::floor(v / voxel_m), -2e9, 2e9));
        };
        places.push_back({cell(p.x()), cell(p.y()), cell(p.z()), primitive_of_point[n],
                          patch_of_point[n], static_cast<float>(p.x()), static_cast<float>(p.y()),
                          static_cast<float>(p.z())});
    }
    std::ranges::sort(places, {}, &SeenPoint::order);
    SeenCells out;
    for (std::size_t n = 0; n < places.size();) {
        std::size_t end = n;
        double sum[3] = {0, 0, 0};
        for (; end < places.size() && places[end].key() == places[n].key(); ++end) {
            sum[0] += places[end].x;
            sum[1] += places[end].y;
            sum[2] += places[end].z;
        }
        const auto count = static_cast<double>(end - n);
        out.i.push_back(places[n].i);
        out.j.push_back(places[n].j);
        out.k.push_back(places[n].k);
        out.primitive.push_back(places[n].primitive);
        out.patch.push_back(places[n].patch);
        out.count.push_back(static_cast<float>(count));
        out.x.push_back(static_cast<float>(sum[0] / count));
        out.y.push_back(static_cast<float>(sum[1] / count));
        out.z.push_back(static_cast<float>(sum[2] / count));
        n = end;
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

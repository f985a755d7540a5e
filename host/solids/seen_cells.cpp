// SPDX-License-Identifier: MIT
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <tuple>

#include "core/rows.h"
#include "solids/patches.h"

namespace topple::solids {
namespace {

// Two numbers in one that has their order, for sorting: the second one counts where the first are
// the same.
std::uint64_t in_order(std::int32_t first, std::int32_t second) {
    const auto ordered = [](std::int32_t v) { return static_cast<std::uint32_t>(v) ^ (1u << 31); };
    return std::uint64_t{ordered(first)} << 32 | ordered(second);
}
std::int32_t first_of(std::uint64_t both) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(both >> 32) ^ (1u << 31));
}
std::int32_t second_of(std::uint64_t both) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(both) ^ (1u << 31));
}

struct SeenPoint {
    std::uint64_t ij, k_primitive;
    float x, y, z;
    bool same_cell(const SeenPoint& o) const { return ij == o.ij && k_primitive == o.k_primitive; }
    bool operator<(const SeenPoint& o) const {
        if (ij != o.ij) return ij < o.ij;
        if (k_primitive != o.k_primitive) return k_primitive < o.k_primitive;
        return std::tie(x, y, z) < std::tie(o.x, o.y, o.z);
    }
};

// The mean of points of one patch in one cell, and where it belongs.
struct SeenMean {
    std::uint64_t ij, k_primitive;
    std::int32_t patch;
    float count, x, y, z;
    auto order() const { return std::tuple(ij, k_primitive, patch); }
};

void add_means(std::span<const SeenPoint> sorted, std::int32_t patch, std::vector<SeenMean>& out) {
    for (std::size_t n = 0; n < sorted.size();) {
        const SeenPoint& first = sorted[n];
        std::size_t end = n;
        double sum[3] = {0, 0, 0};
        for (; end < sorted.size() && sorted[end].same_cell(first); ++end) {
            sum[0] += sorted[end].x;
            sum[1] += sorted[end].y;
            sum[2] += sorted[end].z;
        }
        const auto count = static_cast<double>(end - n);
        out.push_back({first.ij, first.k_primitive, patch, static_cast<float>(count),
                       static_cast<float>(sum[0] / count), static_cast<float>(sum[1] / count),
                       static_cast<float>(sum[2] / count)});
        n = end;
    }
}

}  // namespace

SeenCells seen_cells(const GridPoints& points, const PointLabels& labels, double voxel_m,
                     ThreadPool& threads) {
    std::int32_t patches = 0;
    for (const std::int32_t p : labels.patch) patches = std::max(patches, p + 1);
    const auto members = places_by_label(labels.patch, static_cast<std::size_t>(patches));
    // Patch by patch: there are many fewer means to sort than points.
    std::vector<std::vector<SeenMean>> of_patch(static_cast<std::size_t>(patches));
    threads.run(of_patch.size(), 4, [&](std::uint64_t from, std::uint64_t to) {
        std::vector<SeenPoint> places;
        for (std::uint64_t patch = from; patch < to; ++patch) {
            places.clear();
            for (const std::uint32_t n : members[patch]) {
                if (labels.primitive[n] < 0) continue;
                const Eigen::Vector3d p = points[n];
                const auto cell = [&](double v) {
                    return static_cast<std::int32_t>(
                        std::clamp(std::floor(v / voxel_m), -2e9, 2e9));
                };
                places.push_back({in_order(cell(p.x()), cell(p.y())),
                                  in_order(cell(p.z()), labels.primitive[n]),
                                  static_cast<float>(p.x()), static_cast<float>(p.y()),
                                  static_cast<float>(p.z())});
            }
            std::ranges::sort(places, std::less<>());
            add_means(places, static_cast<std::int32_t>(patch), of_patch[patch]);
        }
    });
    std::vector<SeenMean> means = joined(of_patch);
    std::ranges::sort(means, {}, &SeenMean::order);
    SeenCells out;
    for (auto* values : {&out.i, &out.j, &out.k, &out.primitive, &out.patch})
        values->reserve(means.size());
    for (auto* values : {&out.count, &out.x, &out.y, &out.z}) values->reserve(means.size());
    for (const SeenMean& m : means) {
        out.i.push_back(first_of(m.ij));
        out.j.push_back(second_of(m.ij));
        out.k.push_back(first_of(m.k_primitive));
        out.primitive.push_back(second_of(m.k_primitive));
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
    std::vector<Eigen::Vector3d> sum(primitives, Eigen::Vector3d::Zero());
    std::vector<double> count(primitives, 0.0);
    for (std::size_t n = 0; n < seen.size(); ++n) {
        const auto p = static_cast<std::size_t>(seen.primitive[n]);
        const Vec3 g = patches[seen.patch[n]].gradient({seen.x[n], seen.y[n], seen.z[n]});
        sum[p] += seen.count[n] * Eigen::Vector3d(g[0], g[1], g[2]).normalized();
        count[p] += seen.count[n];
    }
    std::vector<bool> out;
    for (std::size_t p = 0; p < primitives; ++p) out.push_back(sum[p].norm() >= one_way * count[p]);
    return out;
}

}  // namespace topple::solids

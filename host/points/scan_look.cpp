// SPDX-License-Identifier: MIT
#include "points/scan_look.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "core/scene_bounds.h"
#include "geometry/segmentation.h"
#include "points/observation.h"

namespace topple {
namespace {

constexpr double most_surfels = 20'000;
// Cells of the thinned cloud along a surfel: normals need a few points in each.
constexpr double thinned_cells = 3;
// Points that bounds are taken from, evenly over the cloud.
constexpr std::size_t bounds_points = 200'000;

// The first point of each cell.
PointCloud thinned(const PointCloud& cloud, double cell_m) {
    PointCloud out;
    std::unordered_set<std::uint64_t> taken;
    const auto cell = [&](float v) {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(v / cell_m))) &
               0x1fffff;
    };
    for (std::size_t n = 0; n < cloud.size(); ++n) {
        const std::uint64_t key =
            cell(cloud.x[n]) << 42 | cell(cloud.y[n]) << 21 | cell(cloud.z[n]);
        if (!taken.insert(key).second) continue;
        out.x.push_back(cloud.x[n]);
        out.y.push_back(cloud.y[n]);
        out.z.push_back(cloud.z[n]);
    }
    return out;
}

}  // namespace

GridBox grid_box(const CloudView& cloud, const std::array<Vec3, 3>& axes) {
    const std::size_t step = 1 + cloud.size() / bounds_points;
    std::array<std::vector<float>, 3> at;
    for (std::size_t n = 0; n < cloud.size(); n += step) {
        for (std::size_t a = 0; a < 3; ++a) {
            const Vec3& axis = axes[a];
            at[a].push_back(static_cast<float>(axis[0] * cloud.x[n] + axis[1] * cloud.y[n] +
                                               axis[2] * cloud.z[n]));
        }
    }
    const auto least = static_cast<float>(largest_cell_m);
    const Bounds<float> bounds = scene_bounds<float>({at[0], at[1], at[2]}, least);
    std::array<double, 3> edge{};
    for (std::size_t a = 0; a < 3; ++a) edge[a] = std::max(bounds.high[a] - bounds.low[a], least);
    return {edge[0] * edge[1], edge[2]};
}

double seen_m3(const DepthFrame& frame, const Intrinsics& k) {
    double sum = 0;
    for (const std::uint16_t stored : frame.depth) {
        const double z = stored / k.depth_scale;
        sum += z * z * z;
    }
    return sum / (3 * k.fx * k.fy);
}

ScanLook look_at_scan(device::Device& device, const PointCloud& cloud, double cell_m,
                      double surface_m2, const geometry::FrameHints& hints) {
    const double surfel_m = std::max(surfel_cells * cell_m, std::sqrt(surface_m2 / most_surfels));
    const geometry::Surfels surfels =
        geometry::make_surfels(device, thinned(cloud, surfel_m / thinned_cells), surfel_m, {}, {});
    ScanLook out;
    out.box = grid_box(cloud, geometry::find_scene_frame(device, surfels, hints).axes);
    for (const geometry::Region& r : geometry::split(surfels, device.threads()).regions)
        out.patches_m += surfel_m * std::sqrt(static_cast<double>(r.surfels));
    return out;
}

}  // namespace topple

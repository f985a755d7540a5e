// SPDX-License-Identifier: MIT
#include "points/voxel_size.h"

#include <algorithm>
#include <array>

#include "points/parse_memory.h"
#include "points/surface_extent.h"

namespace topple {
namespace {

constexpr std::array<double, 8> handy{0.005, 0.0075, 0.01, 0.015, 0.02, 0.03, 0.04, 0.05};
constexpr double most_surface_voxels = 4e6;

}  // namespace

double voxel_for_cell(double cell_m) {
    for (const double h : handy) {
        if (h >= closing_cells * cell_m) return h;
    }
    return 2 * cell_m;
}

double voxel_for_scan(double cell_m, double surface_m2, const Bounds<float>& bounds, double points,
                      std::uint64_t max_memory_bytes) {
    const double coarsest = voxel_for_cell(cell_m);
    if (coarsest <= room_voxel_m) return coarsest;
    const auto fits = [&](double h) {
        return surface_m2 <= most_surface_voxels * h * h &&
               (max_memory_bytes == 0 ||
                one_piece_bytes(points, surface_m2, bounds, h) <= max_memory_bytes);
    };
    for (const double h : handy)
        if (h >= room_voxel_m && h < coarsest && fits(h)) return h;
    return coarsest;
}

double voxel_for_input(const Observation& input, const ParseOptions& options) {
    if (options.voxel_m > 0) return options.voxel_m;
    if (input.voxel_m > 0) return input.voxel_m;
    if (voxel_for_cell(input.cell_m) <= room_voxel_m) return voxel_for_cell(input.cell_m);
    return voxel_for_scan(input.cell_m, extent_of(input.cloud).area_m2(), bounds_of(input.cloud),
                          static_cast<double>(input.cloud.size()), options.max_memory_bytes);
}

}  // namespace topple

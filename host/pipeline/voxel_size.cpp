// SPDX-License-Identifier: MIT
#include "pipeline/voxel_size.h"

#include <algorithm>
#include <array>

#include "pipeline/parse_memory.h"

namespace topple {
namespace {

constexpr std::array<double, 8> handy{0.005, 0.0075, 0.01, 0.015, 0.02, 0.03, 0.04, 0.05};
constexpr double room_voxel_m = 0.02;
constexpr double most_surface_voxels = 4e6;

}  // namespace

double voxel_for_cell(double cell_m) {
    for (const double h : handy) {
        if (h >= closing_cells * cell_m) return h;
    }
    return 2 * cell_m;
}

double voxel_for_scan(double cell_m, const SurfaceExtent& surface, double points,
                      std::uint64_t max_memory_bytes) {
    const double coarsest = voxel_for_cell(cell_m);
    if (coarsest <= room_voxel_m) return coarsest;
    const double area = surface.area_m2();
    const Bounds<float> bounds = surface.bounds();
    const auto fits = [&](double h) {
        return area <= most_surface_voxels * h * h &&
               (max_memory_bytes == 0 ||
                one_piece_bytes(points, area, bounds, h) <= max_memory_bytes);
    };
    for (const double h : handy)
        if (h >= room_voxel_m && h < coarsest && fits(h)) return h;
    return coarsest;
}

double voxel_for_input(const Ingested& input, const ParseOptions& options) {
    if (options.voxel_m > 0) return options.voxel_m;
    if (input.voxel_m > 0) return input.voxel_m;
    const bool asked = voxel_for_cell(input.cell_m) > room_voxel_m;
    return voxel_for_scan(input.cell_m, asked ? extent_of(input.cloud) : SurfaceExtent(),
                          static_cast<double>(input.cloud.size()), options.max_memory_bytes);
}

}  // namespace topple

// SPDX-License-Identifier: MIT
#include "geometry/surfels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "core/colour_space.h"
#include "core/short_number.h"
#include "geometry/surfel_graph.h"
#include "geometry/surfel_steps.h"
#include "topple/error.h"

namespace topple::geometry {
namespace {

// Normals are looked for on coarser grids where the cells are too sparse; this many doublings.
constexpr int most_levels = 3;

void check(const CloudView& cloud, double cell_m, std::span<const Vec3> viewpoints,
           std::span<const std::uint32_t> viewpoint_of_point) {
    if (!(cell_m > 0) || !std::isfinite(cell_m)) {
        throw Error(ErrorKind::usage,
                    "surfel size " + short_number(cell_m) + " m: it must be a positive number");
    }
    if (cloud.size() >= std::numeric_limits<std::uint32_t>::max()) {
        throw Error(ErrorKind::input, cloud.source + ": " + std::to_string(cloud.size()) +
                                          " points, more than 2^32 - 2; thin the cloud out");
    }
    if (!viewpoint_of_point.empty() && viewpoint_of_point.size() != cloud.size()) {
        throw Error(ErrorKind::input,
                    cloud.source + ": " + std::to_string(viewpoint_of_point.size()) +
                        " viewpoint indices for " + std::to_string(cloud.size()) + " points");
    }
    for (const std::uint32_t index : viewpoint_of_point) {
        if (index >= viewpoints.size()) {
            throw Error(ErrorKind::input, cloud.source + ": viewpoint " + std::to_string(index) +
                                              " of " + std::to_string(viewpoints.size()));
        }
    }
}

constexpr std::uint64_t surfel_chunk = 1 << 14;  // points or cells handed to a thread at once

using Axes = std::array<FloatColumn, 3>;

// Lowest and highest cell per axis. Throws Error(input) where they lie too far apart.
CellPacking packing_of(const CloudView& cloud, const Axes& p, double cell_m, ThreadPool& threads) {
    std::array<std::array<float, 2>, 3> range{};
    threads.each(3, 1, [&](std::size_t a) {
        const auto [low, high] = std::minmax_element(p[a].begin(), p[a].end());
        range[a] = {*low, *high};
    });
    std::array<std::int64_t, 3> lowest{}, highest{};
    for (std::size_t a = 0; a < 3; ++a) {
        const double lo = std::floor(range[a][0] / cell_m), hi = std::floor(range[a][1] / cell_m);
        constexpr double most_index = 1 << 30;
        if (!(std::abs(lo) < most_index && std::abs(hi) < most_index &&
              hi - lo < static_cast<double>(max_cells_per_axis))) {
            throw Error(ErrorKind::input,
                        cloud.source + ": the cloud reaches from " + short_number(range[a][0]) +
                            " to " + short_number(range[a][1]) + " m, more than " +
                            std::to_string(max_cells_per_axis) + " cells of " +
                            short_number(cell_m) +
                            " m; remove stray points or use a larger voxel_m (--voxel)");
        }
        lowest[a] = static_cast<std::int64_t>(lo);
        highest[a] = static_cast<std::int64_t>(hi);
    }
    return {lowest, highest};
}

// The cells of the points and their moments.
CellGrid bin(const CloudView& cloud, double cell_m, ThreadPool& threads,
             std::vector<std::uint32_t>& of_point, std::vector<float>& count) {
    const Axes p{cloud.x, cloud.y, cloud.z};
    const std::size_t n = cloud.size();
    CellGrid grid;
    grid.cell_m = cell_m;
    of_point.resize(n);
    if (n == 0) return grid;
    const CellPacking pack = packing_of(cloud, p, cell_m, threads);
    const auto index = [&](float v) { return static_cast<std::int64_t>(std::floor(v / cell_m)); };
    std::vector<std::uint64_t> keys(n);
    threads.each(n, surfel_chunk, [&](std::size_t i) {
        keys[i] = pack(index(cloud.x[i]), index(cloud.y[i]), index(cloud.z[i]));
    });
    const KeyGroups cells = group_keys(keys, threads);
    grid.resize(cells.size());
    count.assign(cells.size(), 0);
    threads.each(cells.size(), surfel_chunk, [&](std::size_t cell) {
        const auto points = cells.group(cell);
        for (const std::uint32_t i : points) of_point[i] = static_cast<std::uint32_t>(cell);
        grid.set_index(cell, {index(cloud.x[points[0]]), index(cloud.y[points[0]]),
                              index(cloud.z[points[0]])});
        grid.set(cell, moments_of(p, points, grid.index(cell), cell_m));
        const double size = static_cast<double>(points.size());
        count[cell] = static_cast<float>(size);
        grid.weight[cell] = fit_weight(size);
    });
    return grid;
}

void set_normals(Surfels& s, const PlaneFit& fit, const std::vector<std::uint32_t>* of,
                 double cell_m) {
    for (std::size_t k = 0; k < fit.size(); ++k) {
        const std::size_t i = of ? (*of)[k] : k;
        s.nx[i] = fit.normal[0][k];
        s.ny[i] = fit.normal[1][k];
        s.nz[i] = fit.normal[2][k];
        s.roughness_m[i] = static_cast<float>(fit.rms[k] * cell_m);
    }
}

// Where a surfel has too few neighbours for a plane, the next coarser grid that has enough gives
// it.
void fill_from_coarser(device::Device& device, const CellGrid& fine, Surfels& s) {
    std::vector<std::uint32_t> left;
    for (std::uint32_t i = 0; i < s.size(); ++i)
        if (!s.has_normal(i)) left.push_back(i);
    std::vector<std::uint32_t> cell_of(s.size());
    std::iota(cell_of.begin(), cell_of.end(), 0u);
    CellGrid grid = fine;
    for (int level = 1; level <= most_levels && !left.empty(); ++level) {
        std::vector<std::uint32_t> parent;
        grid = coarsen(grid, device.threads(), parent);
        for (std::uint32_t& cell : cell_of) cell = parent[cell];
        PlaneQueries queries;
        for (const std::uint32_t i : left) {
            queries.cell.push_back(cell_of[i]);
            const std::array<double, 3> at{s.x[i], s.y[i], s.z[i]};
            for (std::size_t a = 0; a < 3; ++a)
                queries.at[a].push_back(
                    static_cast<float>(at[a] / grid.cell_m - (grid.index(cell_of[i])[a] + 0.5)));
        }
        set_normals(s, fit_planes(device, grid, std::move(queries)), &left, grid.cell_m);
        std::erase_if(left, [&](std::uint32_t i) { return s.has_normal(i); });
    }
}

Surfels from_grid(const CellGrid& grid) {
    Surfels s;
    s.cell_m = grid.cell_m;
    s.cx = grid.x;
    s.cy = grid.y;
    s.cz = grid.z;
    for (auto* field : {&s.x, &s.y, &s.z, &s.nx, &s.ny, &s.nz, &s.roughness_m}) {
        field->assign(grid.size(), 0.0f);
    }
    const std::array<std::vector<float>*, 3> at{&s.x, &s.y, &s.z};
    for (std::size_t i = 0; i < grid.size(); ++i)
        for (std::size_t a = 0; a < 3; ++a)
            (*at[a])[i] =
                static_cast<float>((grid.index(i)[a] + 0.5 + grid.mean[a][i]) * grid.cell_m);
    return s;
}

// Their colours, from those of their points, where the cloud has any.
void set_colours(const CloudView& cloud, Surfels& s) {
    if (cloud.red.empty()) return;
    // Whole numbers, so that the order of the points does not matter.
    struct Sum {
        std::array<std::uint64_t, 3> channel{};
        std::uint64_t points = 0;
    };
    std::vector<Sum> sums(s.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Rgb8 colour{cloud.red[i], cloud.green[i], cloud.blue[i]};
        if (colour == Rgb8{0, 0, 0}) continue;
        Sum& sum = sums[s.of_point[i]];
        for (std::size_t c = 0; c < 3; ++c) sum.channel[c] += colour[c];
        ++sum.points;
    }
    for (auto* values : {&s.lab_l, &s.lab_a, &s.lab_b})
        values->assign(s.size(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (sums[i].points == 0) continue;
        std::array<double, 3> mean{};
        for (std::size_t c = 0; c < 3; ++c) {
            mean[c] = static_cast<double>(sums[i].channel[c]) /
                      (255.0 * static_cast<double>(sums[i].points));
        }
        const std::array<double, 3> lab = lab_of_srgb(mean);
        s.lab_l[i] = static_cast<float>(lab[0]);
        s.lab_a[i] = static_cast<float>(lab[1]);
        s.lab_b[i] = static_cast<float>(lab[2]);
    }
}

}  // namespace

Surfels make_surfels(device::Device& device, const CloudView& cloud, const SurfelScale& scale,
                     std::span<const Vec3> viewpoints,
                     std::span<const std::uint32_t> viewpoint_of_point) {
    const double cell_m = scale.cell_m;
    check(cloud, cell_m, viewpoints, viewpoint_of_point);
    std::vector<std::uint32_t> of_point;
    std::vector<float> count;
    CellGrid grid = bin(cloud, cell_m, device.threads(), of_point, count);
    if (grid.size() == 0) {
        Surfels none;
        none.cell_m = cell_m;
        none.neighbour_first.assign(1, 0);
        return none;
    }
    PlaneFit rough = flatten_noise(device, grid, count, of_point);
    const SensorSides sides(cloud, viewpoints, viewpoint_of_point);
    part_sides(cloud, sides, device.threads(), grid, count, of_point, rough);
    Surfels s = from_grid(grid);
    s.weight = std::move(count);
    s.of_point = std::move(of_point);
    s.area_m2 = std::pow(std::max(cell_m, scale.pitch_m), 2);
    connect_surfels(s, scale.reach_m, device.threads());

    set_normals(s, rough, nullptr, cell_m);
    const Orientation towards = sensor_side(s, sides, device.threads());
    orient(s, towards);
    // The second pass knows which side each cell faces and leaves the others out.
    const std::vector<float> px = s.nx, py = s.ny, pz = s.nz;
    PlaneFit sharp = PlaneFitter(device, grid, queries_at_means(grid)).fit({px, py, pz});
    for (std::size_t i = 0; i < s.size(); ++i) {
        // Where too few agree, the first pass stands.
        if (!sharp.has_plane(i)) {
            sharp.normal[0][i] = px[i];
            sharp.normal[1][i] = py[i];
            sharp.normal[2][i] = pz[i];
            sharp.rms[i] = static_cast<float>(s.roughness_m[i] / cell_m);
        } else if (sharp.normal[0][i] * px[i] + sharp.normal[1][i] * py[i] +
                       sharp.normal[2][i] * pz[i] <
                   0) {
            for (auto& axis : sharp.normal) axis[i] = -axis[i];
        }
    }
    set_normals(s, sharp, nullptr, cell_m);
    fill_from_coarser(device, grid, s);
    orient(s, towards);
    set_colours(cloud, s);
    return s;
}

}  // namespace topple::geometry

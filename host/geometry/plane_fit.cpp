// SPDX-License-Identifier: MIT
#include "geometry/plane_fit.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "device/queue.h"
#include "topple/error.h"
#include "voxel_normals.hpp"

namespace topple::geometry {
namespace {

constexpr std::size_t cell_planes = 10, fit_planes_count = 6;

// The cells [first, last) that a tile answers for, and [halo_first, halo_last) that it looks at.
struct Tile {
    std::size_t first, last, halo_first, halo_last;
};

std::vector<Tile> make_tiles(const CellGrid& grid, int radius, std::uint64_t binding_bytes) {
    const auto side = static_cast<std::size_t>(2 * radius + 1);
    // The packed columns leave 29 bits for the cell.
    const std::size_t most_halo =
        std::min<std::size_t>(binding_bytes / (4 * cell_planes), (1u << 29) - 1);
    const std::size_t most_cells = std::max<std::size_t>(binding_bytes / (4 * side * side), 1);
    const auto lower = [&](std::int64_t x) {
        return static_cast<std::size_t>(
            std::lower_bound(grid.x.begin(), grid.x.end(), x,
                             [](std::int32_t a, std::int64_t b) { return a < b; }) -
            grid.x.begin());
    };
    std::vector<Tile> tiles;
    for (std::size_t first = 0; first < grid.size();) {
        std::size_t count = std::min(most_cells, grid.size() - first);
        Tile tile{};
        for (;; count /= 2) {
            if (count == 0) {
                throw Error(ErrorKind::device, "kernel voxel_normals: the cells at x index " +
                                                   std::to_string(grid.x[first]) +
                                                   " do not fit the device's largest binding of " +
                                                   std::to_string(binding_bytes) +
                                                   " bytes; use a larger --voxel");
            }
            tile = {first, first + count, lower(std::int64_t{grid.x[first]} - radius),
                    lower(std::int64_t{grid.x[first + count - 1]} + radius + 1)};
            if (tile.halo_last - tile.halo_first <= most_halo) break;
        }
        tiles.push_back(tile);
        first = tile.last;
    }
    return tiles;
}

std::vector<float> planes_of(std::span<const std::span<const float>> planes, std::size_t first,
                             std::size_t last) {
    std::vector<float> all;
    all.reserve(planes.size() * (last - first));
    for (const auto& plane : planes) {
        all.insert(all.end(), plane.begin() + static_cast<std::ptrdiff_t>(first),
                   plane.begin() + static_cast<std::ptrdiff_t>(last));
    }
    return all;
}

}  // namespace

PlaneQueries queries_at_means(const CellGrid& grid) {
    PlaneQueries queries;
    queries.cell.resize(grid.size());
    std::iota(queries.cell.begin(), queries.cell.end(), 0u);
    queries.at = grid.mean;
    return queries;
}

namespace {

void resize(PlaneFit& fit, std::size_t count) {
    for (auto& plane : fit.normal) plane.resize(count);
    fit.rms.resize(count);
    fit.offset.resize(count);
    fit.used.resize(count);
}

// Fits the queries order[begin, end), whose cells lie in the tile.
void fit_tile(device::Device& device, const CellGrid& grid, const PlaneQueries& queries,
              const PlaneFitOptions& options, const Tile& tile,
              std::span<const std::uint32_t> order, PlaneFit& fit) {
    const std::size_t count = order.size();
    std::vector<std::uint32_t> home(count);
    std::vector<float> at(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
        home[i] = queries.cell[order[i]] - static_cast<std::uint32_t>(tile.first);
        for (std::size_t a = 0; a < 3; ++a) at[a * count + i] = queries.at[a][order[i]];
    }
    const std::array<std::span<const float>, cell_planes> moments{
        grid.weight,    grid.mean[0],   grid.mean[1],   grid.mean[2],   grid.spread[0],
        grid.spread[1], grid.spread[2], grid.spread[3], grid.spread[4], grid.spread[5]};
    const std::vector<float> cells = planes_of(moments, tile.halo_first, tile.halo_last);
    const std::span<const std::int32_t> z(grid.z.data() + tile.halo_first,
                                          tile.halo_last - tile.halo_first);
    const std::vector<std::uint32_t> table =
        column_table(grid, options.radius, tile.first, tile.last, tile.halo_first);
    std::vector<float> prior{0.0f};
    const bool guided = !options.prior_x.empty();
    if (guided) {
        const std::array<std::span<const float>, 3> planes{options.prior_x, options.prior_y,
                                                           options.prior_z};
        prior = planes_of(planes, tile.halo_first, tile.halo_last);
    }
    using device::Buffer;
    const Buffer<float> d_cells(device, std::span<const float>(cells), "cells");
    const Buffer<std::int32_t> d_z(device, z, "cell_z");
    const Buffer<std::uint32_t> d_table(device, std::span<const std::uint32_t>(table), "columns");
    const Buffer<std::uint32_t> d_home(device, std::span<const std::uint32_t>(home), "query_cell");
    const Buffer<float> d_at(device, std::span<const float>(at), "query");
    const Buffer<float> d_prior(device, std::span<const float>(prior), "prior");
    const Buffer<float> d_fit(device, fit_planes_count * count, "fit");
    const float reach = static_cast<float>(options.radius) + 0.5f;
    device::Queue queue(device);
    queue.add<kernels::VoxelNormals>(
        count,
        {.cells = d_cells,
         .cell_z = d_z,
         .columns = d_table,
         .query_cell = d_home,
         .query = d_at,
         .prior = d_prior,
         .fit = d_fit},
        {.query_count = static_cast<std::uint32_t>(count),
         .cell_count = static_cast<std::uint32_t>(tile.halo_last - tile.halo_first),
         .column_first = static_cast<std::uint32_t>(tile.first - tile.halo_first),
         .column_count = static_cast<std::uint32_t>(tile.last - tile.first),
         .radius = options.radius,
         .inverse_reach2 = 1.0f / (reach * reach),
         .use_prior = guided ? 1u : 0u});
    queue.run();
    const std::vector<float> out = d_fit.download();
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t a = 0; a < 3; ++a) fit.normal[a][order[i]] = out[a * count + i];
        fit.rms[order[i]] = out[3 * count + i];
        fit.offset[order[i]] = out[4 * count + i];
        fit.used[order[i]] = out[5 * count + i];
    }
}

}  // namespace

PlaneFit fit_planes(device::Device& device, const CellGrid& grid, const PlaneQueries& queries,
                    const PlaneFitOptions& options) {
    PlaneFit fit;
    const std::size_t count = queries.cell.size();
    resize(fit, count);
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    if (!std::is_sorted(queries.cell.begin(), queries.cell.end())) {
        std::vector<std::uint64_t> keys(queries.cell.begin(), queries.cell.end());
        order = sorted_order(keys);
    }
    // Queries per dispatch are bounded too: their planes travel as one binding each.
    const std::uint64_t binding = device.info().limits.max_binding_bytes;
    const std::size_t most_queries = std::max<std::size_t>(binding / (4 * fit_planes_count), 1);
    std::size_t begin = 0;
    for (const Tile& tile : make_tiles(grid, options.radius, binding)) {
        while (begin < count && queries.cell[order[begin]] < tile.last) {
            std::size_t end = begin;
            while (end < count && end - begin < most_queries &&
                   queries.cell[order[end]] < tile.last)
                ++end;
            fit_tile(device, grid, queries, options, tile,
                     std::span<const std::uint32_t>(order).subspan(begin, end - begin), fit);
            begin = end;
        }
    }
    return fit;
}

}  // namespace topple::geometry

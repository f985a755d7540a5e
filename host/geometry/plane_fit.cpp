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
constexpr std::uint64_t query_chunk = 1 << 15;  // queries handed to a thread at once

using Tile = PlaneFitter::Tile;

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

using Planes = std::initializer_list<std::span<const float>>;

// The elements [first, last) of each plane, one plane after the other.
device::Buffer<float> upload_planes(device::Device& device, const Planes& planes, std::size_t first,
                                    std::size_t last, const char* name) {
    device::Buffer<float> buffer(device, planes.size() * (last - first), name);
    std::size_t to = 0;
    for (const auto& plane : planes) {
        buffer.upload(plane.subspan(first, last - first), to);
        to += last - first;
    }
    return buffer;
}

void resize(PlaneFit& fit, std::size_t count) {
    for (auto& plane : fit.normal) plane.resize(count);
    fit.rms.resize(count);
    fit.offset.resize(count);
    fit.used.resize(count);
}

std::array<std::span<float>, fit_planes_count> planes_of(PlaneFit& fit) {
    return {fit.normal[0], fit.normal[1], fit.normal[2], fit.rms, fit.offset, fit.used};
}

}  // namespace

PlaneQueries queries_at_means(const CellGrid& grid) {
    PlaneQueries queries;
    queries.cell.resize(grid.size());
    std::iota(queries.cell.begin(), queries.cell.end(), 0u);
    queries.at = grid.mean;
    return queries;
}

// What the kernel needs of a tile, whatever the queries.
struct PlaneFitter::OnDevice {
    device::Buffer<float> cells;
    device::Buffer<std::int32_t> cell_z;
    device::Buffer<std::uint32_t> columns;
};

PlaneFitter::PlaneFitter(device::Device& device, const CellGrid& grid, int radius)
    : device_(device), grid_(grid), radius_(radius), sweep_(grid.x, grid.y, grid.z, radius) {
    tiles_ = make_tiles(grid, radius, device.info().limits.max_binding_bytes);
}
PlaneFitter::~PlaneFitter() = default;

const PlaneFitter::OnDevice& PlaneFitter::prepare(const Tile& tile) {
    if (prepared_ && prepared_tile_ == &tile) return *prepared_;
    prepared_.reset();  // before the next is made: one tile's memory at a time
    prepared_tile_ = &tile;
    const CellGrid& g = grid_;
    const std::size_t first = tile.halo_first, last = tile.halo_last;
    const std::vector<std::uint32_t> table =
        column_table(sweep_, tile.first, tile.last, first, device_.threads());
    prepared_ = std::make_unique<OnDevice>(
        OnDevice{upload_planes(device_,
                               {g.weight, g.mean[0], g.mean[1], g.mean[2], g.spread[0], g.spread[1],
                                g.spread[2], g.spread[3], g.spread[4], g.spread[5]},
                               first, last, "cells"),
                 {device_, std::span(g.z).subspan(first, last - first), "cell_z"},
                 {device_, std::span<const std::uint32_t>(table), "columns"}});
    return *prepared_;
}

void PlaneFitter::fit_tile(const Tile& tile, const PlaneQueries& queries, const PlanePrior& prior,
                           std::span<const std::uint32_t> order, PlaneFit& fit) {
    const OnDevice& on = prepare(tile);
    const std::size_t count = order.size();
    const bool guided = !prior.x.empty();
    std::vector<std::uint32_t> home(count);
    std::vector<float> at(3 * count);
    device_.threads().each(count, query_chunk, [&](std::size_t i) {
        home[i] = queries.cell[order[i]] - static_cast<std::uint32_t>(tile.first);
        for (std::size_t a = 0; a < 3; ++a) at[a * count + i] = queries.at[a][order[i]];
    });
    const device::Buffer<std::uint32_t> d_home(device_, std::span<const std::uint32_t>(home),
                                               "query_cell");
    const device::Buffer<float> d_at(device_, std::span<const float>(at), "query");
    const device::Buffer<float> d_prior =
        guided ? upload_planes(device_, {prior.x, prior.y, prior.z}, tile.halo_first,
                               tile.halo_last, "prior")
               : device::Buffer<float>(device_, 1, "prior");
    const device::Buffer<float> d_fit(device_, fit_planes_count * count, "fit");
    const float reach = static_cast<float>(radius_) + 0.5f;
    device::Queue queue(device_);
    queue.add<kernels::VoxelNormals>(
        count,
        {.cells = on.cells,
         .cell_z = on.cell_z,
         .columns = on.columns,
         .query_cell = d_home,
         .query = d_at,
         .prior = d_prior,
         .fit = d_fit},
        {.query_count = static_cast<std::uint32_t>(count),
         .cell_count = static_cast<std::uint32_t>(tile.halo_last - tile.halo_first),
         .column_first = static_cast<std::uint32_t>(tile.first - tile.halo_first),
         .column_count = static_cast<std::uint32_t>(tile.last - tile.first),
         .radius = radius_,
         .inverse_reach2 = 1.0f / (reach * reach),
         .use_prior = guided ? 1u : 0u});
    queue.run();
    const std::vector<float> out = d_fit.download();
    const auto planes = planes_of(fit);
    device_.threads().each(count, query_chunk, [&](std::size_t i) {
        for (std::size_t a = 0; a < fit_planes_count; ++a) planes[a][order[i]] = out[a * count + i];
    });
}

PlaneFit PlaneFitter::fit(const PlaneQueries& queries, const PlanePrior& prior) {
    PlaneFit fit;
    const std::size_t count = queries.cell.size();
    resize(fit, count);
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    if (!std::is_sorted(queries.cell.begin(), queries.cell.end())) {
        const std::vector<std::uint64_t> keys(queries.cell.begin(), queries.cell.end());
        order = sorted_order(keys);
    }
    // Queries per dispatch are bounded too: their planes travel as one binding each.
    const std::size_t most_queries =
        std::max<std::size_t>(device_.info().limits.max_binding_bytes / (4 * fit_planes_count), 1);
    std::size_t begin = 0;
    for (const Tile& tile : tiles_) {
        while (begin < count && queries.cell[order[begin]] < tile.last) {
            std::size_t end = begin;
            while (end < count && end - begin < most_queries &&
                   queries.cell[order[end]] < tile.last)
                ++end;
            fit_tile(tile, queries, prior,
                     std::span<const std::uint32_t>(order).subspan(begin, end - begin), fit);
            begin = end;
        }
    }
    return fit;
}

PlaneFit fit_planes(device::Device& device, const CellGrid& grid, const PlaneQueries& queries) {
    return PlaneFitter(device, grid).fit(queries, {});
}

}  // namespace topple::geometry

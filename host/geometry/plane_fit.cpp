// SPDX-License-Identifier: MIT
#include "geometry/plane_fit.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "core/sorted_order.h"
#include "plane_mean.hpp"
#include "topple/error.h"
#include "topple/kernels/queue.h"
#include "voxel_normals.hpp"

namespace topple::geometry {
namespace {

constexpr std::size_t cell_planes = 10, fit_planes_count = 6, mean_planes = 8;
constexpr float reach = plane_radius + 0.5f;  // cells
constexpr float least_cosine = 0.8f;          // of the angle between normals of one surface
constexpr std::uint32_t no_query = ~0u;
constexpr std::uint64_t query_chunk = 1 << 15;  // queries handed to a thread at once
// Queries or cells of a tile, where a device takes as many: the tables have 100 bytes for each.
constexpr std::size_t preferred_tile = std::size_t{1} << 20;

using Planes = std::initializer_list<std::span<const float>>;

// The elements [first, last) of each plane, one plane after the other; zeros of an empty one.
device::Buffer<float> upload_planes(device::Device& device, const Planes& planes, std::size_t first,
                                    std::size_t last, const char* name) {
    device::Buffer<float> buffer(device, planes.size() * (last - first), name);
    std::vector<float> zeros;
    std::size_t to = 0;
    for (const auto& plane : planes) {
        if (plane.empty()) zeros.resize(last - first);
        buffer.upload(plane.empty() ? zeros : plane.subspan(first, last - first), to);
        to += last - first;
    }
    return buffer;
}

}  // namespace

PlaneQueries queries_at_means(const CellGrid& grid) {
    PlaneQueries queries;
    queries.cell.resize(grid.size());
    std::iota(queries.cell.begin(), queries.cell.end(), 0u);
    queries.at = grid.mean;
    return queries;
}

// What the kernel needs of a tile, whatever the prior.
struct PlaneFitter::OnDevice {
    device::Buffer<float> cells;
    device::Buffer<std::int32_t> cell_z;
    device::Buffer<std::uint32_t> columns, query_cell;
    device::Buffer<float> query;
};

PlaneFitter::PlaneFitter(device::Device& device, const CellGrid& grid, PlaneQueries queries)
    : device_(device),
      grid_(grid),
      queries_(std::move(queries)),
      sweep_(grid.x, grid.y, grid.z, plane_radius) {
    if (std::is_sorted(queries_.cell.begin(), queries_.cell.end())) {
        order_.resize(queries_.cell.size());
        std::iota(order_.begin(), order_.end(), 0u);
    } else {
        order_ =
            sorted_order(std::vector<std::uint64_t>(queries_.cell.begin(), queries_.cell.end()));
    }
    for (const std::uint32_t q : order_) cell_.push_back(queries_.cell[q]);
    tiles_ = make_tiles();
}
PlaneFitter::~PlaneFitter() = default;

std::vector<PlaneFitter::Tile> PlaneFitter::make_tiles() const {
    const std::uint64_t binding = device_.info().limits.max_binding_bytes;
    // The packed columns leave 28 bits for the cell.
    const std::size_t most_halo =
        std::min<std::size_t>(binding / (4 * cell_planes), (1u << 28) - 1);
    const std::size_t most_queries =
        std::clamp<std::size_t>(binding / (4 * sweep_.columns()), 1, preferred_tile);
    const auto lower = [&](std::int64_t x) {
        return static_cast<std::size_t>(
            std::lower_bound(grid_.x.begin(), grid_.x.end(), x,
                             [](std::int32_t a, std::int64_t b) { return a < b; }) -
            grid_.x.begin());
    };
    std::vector<Tile> tiles;
    for (std::size_t first = 0; first < cell_.size();) {
        const std::uint64_t beyond = std::uint64_t{cell_[first]} + preferred_tile;
        std::size_t count = static_cast<std::size_t>(
            std::lower_bound(cell_.begin() + static_cast<std::ptrdiff_t>(first), cell_.end(),
                             beyond) -
            cell_.begin() - static_cast<std::ptrdiff_t>(first));
        count = std::min(count, most_queries);
        Tile tile{};
        for (;; count /= 2) {
            if (count == 0) {
                throw Error(ErrorKind::device, "kernel voxel_normals: the cells at x index " +
                                                   std::to_string(grid_.x[cell_[first]]) +
                                                   " do not fit the device's largest binding of " +
                                                   std::to_string(binding) +
                                                   " bytes; use a larger voxel_m (--voxel)");
            }
            tile = {first, first + count, lower(std::int64_t{grid_.x[cell_[first]]} - plane_radius),
                    lower(std::int64_t{grid_.x[cell_[first + count - 1]]} + plane_radius + 1)};
            if (tile.halo_last - tile.halo_first <= most_halo) break;
        }
        tiles.push_back(tile);
        first = tile.last;
    }
    return tiles;
}

const PlaneFitter::OnDevice& PlaneFitter::prepare(const Tile& tile) {
    if (prepared_ && prepared_tile_ == &tile) return *prepared_;
    prepared_.reset();  // before the next is made: one tile's memory at a time
    prepared_tile_ = &tile;
    const CellGrid& g = grid_;
    const std::size_t first = tile.halo_first, last = tile.halo_last,
                      count = tile.last - tile.first;
    const std::span<const std::uint32_t> cells = std::span(cell_).subspan(tile.first, count);
    const std::vector<std::uint32_t> table = column_table(sweep_, cells, first, device_.threads());
    std::vector<std::uint32_t> home(count);
    std::vector<float> at(3 * count);
    device_.threads().each(count, query_chunk, [&](std::size_t i) {
        home[i] = cells[i] - static_cast<std::uint32_t>(first);
        for (std::size_t a = 0; a < 3; ++a)
            at[a * count + i] = queries_.at[a][order_[tile.first + i]];
    });
    prepared_ = std::make_unique<OnDevice>(
        OnDevice{upload_planes(device_,
                               {g.weight, g.mean[0], g.mean[1], g.mean[2], g.spread[0], g.spread[1],
                                g.spread[2], g.spread[3], g.spread[4], g.spread[5]},
                               first, last, "cells"),
                 {device_, std::span(g.z).subspan(first, last - first), "cell_z"},
                 {device_, std::span<const std::uint32_t>(table), "columns"},
                 {device_, std::span<const std::uint32_t>(home), "query_cell"},
                 {device_, std::span<const float>(at), "query"}});
    return *prepared_;
}

void PlaneFitter::fit_tile(const Tile& tile, const PlanePrior& prior, PlaneFit& fit) {
    const OnDevice& on = prepare(tile);
    const std::size_t count = tile.last - tile.first;
    const bool guided = !prior.x.empty();
    const device::Buffer<float> d_prior =
        guided ? upload_planes(device_, {prior.x, prior.y, prior.z}, tile.halo_first,
                               tile.halo_last, "prior")
               : device::Buffer<float>(device_, 1, "prior");
    const device::Buffer<float> d_fit(device_, fit_planes_count * count, "fit");
    device::Queue queue(device_);
    queue.add<kernels::VoxelNormals>(
        count,
        {.cells = on.cells,
         .cell_z = on.cell_z,
         .columns = on.columns,
         .query_cell = on.query_cell,
         .query = on.query,
         .prior = d_prior,
         .fit = d_fit},
        {.query_count = static_cast<std::uint32_t>(count),
         .cell_count = static_cast<std::uint32_t>(tile.halo_last - tile.halo_first),
         .radius = plane_radius,
         .inverse_reach2 = 1.0f / (reach * reach),
         .use_prior = guided ? 1u : 0u});
    queue.run();
    const std::vector<float> out = d_fit.download();
    const auto columns = fit.columns();
    device_.threads().each(count, query_chunk, [&](std::size_t i) {
        for (std::size_t a = 0; a < fit_planes_count; ++a)
            (*columns[a])[order_[tile.first + i]] = out[a * count + i];
    });
}

PlaneFit PlaneFitter::fit(const PlanePrior& prior) {
    PlaneFit fit;
    fit.resize(cell_.size());
    for (const Tile& tile : tiles_) fit_tile(tile, prior, fit);
    return fit;
}

void PlaneFitter::mean_tile(const Tile& tile, std::span<const std::uint32_t> query_of,
                            const PlaneFit& fit, std::vector<float>& out) {
    const OnDevice& on = prepare(tile);
    const std::size_t count = tile.last - tile.first, cells = tile.halo_last - tile.halo_first;
    std::vector<float> planes(mean_planes * cells, 0.0f);
    device_.threads().each(cells, query_chunk, [&](std::size_t c) {
        const std::uint32_t q = query_of[tile.halo_first + c];
        if (q == no_query) return;
        const std::array<float, mean_planes> values{grid_.weight[tile.halo_first + c],
                                                    queries_.at[0][q],
                                                    queries_.at[1][q],
                                                    queries_.at[2][q],
                                                    fit.normal[0][q],
                                                    fit.normal[1][q],
                                                    fit.normal[2][q],
                                                    fit.offset[q]};
        for (std::size_t a = 0; a < mean_planes; ++a) planes[a * cells + c] = values[a];
    });
    const device::Buffer<float> d_planes(device_, std::span<const float>(planes), "planes"),
        d_offsets(device_, count, "offsets");
    device::Queue queue(device_);
    queue.add<kernels::PlaneMean>(count,
                                  {.planes = d_planes,
                                   .cell_z = on.cell_z,
                                   .columns = on.columns,
                                   .query_cell = on.query_cell,
                                   .offsets = d_offsets},
                                  {.query_count = static_cast<std::uint32_t>(count),
                                   .cell_count = static_cast<std::uint32_t>(cells),
                                   .radius = plane_radius,
                                   .reach2 = reach * reach,
                                   .least_cosine = least_cosine});
    queue.run();
    const std::vector<float> offsets = d_offsets.download();
    for (std::size_t i = 0; i < count; ++i) out[order_[tile.first + i]] = offsets[i];
}

std::vector<float> PlaneFitter::mean_offsets(const PlaneFit& fit) {
    std::vector<std::uint32_t> query_of(grid_.size(), no_query);
    for (std::size_t q = 0; q < queries_.cell.size(); ++q)
        query_of[queries_.cell[q]] = static_cast<std::uint32_t>(q);
    std::vector<float> out(queries_.cell.size());
    // From the last one on, which the fit has left prepared.
    for (auto tile = tiles_.rbegin(); tile != tiles_.rend(); ++tile)
        mean_tile(*tile, query_of, fit, out);
    return out;
}

PlaneFit fit_planes(device::Device& device, const CellGrid& grid, PlaneQueries queries) {
    return PlaneFitter(device, grid, std::move(queries)).fit({});
}

}  // namespace topple::geometry

// SPDX-License-Identifier: MIT
#include <cmath>
#include <memory>

#include "normal_cluster.hpp"
#include "perf/cases/cases.h"
#include "plane_mean.hpp"
#include "scenes/random.h"
#include "voxel_normals.hpp"

namespace topple::perf {
namespace {

using scenes::Random;

// Cell height of a rolling surface over a plane of cells.
int height(int x, int y) {
    return (x / 3 + y / 5 + (x % 64 < 32 ? x % 32 : 32 - x % 32) / 4) % 1024;
}

// A sheet of 449 x 449 cells, as surfaces are: each finds its 25 columns in a few cache lines. An
// odd side, so that the planes of cells do not lie whole pages apart, where they meet in one set of
// a cache.
struct Sheet {
    static constexpr int side = 449, radius = 2, width = 2 * radius + 1;
    static constexpr std::uint32_t count = side * side;
    std::vector<std::int32_t> cell_z;
    std::vector<std::uint32_t> columns, query_cell;
    double pairs = 0;  // of queries and cells in their reach

    Sheet() : cell_z(count), columns(std::size_t{width * width} * count), query_cell(count) {
        for (std::uint32_t n = 0; n < count; ++n) {
            const int x = static_cast<int>(n) / side, y = static_cast<int>(n) % side;
            cell_z[n] = height(x, y);
            query_cell[n] = n;
            for (int c = 0; c < width * width; ++c) {
                const int a = x + c / width - radius, b = y + c % width - radius;
                const bool in = a >= 0 && b >= 0 && a < side && b < side &&
                                std::abs(height(a, b) - cell_z[n]) <= radius;
                columns[static_cast<std::size_t>(c) * count + n] =
                    in ? static_cast<std::uint32_t>(a * side + b) | 1u << 28 : 0u;
                pairs += in;
            }
        }
    }
};

// What both kernels read of it.
struct SheetOnDevice {
    device::Buffer<std::int32_t> cell_z;
    device::Buffer<std::uint32_t> columns, query_cell;
    SheetOnDevice(device::Device& device, const Sheet& sheet)
        : cell_z(upload(device, sheet.cell_z, "cell_z")),
          columns(upload(device, sheet.columns, "columns")),
          query_cell(upload(device, sheet.query_cell, "query_cell")) {}
};

}  // namespace

Prepared voxel_normals(device::Device& device) {
    constexpr std::uint32_t count = Sheet::count;
    const Sheet sheet;
    Random random(4);
    std::vector<float> cells(10 * std::size_t{count}), query(3 * std::size_t{count}),
        prior(3 * std::size_t{count}, 0.0f);
    for (std::uint32_t n = 0; n < count; ++n) {
        cells[n] = static_cast<float>(random.integer(1, 9));
        for (std::uint32_t k = 1; k < 4; ++k) {
            cells[k * count + n] = static_cast<float>(random.uniform(-0.4, 0.4));
            query[(k - 1) * count + n] = cells[k * count + n];
        }
        for (std::uint32_t k = 4; k < 10; ++k) cells[k * count + n] = k < 7 ? 0.05f : 0.0f;
    }
    struct Buffers {
        SheetOnDevice sheet;
        device::Buffer<float> cells, query, prior, fit;
    };
    auto on = std::make_shared<Buffers>(Buffers{{device, sheet},
                                                upload(device, cells, "cells"),
                                                upload(device, query, "query"),
                                                upload(device, prior, "prior"),
                                                {device, 6 * std::uint64_t{count}, "fit"}});
    // 50 operations for each cell in reach; 15 rotations of 45 and 60 more for each query, of them
    // 5 and 4 divisions or roots. Cells beside each other are no gathers; only the query's own is.
    return {{count, "queries", count * 4.0 * (10 + 1 + Sheet::width * Sheet::width + 1 + 3 + 6),
             50 * sheet.pairs + (15 * 45 + 60.0) * count, 79.0 * count, 1.0 * count},
            [on](device::Queue& queue) {
                constexpr float reach = Sheet::radius + 0.5f;
                queue.add<kernels::VoxelNormals>(count,
                                                 {.cells = on->cells,
                                                  .cell_z = on->sheet.cell_z,
                                                  .columns = on->sheet.columns,
                                                  .query_cell = on->sheet.query_cell,
                                                  .query = on->query,
                                                  .prior = on->prior,
                                                  .fit = on->fit},
                                                 {.query_count = count,
                                                  .cell_count = count,
                                                  .radius = Sheet::radius,
                                                  .inverse_reach2 = 1 / (reach * reach),
                                                  .use_prior = 0});
            },
            {},
            [on] { return Hash().add(on->fit.download()).value(); }};
}

Prepared plane_mean(device::Device& device) {
    constexpr std::uint32_t count = Sheet::count;
    const Sheet sheet;
    Random random(6);
    std::vector<float> planes(8 * std::size_t{count});
    for (std::uint32_t n = 0; n < count; ++n) {
        const double x = random.uniform(-0.3, 0.3), y = random.uniform(-0.3, 0.3),
                     length = std::sqrt(x * x + y * y + 1);
        const double values[] = {random.uniform(0.1, 1),
                                 random.uniform(-0.4, 0.4),
                                 random.uniform(-0.4, 0.4),
                                 random.uniform(-0.4, 0.4),
                                 x / length,
                                 y / length,
                                 1 / length,
                                 random.uniform(-0.2, 0.2)};
        for (std::uint32_t k = 0; k < 8; ++k) planes[k * count + n] = static_cast<float>(values[k]);
    }
    struct Buffers {
        SheetOnDevice sheet;
        device::Buffer<float> planes, offsets;
    };
    auto on = std::make_shared<Buffers>(
        Buffers{{device, sheet}, upload(device, planes, "planes"), {device, count, "offsets"}});
    // 30 operations for each cell in reach, one of them a division; the query's own cell is
    // gathered.
    return {{count, "queries", count * 4.0 * (8 + 1 + Sheet::width * Sheet::width + 1 + 1),
             30 * sheet.pairs, sheet.pairs + count, 7.0 * count},
            [on](device::Queue& queue) {
                constexpr float reach = Sheet::radius + 0.5f;
                queue.add<kernels::PlaneMean>(count,
                                              {.planes = on->planes,
                                               .cell_z = on->sheet.cell_z,
                                               .columns = on->sheet.columns,
                                               .query_cell = on->sheet.query_cell,
                                               .offsets = on->offsets},
                                              {.query_count = count,
                                               .cell_count = count,
                                               .radius = Sheet::radius,
                                               .reach2 = reach * reach,
                                               .least_cosine = 0.8f});
            },
            {},
            [on] { return Hash().add(on->offsets.download()).value(); }};
}

// A million normals, most of them near three axes, against 12 of them.
Prepared normal_cluster(device::Device& device) {
    constexpr std::uint32_t count = 1u << 20, clusters = 12;
    Random random(5);
    std::vector<float> n[3], weight(count, 1.0f), axes;
    for (auto& axis : n) axis.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        double v[3];
        for (double& c : v) c = 0.1 * random.normal();
        v[random.integer(0, 2)] += random.chance(0.5) ? 1 : -1;
        const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        for (int k = 0; k < 3; ++k) n[k][i] = static_cast<float>(v[k] / length);
    }
    for (std::uint32_t c = 0; c < clusters; ++c) {
        for (int k = 0; k < 3; ++k) axes.push_back(n[k][c * 7919]);
    }
    const std::uint64_t groups =
        count / (64 * device.items_per_lane(kernels::NormalCluster::source()));
    struct Buffers {
        device::Buffer<float> nx, ny, nz, weight, axes;
        device::Buffer<std::int32_t> partial;
        device::Buffer<std::uint32_t> cluster;
    };
    auto on = std::make_shared<Buffers>(Buffers{upload(device, n[0], "nx"),
                                                upload(device, n[1], "ny"),
                                                upload(device, n[2], "nz"),
                                                upload(device, weight, "weight"),
                                                upload(device, axes, "axes"),
                                                {device, groups * clusters * 4, "partial"},
                                                {device, count, "cluster"}});
    // 7 operations for each axis, then 4 for each sum that a normal might join.
    return {
        {count, "normals", 20.0 * count, (7.0 * clusters + 4.0 * 4 * clusters) * count},
        [on, groups](device::Queue& queue) {
            queue.add<kernels::NormalCluster>(groups,
                                              {.nx = on->nx,
                                               .ny = on->ny,
                                               .nz = on->nz,
                                               .weight = on->weight,
                                               .axes = on->axes,
                                               .partial = on->partial,
                                               .cluster = on->cluster},
                                              {.count = count, .cluster_count = clusters});
        },
        {},
        [on] { return Hash().add(on->partial.download()).add(on->cluster.download()).value(); }};
}

}  // namespace topple::perf

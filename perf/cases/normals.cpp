// SPDX-License-Identifier: MIT
#include <cmath>
#include <memory>
#include <numeric>

#include "lab/random.h"
#include "normal_cluster.hpp"
#include "perf/cases/cases.h"
#include "plane_mean.hpp"
#include "voxel_normals.hpp"

namespace topple::perf {
namespace {

using scenes::Random;

// Cell height of a rolling surface over a plane of cells.
int height(int x, int y) {
    return (x / 3 + y / 5 + (x % 64 < 32 ? x % 32 : 32 - x % 32) / 4) % 1024;
}

// Three rolling sheets above one another, as floor, table and ceiling are, in the order of their
// columns; of their cells a sixth is missing, and every fourth is two high, as noise makes them.
struct Sheets {
    static constexpr int side = 256, sheets = 3, apart = 40, radius = 2, width = 2 * radius + 1;
    std::vector<std::int32_t> cell_z;
    std::vector<std::uint32_t> columns, query_cell;
    double pairs = 0;  // of queries and cells in their reach

    Sheets() {
        Random random(3);
        std::vector<std::uint32_t> start{0};
        for (int column = 0; column < side * side; ++column) {
            for (int sheet = 0; sheet < sheets; ++sheet) {
                if (random.chance(1.0 / 6)) continue;
                cell_z.push_back(height(column / side, column % side) + apart * sheet);
                if (random.chance(0.25)) cell_z.push_back(cell_z.back() + 1);
            }
            start.push_back(size());
        }
        query_cell.resize(size());
        std::iota(query_cell.begin(), query_cell.end(), 0u);
        columns.resize(std::size_t{width * width} * size());
        for (int column = 0; column < side * side; ++column) {
            for (std::uint32_t n = start[column]; n < start[static_cast<std::size_t>(column) + 1];
                 ++n) {
                for (int c = 0; c < width * width; ++c) {
                    const int x = column / side + c / width - radius,
                              y = column % side + c % width - radius;
                    if (x < 0 || y < 0 || x >= side || y >= side) continue;
                    std::uint32_t first = start[x * side + y];
                    const std::uint32_t end = start[static_cast<std::size_t>(x * side + y) + 1];
                    while (first < end && cell_z[first] < cell_z[n] - radius) ++first;
                    std::uint32_t count = 0;
                    while (first + count < end && cell_z[first + count] <= cell_z[n] + radius)
                        ++count;
                    columns[static_cast<std::size_t>(c) * size() + n] =
                        count > 0 ? first | count << 28 : 0u;
                    pairs += count;
                }
            }
        }
    }
    std::uint32_t size() const { return static_cast<std::uint32_t>(cell_z.size()); }
};

// What both kernels read of it.
struct SheetsOnDevice {
    device::Buffer<std::int32_t> cell_z;
    device::Buffer<std::uint32_t> columns, query_cell;
    SheetsOnDevice(device::Device& device, const Sheets& sheets)
        : cell_z(upload(device, sheets.cell_z, "cell_z")),
          columns(upload(device, sheets.columns, "columns")),
          query_cell(upload(device, sheets.query_cell, "query_cell")) {}
};

}  // namespace

Prepared voxel_normals(device::Device& device) {
    const Sheets sheets;
    const std::uint32_t count = sheets.size();
    Random random(4);
    std::vector<float> cells(10 * std::size_t{count}), query(3 * std::size_t{count}),
        prior(3 * std::size_t{count}, 0.0f);
    for (std::uint32_t n = 0; n < count; ++n) {
        cells[n] = static_cast<float>(random.integer(1, 9));
        for (std::uint32_t k = 1; k < 4; ++k) {
            cells[k * count + n] = static_cast<float>(random(-0.4, 0.4));
            query[(k - 1) * count + n] = cells[k * count + n];
        }
        for (std::uint32_t k = 4; k < 10; ++k) cells[k * count + n] = k < 7 ? 0.05f : 0.0f;
    }
    struct Buffers {
        SheetsOnDevice sheets;
        device::Buffer<float> cells, query, prior, fit;
    };
    auto on = std::make_shared<Buffers>(Buffers{{device, sheets},
                                                upload(device, cells, "cells"),
                                                upload(device, query, "query"),
                                                upload(device, prior, "prior"),
                                                {device, 6 * std::uint64_t{count}, "fit"}});
    // 50 operations for each cell in reach; 15 rotations of 45 and 60 more for each query, of them
    // 5 and 4 divisions or roots. Cells beside each other are no gathers; only the query's own is.
    return {{static_cast<double>(count), "queries",
             count * 4.0 * (10 + 1 + Sheets::width * Sheets::width + 1 + 3 + 6),
             50 * sheets.pairs + (15 * 45 + 60.0) * count, 79.0 * count, 1.0 * count},
            [on, count](device::Queue& queue) {
                constexpr float reach = Sheets::radius + 0.5f;
                queue.add<kernels::VoxelNormals>(count,
                                                 {.cells = on->cells,
                                                  .cell_z = on->sheets.cell_z,
                                                  .columns = on->sheets.columns,
                                                  .query_cell = on->sheets.query_cell,
                                                  .query = on->query,
                                                  .prior = on->prior,
                                                  .fit = on->fit},
                                                 {.query_count = count,
                                                  .cell_count = count,
                                                  .radius = Sheets::radius,
                                                  .inverse_reach2 = 1 / (reach * reach),
                                                  .use_prior = 0});
            },
            {},
            [on] { return Hash().add(on->fit.download()).value(); }};
}

Prepared plane_mean(device::Device& device) {
    const Sheets sheets;
    const std::uint32_t count = sheets.size();
    Random random(6);
    std::vector<float> planes(8 * std::size_t{count});
    for (std::uint32_t n = 0; n < count; ++n) {
        const double x = random(-0.3, 0.3), y = random(-0.3, 0.3),
                     length = std::sqrt(x * x + y * y + 1);
        const double values[] = {random(0.1, 1),    random(-0.4, 0.4), random(-0.4, 0.4),
                                 random(-0.4, 0.4), x / length,        y / length,
                                 1 / length,        random(-0.2, 0.2)};
        for (std::uint32_t k = 0; k < 8; ++k) planes[k * count + n] = static_cast<float>(values[k]);
    }
    struct Buffers {
        SheetsOnDevice sheets;
        device::Buffer<float> planes, offsets;
    };
    auto on = std::make_shared<Buffers>(
        Buffers{{device, sheets}, upload(device, planes, "planes"), {device, count, "offsets"}});
    // 30 operations for each cell in reach, one of them a division; the query's own cell is
    // gathered.
    return {{static_cast<double>(count), "queries",
             count * 4.0 * (8 + 1 + Sheets::width * Sheets::width + 1 + 1), 30 * sheets.pairs,
             sheets.pairs + count, 7.0 * count},
            [on, count](device::Queue& queue) {
                constexpr float reach = Sheets::radius + 0.5f;
                queue.add<kernels::PlaneMean>(count,
                                              {.planes = on->planes,
                                               .cell_z = on->sheets.cell_z,
                                               .columns = on->sheets.columns,
                                               .query_cell = on->sheets.query_cell,
                                               .offsets = on->offsets},
                                              {.query_count = count,
                                               .cell_count = count,
                                               .radius = Sheets::radius,
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

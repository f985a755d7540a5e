// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <exception>
#include <string>

#include "device/native/thread_pool.h"
#include "device/queue.h"
#include "group_landscape.hpp"
#include "physics/assess.h"
#include "steepest_descent.hpp"
#include "topple/error.h"

namespace topple::physics {
namespace {

constexpr std::uint64_t batch_bytes = 32U << 20;             // of energies
constexpr std::uint64_t chunk = 4;                           // candidates that a thread takes
constexpr std::size_t batch_members = std::size_t{4} << 20;  // primitives over all candidates

void check(const SupportTable& table, std::span<const Candidate> candidates) {
    for (std::size_t n = 0; n < candidates.size(); ++n) {
        for (const std::int32_t p : candidates[n].primitives) {
            if (p < 0 || p >= table.primitives()) {
                throw Error(ErrorKind::usage, "evaluate: candidate " + std::to_string(n) +
                                                  " names primitive " + std::to_string(p) +
                                                  ", but the table holds " +
                                                  std::to_string(table.primitives()));
            }
        }
    }
}

// What the kernels get for a batch: members of all candidates, one after the other. Primitives
// without voxels have no row worth reading.
struct Batch {
    std::vector<std::uint32_t> first{0}, row;
    std::vector<float> x, y, z;
};

Batch gather(const SupportTable::Rows& rows, std::span<const Candidate> candidates) {
    Batch batch;
    for (const Candidate& candidate : candidates) {
        for (const std::int32_t p : candidate.primitives) {
            const auto at = static_cast<std::size_t>(p);
            if (rows.vertices[at].empty()) continue;
            batch.row.push_back(static_cast<std::uint32_t>(p));
            batch.x.push_back(static_cast<float>(rows.origin[at][0] - candidate.body.center[0]));
            batch.y.push_back(static_cast<float>(rows.origin[at][1] - candidate.body.center[1]));
            batch.z.push_back(static_cast<float>(rows.origin[at][2] - candidate.body.center[2]));
        }
        batch.first.push_back(static_cast<std::uint32_t>(batch.row.size()));
    }
    return batch;
}

device::Buffer<float> landscapes(device::Device& device, const SupportTable::Rows& rows,
                                 const Batch& batch) {
    const std::size_t count = batch.first.size() - 1;
    device::Buffer<float> energy(device, std::uint64_t{count} * rows.padded, "landscapes");
    device::Buffer<std::uint32_t> first(device, std::span<const std::uint32_t>(batch.first),
                                        "group starts"),
        row(device, std::span<const std::uint32_t>(batch.row), "group members");
    device::Buffer<float> ox(device, std::span<const float>(batch.x), "member origins x"),
        oy(device, std::span<const float>(batch.y), "member origins y"),
        oz(device, std::span<const float>(batch.z), "member origins z");
    device::Queue queue(device);
    for (const SupportTable::Rows::Tile& tile : rows.tiles) {
        queue.add<kernels::GroupLandscape>(std::uint64_t{count} * tile.directions,
                                           {.s = tile.s,
                                            .dx = tile.dx,
                                            .dy = tile.dy,
                                            .dz = tile.dz,
                                            .first = first,
                                            .row = row,
                                            .ox = ox,
                                            .oy = oy,
                                            .oz = oz,
                                            .energy = energy},
                                           {.candidate_count = static_cast<std::uint32_t>(count),
                                            .tile_directions = tile.directions,
                                            .padded_directions = rows.padded,
                                            .tile_first = tile.first});
    }
    queue.run();
    return energy;
}

std::vector<std::uint32_t> descents(device::Device& device, const SupportTable::Rows& rows,
                                    const device::Buffer<float>& energy) {
    device::Buffer<std::uint32_t> down(device, energy.size(), "steepest descents");
    device::Queue queue(device);
    queue.add<kernels::SteepestDescent>(
        energy.size(), {.energy = energy, .neighbour = rows.neighbour, .down = down},
        {.candidate_count = static_cast<std::uint32_t>(energy.size() / rows.padded),
         .padded_directions = rows.padded});
    queue.run();
    return down.download();
}

void evaluate_batch(device::Device& device, const SupportTable::Rows& rows,
                    std::span<const Candidate> candidates, Passes passes,
                    std::vector<Stability>& results) {
    const Batch batch = gather(rows, candidates);
    const device::Buffer<float> energy = landscapes(device, rows, batch);
    const std::vector<float> heights = energy.download();
    std::vector<std::uint32_t> down = descents(device, rows, energy);
    const std::size_t first = results.size();
    results.resize(first + candidates.size());
    std::vector<std::exception_ptr> failure(candidates.size());  // the pool's work must not throw
    device.threads().each(candidates.size(), chunk, [&](std::size_t n) {
        if (batch.first[n] == batch.first[n + 1]) return;  // no voxels: no landscape
        try {
            const std::size_t at = n * rows.padded, size = rows.mesh.size();
            results[first + n] =
                assess(rows, candidates[n], std::span<const float>(heights).subspan(at, size),
                       std::span(down).subspan(at, size), passes);
        } catch (...) {
            failure[n] = std::current_exception();
        }
    });
    for (const std::exception_ptr& error : failure) {
        if (error) std::rethrow_exception(error);
    }
}

}  // namespace

std::vector<Stability> evaluate(device::Device& device, const SupportTable& table,
                                std::span<const Candidate> candidates, Passes passes) {
    check(table, candidates);
    const SupportTable::Rows& rows = table.rows();
    const std::size_t most =
        std::max<std::uint64_t>(1, batch_bytes / (std::uint64_t{rows.padded} * sizeof(float)));
    std::vector<Stability> results;
    results.reserve(candidates.size());
    for (std::size_t from = 0; from < candidates.size();) {
        std::size_t to = from, members = 0;
        while (to < candidates.size() && to - from < most &&
               (to == from || members + candidates[to].primitives.size() <= batch_members)) {
            members += candidates[to++].primitives.size();
        }
        evaluate_batch(device, rows, candidates.subspan(from, to - from), passes, results);
        from = to;
    }
    return results;
}

}  // namespace topple::physics

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <exception>
#include <string>

#include "core/thread_pool.h"
#include "device/queue.h"
#include "group_landscape.hpp"
#include "physics/assess.h"
#include "steepest_descent.hpp"
#include "topple/error.h"

namespace topple::physics {
namespace {

// Of energies. The native backend's stay in a cache from one step to the next.
constexpr std::uint64_t batch_bytes = 32U << 20, native_batch_bytes = 1U << 20;
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

// Energies and descents of a batch on the device, and where the host reads them.
class Landscapes {
  public:
    Landscapes(device::Device& device, const SupportTable::Rows& rows, std::size_t most)
        : device_(device),
          rows_(rows),
          energy_(device, std::uint64_t{most} * rows.padded, "landscapes"),
          down_(device, energy_.size(), "steepest descents"),
          height_(energy_.host_view()),
          descent_(down_.host_view()) {
        if (!height_.empty()) return;
        height_copy_.resize(energy_.size());
        descent_copy_.resize(energy_.size());
        height_ = height_copy_;
        descent_ = descent_copy_;
    }

    void run(const Batch& batch) {
        const auto count = static_cast<std::uint32_t>(batch.first.size() - 1);
        device::Buffer<std::uint32_t> first(device_, std::span<const std::uint32_t>(batch.first),
                                            "group starts"),
            row(device_, std::span<const std::uint32_t>(batch.row), "group members");
        device::Buffer<float> ox(device_, std::span<const float>(batch.x), "member origins x"),
            oy(device_, std::span<const float>(batch.y), "member origins y"),
            oz(device_, std::span<const float>(batch.z), "member origins z");
        device::Queue queue(device_);
        for (const SupportTable::Rows::Tile& tile : rows_.tiles) {
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
                                                .energy = energy_},
                                               {.candidate_count = count,
                                                .tile_directions = tile.directions,
                                                .padded_directions = rows_.padded,
                                                .tile_first = tile.first});
        }
        const std::uint64_t directions = std::uint64_t{count} * rows_.padded;
        queue.add<kernels::SteepestDescent>(
            directions, {.energy = energy_, .neighbour = rows_.neighbour, .down = down_},
            {.candidate_count = count, .padded_directions = rows_.padded});
        queue.run();
        if (height_copy_.empty()) return;
        energy_.download(std::span(height_copy_).first(directions));
        down_.download(std::span(descent_copy_).first(directions));
    }

    std::span<const float> height(std::size_t candidate) const {
        return height_.subspan(candidate * rows_.padded, rows_.mesh.size());
    }
    std::span<std::uint32_t> descent(std::size_t candidate) const {
        return descent_.subspan(candidate * rows_.padded, rows_.mesh.size());
    }

  private:
    device::Device& device_;
    const SupportTable::Rows& rows_;
    device::Buffer<float> energy_;
    device::Buffer<std::uint32_t> down_;
    std::vector<float> height_copy_;  // where the device's memory is not the host's
    std::vector<std::uint32_t> descent_copy_;
    std::span<float> height_;
    std::span<std::uint32_t> descent_;
};

void evaluate_batch(device::Device& device, const SupportTable::Rows& rows, Landscapes& landscapes,
                    std::span<const Candidate> candidates, Passes passes,
                    std::span<Stability> results) {
    const Batch batch = gather(rows, candidates);
    landscapes.run(batch);
    std::vector<std::exception_ptr> failure(candidates.size());  // the pool's work must not throw
    device.threads().each(candidates.size(), chunk, [&](std::size_t n) {
        if (batch.first[n] == batch.first[n + 1]) return;  // no voxels: no landscape
        try {
            results[n] =
                assess(rows, candidates[n], landscapes.height(n), landscapes.descent(n), passes);
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
    const std::uint64_t bytes = device::describe(device).backend == device::Backend::native
                                    ? native_batch_bytes
                                    : batch_bytes;
    const std::size_t most =
        std::clamp<std::size_t>(bytes / (std::uint64_t{rows.padded} * sizeof(float)), 1,
                                std::max<std::size_t>(candidates.size(), 1));
    Landscapes landscapes(device, rows, most);
    std::vector<Stability> results(candidates.size());
    for (std::size_t from = 0; from < candidates.size();) {
        std::size_t to = from, members = 0;
        while (to < candidates.size() && to - from < most &&
               (to == from || members + candidates[to].primitives.size() <= batch_members)) {
            members += candidates[to++].primitives.size();
        }
        evaluate_batch(device, rows, landscapes, candidates.subspan(from, to - from), passes,
                       std::span(results).subspan(from, to - from));
        from = to;
    }
    return results;
}

}  // namespace topple::physics

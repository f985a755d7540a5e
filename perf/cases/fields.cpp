// SPDX-License-Identifier: MIT
#include <cmath>
#include <memory>
#include <numbers>

#include "disturbance.hpp"
#include "disturbance_reach.hpp"
#include "lab/random.h"
#include "perf/cases/cases.h"

namespace topple::perf {
namespace {

// A map of 256 x 256 cells with a margin of 16, and what a body part reaches within 12 cells: 8
// walking directions, 8 height bands.
struct Map {
    static constexpr std::uint32_t side = 256, margin = 16, width = side + 2 * margin;
    static constexpr std::uint32_t cells = side * side, directions = 8, bands = 8;
    std::vector<std::uint32_t> block_start, solid, row_first{0};
    std::vector<std::int32_t> step_a;
    std::vector<std::uint32_t> entry_first{0}, entry_row;
    std::vector<std::int32_t> entry_delta;
    std::vector<float> entry_weight, primary;
    std::uint32_t rows = 0;

    Map() {
        scenes::Random random(9);
        for (std::uint32_t y = 0; y < side; ++y) {
            for (std::uint32_t x = 0; x < side; x += 64)
                block_start.push_back((y + margin) * width + margin + x);
        }
        solid.resize(width * width);
        for (std::uint32_t& s : solid)
            s = random.chance(0.03) ? static_cast<std::uint32_t>(random.integer(1, 255)) : 0u;
        primary.resize(std::size_t{directions} * width * width);
        for (float& p : primary) p = static_cast<float>(random(0, 0.1));
        std::vector<std::pair<int, int>> offsets;
        for (int dy = -12; dy <= 12; dy += 2) {
            for (int dx = -12; dx <= 12; dx += 2) {
                if (dx * dx + dy * dy <= 144) offsets.emplace_back(dx, dy);
            }
        }
        for (const auto& [dx, dy] : offsets) {
            const int steps = std::max(std::abs(dx), std::abs(dy));
            for (int s = 1; s <= steps; ++s) {
                const auto x = std::lround(static_cast<double>(dx) * s / steps),
                           y = std::lround(static_cast<double>(dy) * s / steps);
                step_a.push_back(static_cast<std::int32_t>(y * width + x));
            }
            row_first.push_back(static_cast<std::uint32_t>(step_a.size()));
        }
        rows = static_cast<std::uint32_t>(offsets.size());
        for (std::uint32_t d = 0; d < directions; ++d) {
            const double angle = 2 * std::numbers::pi * d / directions;
            for (std::uint32_t r = 0; r < rows; ++r) {
                const auto [dx, dy] = offsets[r];
                if (dx * std::cos(angle) + dy * std::sin(angle) < 0.5 * std::hypot(dx, dy))
                    continue;
                entry_row.push_back(r);
                entry_delta.push_back(dy * static_cast<int>(width) + dx);
                entry_weight.push_back(1.0f / static_cast<float>(1 + r));
            }
            entry_first.push_back(static_cast<std::uint32_t>(entry_row.size()));
        }
    }
};

struct Buffers {
    device::Buffer<std::uint32_t> block_start, solid, row_first;
    device::Buffer<std::int32_t> step;
    device::Buffer<std::uint32_t> blocked;
    device::Buffer<float> primary;
    device::Buffer<std::uint32_t> entry_first;
    device::Buffer<std::int32_t> entry_delta;
    device::Buffer<std::uint32_t> entry_row;
    device::Buffer<float> entry_weight, density;
    std::uint32_t rows;
};

std::shared_ptr<Buffers> buffers(device::Device& device, const Map& map) {
    return std::make_shared<Buffers>(
        Buffers{upload(device, map.block_start, "block_start"),
                upload(device, map.solid, "solid"),
                upload(device, map.row_first, "row_first"),
                upload(device, map.step_a, "step"),
                {device, std::uint64_t{map.rows} * Map::cells, "blocked"},
                upload(device, map.primary, "primary"),
                upload(device, map.entry_first, "entry_first"),
                upload(device, map.entry_delta, "entry_delta"),
                upload(device, map.entry_row, "entry_row"),
                upload(device, map.entry_weight, "entry_weight"),
                {device, std::uint64_t{Map::directions} * Map::bands * Map::cells, "density"},
                map.rows});
}

void enqueue_reach(device::Queue& queue, const Buffers& on) {
    queue.add<kernels::DisturbanceReach>(std::uint64_t{on.rows} * Map::cells,
                                         {.block_start = on.block_start,
                                          .solid = on.solid,
                                          .row_first = on.row_first,
                                          .step_a = on.step,
                                          .step_b = on.step,
                                          .blocked = on.blocked},
                                         {.cell_count = Map::cells, .row_count = on.rows});
}

}  // namespace

Prepared disturbance_reach(device::Device& device) {
    const Map map;
    auto on = buffers(device, map);
    const double steps = static_cast<double>(map.step_a.size()) * Map::cells;
    return {
        {steps, "steps",
         4.0 * (static_cast<double>(map.rows) * Map::cells + Map::width * Map::width), 2 * steps},
        [on](device::Queue& queue) { enqueue_reach(queue, *on); },
        {},
        [on] { return Hash().add(on->blocked.download()).value(); }};
}

Prepared disturbance(device::Device& device) {
    const Map map;
    auto on = buffers(device, map);
    device::Queue first(device);
    enqueue_reach(first, *on);
    first.run();
    const double sums = static_cast<double>(map.entry_row.size()) * Map::bands * Map::cells;
    // A product shared by four bands; for each a shift's share, a test, a choice and a sum.
    return {{sums, "band entries",
             4.0 * (static_cast<double>(map.rows) * Map::cells +
                    static_cast<double>(map.primary.size()) +
                    static_cast<double>(Map::directions) * Map::bands * Map::cells),
             3.5 * sums},
            [on](device::Queue& queue) {
                queue.add<kernels::Disturbance>(
                    std::uint64_t{Map::directions} * (Map::bands / 4) * Map::cells,
                    {.block_start = on->block_start,
                     .primary = on->primary,
                     .blocked = on->blocked,
                     .entry_first = on->entry_first,
                     .entry_delta = on->entry_delta,
                     .entry_row = on->entry_row,
                     .entry_weight = on->entry_weight,
                     .density = on->density},
                    {.cell_count = Map::cells,
                     .row_count = on->rows,
                     .plane_cells = Map::width * Map::width,
                     .direction_count = Map::directions,
                     .footprint_first = 0,
                     .band_first = 0,
                     .band_count = Map::bands,
                     .output_first = 0});
            },
            {},
            [on] { return Hash().add(on->density.download()).value(); }};
}

}  // namespace topple::perf

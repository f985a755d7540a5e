// SPDX-License-Identifier: MIT
#include "points/frames_fusion.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/short_number.h"
#include "points/frames_cells.h"
#include "topple/error.h"

namespace topple::geometry {

namespace {

// Sums that wait for their tables: of many frames at a time, since most of them look at the same
// cells, and a table's memory is far from one frame to the next.
constexpr std::size_t most_waiting = std::size_t{1} << 20;

void check(const Intrinsics& k, double cell_m) {
    const auto positive = [](double v) { return std::isfinite(v) && v > 0; };
    if (!positive(cell_m)) {
        throw Error(ErrorKind::usage,
                    "fusion cell of " + short_number(cell_m) + " m: it must be positive");
    }
    if (!positive(k.fx) || !positive(k.fy) || !positive(k.depth_scale) || !std::isfinite(k.cx) ||
        !std::isfinite(k.cy)) {
        throw Error(ErrorKind::input,
                    "intrinsics: fx, fy and depth_scale must be positive, cx and cy finite");
    }
}

void check(const DepthFrame& frame, const Intrinsics& k, std::size_t number) {
    const auto refuse = [&](const std::string& why) {
        throw Error(ErrorKind::input, "depth frame " + std::to_string(number) + ": " + why);
    };
    if (frame.depth.size() != std::size_t{k.width} * k.height) {
        refuse(std::to_string(frame.depth.size()) + " pixels, the intrinsics say " +
               std::to_string(k.width) + " x " + std::to_string(k.height));
    }
    if (!frame.rgb.empty() && frame.rgb.size() != 3 * frame.depth.size()) {
        refuse(std::to_string(frame.rgb.size()) + " bytes of colour, where each of its " +
               std::to_string(frame.depth.size()) + " pixels takes 3");
    }
    if (!std::ranges::all_of(frame.camera_to_world, [](double v) { return std::isfinite(v); }))
        refuse("its pose is not finite; leave the frame out");
}

}  // namespace

FrameFusion::FrameFusion(const Intrinsics& intrinsics, double cell_m, unsigned threads)
    : intrinsics_(intrinsics), cell_m_(cell_m) {
    check(intrinsics, cell_m);
    cells_ = std::make_unique<Cells>(intrinsics, cell_m, threads);
}
FrameFusion::~FrameFusion() = default;
FrameFusion::FrameFusion(FrameFusion&&) noexcept = default;

void FrameFusion::add(const DepthFrame& frame) {
    const Intrinsics& k = intrinsics_;
    Cells& c = *cells_;
    check(frame, k, c.viewpoints.size());
    const auto number = static_cast<std::uint32_t>(c.viewpoints.size());
    const Mat4& m = frame.camera_to_world;
    c.viewpoints.push_back({m[3], m[7], m[11]});

    c.witnesses.add(frame);
    const auto add_rows = [&](std::uint64_t block) {
        const auto first = static_cast<std::uint32_t>(block * k.height / Cells::block_count);
        const auto last = static_cast<std::uint32_t>((block + 1) * k.height / Cells::block_count);
        RowReadings row(k.width);
        NeighbourSums neighbours(k.width);
        for (std::uint32_t v = first; v < last; ++v) {
            c.projection.row(frame, v, row);
            const std::uint8_t* rgb =
                frame.rgb.empty() ? nullptr : frame.rgb.data() + std::size_t{3} * v * k.width;
            neighbours.add(row, rgb, number, c.waiting[block], c.outside[block]);
        }
    };
    // A pool without threads of its own hands out all blocks at once.
    c.pool.run(Cells::block_count, 1, [&](std::uint64_t begin, std::uint64_t end) {
        for (std::uint64_t block = begin; block < end; ++block) add_rows(block);
    });
    std::size_t waiting = 0;
    for (const std::vector<CellSums>& block : c.waiting) waiting += block.size();
    if (waiting >= most_waiting) c.flush();
}

std::size_t FrameFusion::bytes() const {
    return cells_->tables.bytes();
}

void FrameFusion::set_most_bytes(std::size_t most_bytes) {
    cells_->most_bytes = most_bytes;
}

void FrameFusion::flush() {
    cells_->flush();
}

void FrameFusion::Cells::flush() {
    tables.add(std::vector<std::span<const CellSums>>(waiting.begin(), waiting.end()), pool,
               most_bytes);
    for (std::vector<CellSums>& block : waiting) block.clear();
}

FusedCloud FrameFusion::finish(const std::function<void()>& poll) {
    cells_->flush();
    cells_->waiting = {};
    FusedCells fused(std::move(cells_->tables), cell_m_, cells_->pool);
    poll();
    drop_strays(fused, cells_->viewpoints.size(), cells_->pool);
    poll();
    drop_denied(fused, cells_->witnesses, cells_->pool);
    poll();
    // Twice: a first plane through the outer layers leans towards them, since half of the surface's
    // readings lie beyond its reach. Where the noise stays within a cell there are no such layers.
    flatten_layers(fused, 0, cells_->pool);
    poll();
    flatten_layers(fused, 0.5 * cell_m_, cells_->pool);
    poll();

    FusedCloud result;
    result.viewpoints = std::move(cells_->viewpoints);
    for (const std::uint64_t count : cells_->outside) result.cloud.dropped += count;
    const bool coloured = std::ranges::any_of(
        fused.cells, [](const CellSums* cell) { return cell->colour_weight > 0; });
    for (std::size_t n = 0; n < fused.cells.size(); ++n) {
        const CellSums& cell = cell_at(fused.cells, n);
        if (coloured) {
            const auto mean = [&](std::size_t channel) {
                const std::uint64_t weight = std::max(cell.colour_weight, 1u);
                return static_cast<std::uint8_t>((cell.colour[channel] + weight / 2) / weight);
            };
            result.cloud.red.push_back(mean(0));
            result.cloud.green.push_back(mean(1));
            result.cloud.blue.push_back(mean(2));
        }
        const auto at = [&](std::size_t axis) {
            const std::int64_t index = index_in(cell.key, axis) - key_bias;
            // Half a unit: fractions were cut off, not rounded.
            const double fraction = (mean_offset(cell, axis) + 0.5) / cell_parts;
            return static_cast<float>((static_cast<double>(index) + fraction) * cell_m_);
        };
        result.cloud.x.push_back(at(0));
        result.cloud.y.push_back(at(1));
        result.cloud.z.push_back(at(2));
        result.viewpoint_of_point.push_back(cell.best_frame);
    }
    return result;
}

}  // namespace topple::geometry

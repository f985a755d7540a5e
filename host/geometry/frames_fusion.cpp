// SPDX-License-Identifier: MIT
#include "geometry/frames_fusion.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/depth_noise.h"
#include "geometry/frames_cells.h"
#include "topple/error.h"

namespace topple::geometry {

namespace {

// Sums of readings that wait for their tables: of some frames at a time, since a table's memory is
// far from one frame to the next.
constexpr std::size_t batch_runs = std::size_t{1} << 20;

// Beyond this angle between the ray and the surface's normal, neighbouring readings say little
// about each other, and a jump counts as one between two surfaces.
constexpr double grazing_tangent = 7.1;  // tan 82 degrees

void check(const Intrinsics& k, double cell_m) {
    const auto positive = [](double v) { return std::isfinite(v) && v > 0; };
    if (!positive(cell_m)) {
        throw Error(ErrorKind::usage,
                    "fusion cell of " + std::to_string(cell_m) + " m: it must be positive");
    }
    if (!positive(k.fx) || !positive(k.fy) || !positive(k.depth_scale) || !std::isfinite(k.cx) ||
        !std::isfinite(k.cy)) {
        throw Error(ErrorKind::input,
                    "intrinsics: fx, fy and depth_scale must be positive, cx and cy finite");
    }
}

void check(const DepthFrame& frame, const Intrinsics& k, std::size_t number) {
    if (frame.depth.size() != std::size_t{k.width} * k.height) {
        throw Error(ErrorKind::input, "depth frame " + std::to_string(number) + ": " +
                                          std::to_string(frame.depth.size()) +
                                          " pixels, the intrinsics say " + std::to_string(k.width) +
                                          " x " + std::to_string(k.height));
    }
    if (!frame.rgb.empty() && frame.rgb.size() != 3 * frame.depth.size()) {
        throw Error(ErrorKind::input, "depth frame " + std::to_string(number) + ": " +
                                          std::to_string(frame.rgb.size()) +
                                          " bytes of colour, where each of its " +
                                          std::to_string(frame.depth.size()) + " pixels takes 3");
    }
    for (const double v : frame.camera_to_world) {
        if (!std::isfinite(v)) {
            throw Error(ErrorKind::input, "depth frame " + std::to_string(number) +
                                              ": its pose is not finite; leave the frame out");
        }
    }
}

// Cells, and 65536ths of one, from the grid's lowest corner.
struct CellPoint {
    std::array<std::uint64_t, 3> cell{};
    std::array<std::uint32_t, 3> part{};
};

// Back-projects one frame, some pixels of a row at a time. Lengths in cells.
class Strip {
  public:
    static constexpr std::uint32_t width = 32;  // pixels

    // columns: of each, how far ahead it is a metre away.
    Strip(const Intrinsics& k, const DepthFrame& frame, double cell_m,
          std::span<const DepthReading> by_depth, std::span<const double> columns)
        : k_(k), frame_(frame), by_depth_(by_depth), columns_(columns), per_cell_(1 / cell_m) {}

    // Calls visit(u, point, weight) for each of the pixels [first, last) of row v that has a
    // reading on a surface; the point is null where it is beyond the grid's reach.
    template <class Visit>
    void read(std::uint32_t v, std::uint32_t first, std::uint32_t last, const Visit& visit) {
        const std::size_t count = last - first;
        const std::array<std::uint32_t, width> kept = look(v, first, count);
        const Mat4& m = frame_.camera_to_world;
        const double dy = (v - k_.cy) / k_.fy;
        for (std::size_t n = 0; n < count; ++n) {
            if (kept[n] == 0) continue;
            const auto u = first + static_cast<std::uint32_t>(n);
            const double z = static_cast<double>(depth_[n]) / k_.depth_scale, dx = columns_[u];
            CellPoint point;
            bool inside = true;
            for (std::size_t a = 0; a < 3; ++a) {
                const double* row = &m[4 * a];
                constexpr auto bias = static_cast<double>(key_bias);
                const double at =
                    ((row[0] * dx + row[1] * dy + row[2]) * z + row[3]) * per_cell_ + bias;
                inside = inside && at >= 1 && at < 2 * bias - 1;
                if (!inside) break;
                const auto fixed = static_cast<std::uint64_t>(at * 65536);
                point.cell[a] = fixed >> 16;
                point.part[a] = static_cast<std::uint32_t>(fixed & 0xFFFF);
            }
            visit(u, inside ? &point : nullptr, weight_[n]);
        }
    }

  private:
    // Fills in depths and their weights, and tells which are to be kept. A reading between two
    // surfaces lies on neither: along a row or a column, both neighbours are too far off in depth.
    // Missing neighbours don't support it either.
    std::array<std::uint32_t, width> look(std::uint32_t v, std::uint32_t first, std::size_t count) {
        const std::uint16_t* row = frame_.depth.data() + std::size_t{v} * k_.width;
        std::array<float, width + 2> own{};
        std::array<float, width> above{}, below{}, limit{};
        for (std::size_t n = 0; n < count; ++n) {
            const std::uint16_t stored = row[first + n];
            own[n + 1] = stored;
            limit[n] = by_depth_[stored].largest_jump;
            weight_[n] = by_depth_[stored].weight;
        }
        if (first > 0) own[0] = row[first - 1];
        if (first + count < k_.width) own[count + 1] = row[first + count];
        for (std::size_t n = 0; v > 0 && n < count; ++n) above[n] = *(row + first + n - k_.width);
        for (std::size_t n = 0; v + 1 < k_.height && n < count; ++n)
            below[n] = row[first + n + k_.width];
        std::array<std::uint32_t, width> kept{};
        for (std::size_t n = 0; n < width; ++n) {
            const float depth = own[n + 1], most = limit[n];
            const auto far = [&](float other) {
                return (other == 0) | (std::fabs(other - depth) > most);
            };
            const bool between = (far(own[n]) & far(own[n + 2])) | (far(above[n]) & far(below[n]));
            kept[n] = (depth > 0) & !between;
            depth_[n] = depth;
        }
        return kept;
    }

    const Intrinsics& k_;
    const DepthFrame& frame_;
    std::span<const DepthReading> by_depth_;
    std::span<const double> columns_;
    double per_cell_ = 0;
    std::array<float, width> depth_{};
    std::array<std::uint32_t, width> weight_{};
};

// Sums up the readings of a patch of the image, which mostly fall into few cells, before they go to
// the tables: a slot for each cell, or for the last one of several that share it.
class PatchSums {
  public:
    PatchSums(std::vector<CellSums>& runs, std::uint32_t frame) : runs_(runs), frame_(frame) {}

    // rgb: of the pixel, or null.
    void add(const CellPoint& at, std::uint32_t weight, const std::uint8_t* rgb) {
        const auto [x, y, z] = at.cell;
        const std::uint64_t key = x << 42 | y << 21 | z;
        CellSums& sums = slots_[(x & 7) << 6 | (y & 7) << 3 | (z & 7)];
        if (sums.count == 0 || sums.key != key) {
            if (sums.count == 0)
                used_[used_count_++] = &sums;
            else
                put(sums);
            sums = CellSums{};
            sums.key = key;
            sums.best_frame = frame_;
        }
        for (std::size_t a = 0; a < 3; ++a) sums.offset[a] += std::uint64_t{weight} * at.part[a];
        sums.weight += weight;
        sums.best_weight = std::max(sums.best_weight, weight);
        ++sums.count;
        if (rgb && (rgb[0] | rgb[1] | rgb[2]) != 0) {
            const std::uint32_t w = (weight + 255) >> 8;
            sums.add_colour({w * rgb[0], w * rgb[1], w * rgb[2]}, w);
        }
    }
    void flush() {
        for (std::size_t k = 0; k < used_count_; ++k) {
            put(*used_[k]);
            used_[k]->count = 0;
        }
        used_count_ = 0;
    }

  private:
    void put(const CellSums& sums) { runs_.push_back(sums); }
    std::vector<CellSums>& runs_;
    std::uint32_t frame_;
    std::array<CellSums, 512> slots_{};
    std::array<CellSums*, 512> used_{};
    std::size_t used_count_ = 0;
};

}  // namespace

FrameFusion::FrameFusion(const Intrinsics& intrinsics, double cell_m, unsigned threads)
    : cells_(std::make_unique<Cells>(intrinsics, threads)),
      intrinsics_(intrinsics),
      cell_m_(cell_m) {
    check(intrinsics, cell_m);
    // One entry per stored depth: what depends on depth alone.
    for (std::uint32_t u = 0; u < intrinsics.width; ++u)
        cells_->columns.push_back((u - intrinsics.cx) / intrinsics.fx);
    cells_->by_depth.resize(65536);
    const double focal = std::min(intrinsics.fx, intrinsics.fy);
    for (std::size_t stored = 1; stored < 65536; ++stored) {
        const double z = static_cast<double>(stored) / intrinsics.depth_scale;
        const double sigma = depth_sigma(z), ratio = least_depth_sigma / sigma;
        cells_->by_depth[stored] = {
            static_cast<float>(intrinsics.depth_scale *
                               (3 * std::sqrt(2.0) * sigma + z * grazing_tangent / focal)),
            std::max(1u, static_cast<std::uint32_t>(std::lround(65535 * ratio * ratio)))};
    }
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
        PatchSums patch(c.runs[block], number);
        Strip strip(k, frame, cell_m_, c.by_depth, c.columns);
        for (std::uint32_t u0 = 0; u0 < k.width; u0 += Strip::width) {
            const std::uint32_t u1 = std::min(k.width, u0 + Strip::width);
            for (std::uint32_t v = first; v < last; ++v) {
                const std::uint8_t* rgb =
                    frame.rgb.empty() ? nullptr : frame.rgb.data() + std::size_t{3} * v * k.width;
                strip.read(v, u0, u1,
                           [&](std::uint32_t u, const CellPoint* at, std::uint32_t weight) {
                               if (at)
                                   patch.add(*at, weight, rgb ? rgb + std::size_t{3} * u : nullptr);
                               else
                                   ++c.outside[block];
                           });
            }
            patch.flush();
        }
    };
    // A pool without threads of its own hands out all blocks at once.
    c.pool.run(Cells::block_count, 1, [&](std::uint64_t begin, std::uint64_t end) {
        for (std::uint64_t block = begin; block < end; ++block) add_rows(block);
    });
    std::size_t waiting = 0;
    for (const auto& block : c.runs) waiting += block.size();
    if (waiting >= batch_runs) c.flush();
}

void FrameFusion::Cells::flush() {
    const std::vector<std::span<const CellSums>> parts(runs.begin(), runs.end());
    tables.add(parts, pool);
    for (auto& block : runs) block.clear();
}

FusedCloud FrameFusion::finish(const std::function<void()>& poll) {
    FusedCells fused;
    fused.cell_m = cell_m_;
    cells_->flush();
    fused.cells = cells_->tables.sorted(cells_->pool);
    cells_->tables = {};
    cells_->runs = {};
    poll();
    drop_weak(fused, cells_->viewpoints.size(), cells_->pool);
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
        fused.cells, [](const CellSums& cell) { return cell.colour_weight > 0; });
    for (const CellSums& cell : fused.cells) {
        if (coloured) {
            const auto mean = [&](std::size_t channel) {
                const std::uint64_t weight = std::max(cell.colour_weight, 1u);
                return static_cast<std::uint8_t>((cell.colour[channel] + weight / 2) / weight);
            };
            result.cloud.red.push_back(mean(0));
            result.cloud.green.push_back(mean(1));
            result.cloud.blue.push_back(mean(2));
        }
        const auto at = [&](unsigned shift, std::size_t axis) {
            const auto index = static_cast<std::int64_t>(cell.key >> shift & 0x1FFFFF) - key_bias;
            // Half a unit: fractions were cut off, not rounded.
            const double fraction =
                (static_cast<double>(cell.offset[axis]) / static_cast<double>(cell.weight) + 0.5) /
                65536;
            return static_cast<float>((static_cast<double>(index) + fraction) * cell_m_);
        };
        result.cloud.x.push_back(at(42, 0));
        result.cloud.y.push_back(at(21, 1));
        result.cloud.z.push_back(at(0, 2));
        result.viewpoint_of_point.push_back(cell.best_frame);
    }
    return result;
}

}  // namespace topple::geometry

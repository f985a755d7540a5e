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

// A reading between two surfaces lies on neither: along a row or a column, both neighbours are too
// far off in depth. Missing neighbours don't support it either.
bool flying(const std::uint16_t* depth, std::uint32_t u, std::uint32_t v, const Intrinsics& k,
            float limit) {
    const auto far = [&](std::uint32_t other) {
        return other == 0 ||
               std::abs(static_cast<float>(other) - static_cast<float>(*depth)) > limit;
    };
    const std::size_t w = k.width;
    const bool left = u == 0 || far(depth[-1]), right = u + 1 == w || far(depth[1]);
    const bool up = v == 0 || far(*(depth - w)), down = v + 1 == k.height || far(depth[w]);
    return (left && right) || (up && down);
}

// Sums up the readings of a patch of the image, which mostly fall into few cells, before they go to
// the tables: a slot for each cell, or for the last one of several that share it.
class PatchSums {
  public:
    static constexpr std::uint32_t width = 32;  // pixels
    PatchSums(std::array<std::vector<CellSums>, CellTables::shard_count>& runs, std::uint32_t frame)
        : runs_(runs), frame_(frame) {}

    // p: in cells, from the grid's lowest corner; positive. rgb: of the pixel, or null.
    void add(const std::array<double, 3>& p, std::uint32_t weight, const std::uint8_t* rgb) {
        std::array<std::uint64_t, 3> fixed{};
        for (std::size_t a = 0; a < 3; ++a) fixed[a] = static_cast<std::uint64_t>(p[a] * 65536);
        const std::uint64_t x = fixed[0] >> 16, y = fixed[1] >> 16, z = fixed[2] >> 16;
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
        for (std::size_t a = 0; a < 3; ++a) sums.offset[a] += weight * (fixed[a] & 0xFFFF);
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
    void put(const CellSums& sums) { runs_[CellTables::shard_of(sums.key)].push_back(sums); }
    std::array<std::vector<CellSums>, CellTables::shard_count>& runs_;
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
    cells_->sigma_limit.resize(65536);
    cells_->weight.resize(65536);
    const double focal = std::min(intrinsics.fx, intrinsics.fy);
    for (std::size_t stored = 1; stored < 65536; ++stored) {
        const double z = static_cast<double>(stored) / intrinsics.depth_scale;
        const double sigma = depth_sigma(z), ratio = least_depth_sigma / sigma;
        cells_->sigma_limit[stored] = static_cast<float>(
            intrinsics.depth_scale * (3 * std::sqrt(2.0) * sigma + z * grazing_tangent / focal));
        cells_->weight[stored] =
            std::max(1u, static_cast<std::uint32_t>(std::lround(65535 * ratio * ratio)));
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
    const double per_cell = 1 / cell_m_;

    c.witnesses.add(frame);
    const auto add_rows = [&](std::uint64_t block) {
        auto& runs = c.runs[block];
        for (auto& list : runs) list.clear();
        const auto first = static_cast<std::uint32_t>(block * k.height / Cells::block_count);
        const auto last = static_cast<std::uint32_t>((block + 1) * k.height / Cells::block_count);
        PatchSums patch(runs, number);
        for (std::uint32_t u0 = 0; u0 < k.width; u0 += PatchSums::width) {
            const std::uint32_t u1 = std::min(k.width, u0 + PatchSums::width);
            for (std::uint32_t v = first; v < last; ++v) {
                const double dy = (v - k.cy) / k.fy;
                const std::uint16_t* row = frame.depth.data() + std::size_t{v} * k.width;
                const std::uint8_t* rgb =
                    frame.rgb.empty() ? nullptr : frame.rgb.data() + std::size_t{3} * v * k.width;
                for (std::uint32_t u = u0; u < u1; ++u) {
                    const std::uint16_t stored = row[u];
                    if (stored == 0 || flying(row + u, u, v, k, c.sigma_limit[stored])) continue;
                    const double z = stored / k.depth_scale, dx = (u - k.cx) / k.fx;
                    constexpr auto bias = static_cast<double>(key_bias);
                    const std::array<double, 3> p{
                        ((m[0] * dx + m[1] * dy + m[2]) * z + m[3]) * per_cell + bias,
                        ((m[4] * dx + m[5] * dy + m[6]) * z + m[7]) * per_cell + bias,
                        ((m[8] * dx + m[9] * dy + m[10]) * z + m[11]) * per_cell + bias};
                    if (p[0] >= 1 && p[1] >= 1 && p[2] >= 1 && p[0] < 2 * bias - 1 &&
                        p[1] < 2 * bias - 1 && p[2] < 2 * bias - 1) {
                        patch.add(p, c.weight[stored], rgb ? rgb + std::size_t{3} * u : nullptr);
                    } else {
                        ++c.outside[block];
                    }
                }
            }
            patch.flush();
        }
    };
    // A pool without threads of its own hands out all blocks at once.
    c.pool.run(Cells::block_count, 1, [&](std::uint64_t begin, std::uint64_t end) {
        for (std::uint64_t block = begin; block < end; ++block) add_rows(block);
    });
    c.tables.for_each_shard(c.pool, [&](std::size_t shard, CellTable& table) {
        for (const auto& block : c.runs) table.add(block[shard]);
    });
}

FusedCloud FrameFusion::finish(const std::function<void()>& poll) {
    FusedCells fused;
    fused.cell_m = cell_m_;
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

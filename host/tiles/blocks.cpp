// SPDX-License-Identifier: MIT
#include "tiles/blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "tiles/binary_file.h"

namespace topple::tiles {
namespace {

namespace fs = std::filesystem;

// A block with fewer cells in its core shows no surface: scraps of what lies in the next.
constexpr std::uint64_t least_cells = 64;

double height_of(const geometry::SceneFrame& frame, float x, float y, float z) {
    const Vec3& up = frame.axes[2];
    return up[0] * x + up[1] * y + up[2] * z;
}

// Surface by height, over all bins.
std::vector<Storey> storeys_of(const fs::path& folder, std::span<const Bin> bins,
                               const geometry::SceneFrame& frame, double cell_m, double step_m) {
    std::map<std::int64_t, std::uint64_t> cells;  // by step
    for (const Bin& bin : bins) {
        const ThinnedBin points = read_thinned(folder, bin);
        for (std::size_t n = 0; n < points.size(); ++n)
            ++cells[static_cast<std::int64_t>(
                std::floor(height_of(frame, points.x[n], points.y[n], points.z[n]) / step_m))];
    }
    if (cells.empty()) return find_storeys({}, 0, step_m);
    const std::int64_t first = cells.begin()->first, last = cells.rbegin()->first;
    // Strays may lie far above; no building is higher than a kilometre.
    const auto steps =
        std::min<std::int64_t>(last - first + 1, static_cast<std::int64_t>(1000 / step_m));
    std::vector<double> area(static_cast<std::size_t>(steps), 0.0);
    for (const auto& [step, count] : cells) {
        if (step - first < steps)
            area[static_cast<std::size_t>(step - first)] =
                static_cast<double>(count) * cell_m * cell_m;
    }
    return find_storeys(area, static_cast<double>(first) * step_m, step_m);
}

std::int32_t floored(std::int32_t value, std::int32_t step) {
    const std::int32_t rest = value % step;
    return value - (rest < 0 ? rest + step : rest);
}

}  // namespace

std::array<std::int32_t, 3> voxel_at(const geometry::SceneFrame& frame, double voxel_m, float x,
                                     float y, float z) {
    std::array<std::int32_t, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) {
        const Vec3& axis = frame.axes[a];
        at[a] = static_cast<std::int32_t>(
            std::floor((axis[0] * x + axis[1] * y + axis[2] * z) / voxel_m));
    }
    return at;
}

Layout cut_into_blocks(const fs::path& folder, std::span<const Bin> bins,
                       const geometry::SceneFrame& frame, double cell_m, double voxel_m,
                       double block_m) {
    constexpr std::int32_t leaf = 8;
    constexpr std::int32_t far = 1 << 26;  // beyond all voxels, with room for a halo
    Layout out{cell_m, voxel_m, 0, frame, {}};
    out.halo = leaf * static_cast<std::int32_t>(std::ceil(halo_m / (leaf * voxel_m) - 1e-9));
    const auto edge =
        leaf * std::max(1, static_cast<std::int32_t>(std::lround(block_m / (leaf * voxel_m))));
    const std::vector<Storey> storeys = storeys_of(folder, bins, frame, cell_m, voxel_m);
    std::vector<std::int32_t> begins;  // of each storey, voxels
    for (const Storey& s : storeys)
        begins.push_back(
            std::isinf(s.below_m)
                ? -far
                : floored(static_cast<std::int32_t>(std::lround(s.below_m / voxel_m)), leaf));
    std::map<std::array<std::int32_t, 3>, std::uint64_t> cells;  // by storey, i, j
    for (const Bin& bin : bins) {
        const ThinnedBin points = read_thinned(folder, bin);
        for (std::size_t n = 0; n < points.size(); ++n) {
            const auto at = voxel_at(frame, voxel_m, points.x[n], points.y[n], points.z[n]);
            const auto storey = std::ranges::upper_bound(begins, at[2]) - begins.begin() - 1;
            ++cells[{static_cast<std::int32_t>(storey), floored(at[0], edge),
                     floored(at[1], edge)}];
        }
    }
    for (const auto& [at, count] : cells) {
        if (count < least_cells) continue;
        const auto storey = static_cast<std::size_t>(at[0]);
        Block block;
        block.core.low = {at[1], at[2], begins[storey]};
        block.core.high = {at[1] + edge, at[2] + edge,
                           storey + 1 < begins.size() ? begins[storey + 1] : far};
        block.floor_m = storeys[storey].floor_m;
        block.top_m = storey + 1 < storeys.size() ? storeys[storey + 1].below_m
                                                  : std::numeric_limits<double>::infinity();
        block.cells = count;
        out.blocks.push_back(block);
    }
    return out;
}

void write_layout(const fs::path& folder, const Layout& layout) {
    BinaryWriter out(folder / layout_name);
    out.value(layout.cell_m);
    out.value(layout.voxel_m);
    out.value(layout.halo);
    out.value(layout.frame.axes);
    out.value(layout.frame.found);
    for (const std::string* text : {&layout.frame.up_method, &layout.frame.note})
        out.array(std::vector<char>(text->begin(), text->end()));
    out.array(layout.blocks);
    out.finish();
}

Layout read_layout(const fs::path& folder) {
    BinaryReader in(folder / layout_name);
    Layout out;
    out.cell_m = in.value<double>();
    out.voxel_m = in.value<double>();
    out.halo = in.value<std::int32_t>();
    out.frame.axes = in.value<std::array<Vec3, 3>>();
    out.frame.found = in.value<bool>();
    for (std::string* text : {&out.frame.up_method, &out.frame.note}) {
        const std::vector<char> characters = in.array<char>();
        text->assign(characters.begin(), characters.end());
    }
    out.blocks = in.array<Block>();
    return out;
}

BlockPoints points_of_block(const fs::path& folder, std::span<const Bin> bins, const Layout& layout,
                            const Block& block) {
    const VoxelBox seen = block.core.grown(layout.halo);
    BlockPoints out;
    for (std::size_t b = 0; b < bins.size(); ++b) {
        // The bin's cube in voxels: its centre, and how far it reaches along each axis.
        bool meets = true;
        for (std::size_t a = 0; a < 3; ++a) {
            const Vec3& axis = layout.frame.axes[a];
            double middle = 0, reach = 0;
            for (std::size_t c = 0; c < 3; ++c) {
                middle += axis[c] * (bins[b][c] + 0.5) * bin_edge_m;
                reach += std::abs(axis[c]) * 0.5 * bin_edge_m;
            }
            meets = meets && (middle - reach) / layout.voxel_m < seen.high[a] &&
                    (middle + reach) / layout.voxel_m >= seen.low[a];
        }
        if (!meets) continue;
        const ThinnedBin points = read_thinned(folder, bins[b]);
        BlockPoints::Part part{b, {}, {}};
        for (std::size_t n = 0; n < points.size(); ++n) {
            const auto at =
                voxel_at(layout.frame, layout.voxel_m, points.x[n], points.y[n], points.z[n]);
            if (!seen.holds(at[0], at[1], at[2])) continue;
            out.cloud.x.push_back(points.x[n]);
            out.cloud.y.push_back(points.y[n]);
            out.cloud.z.push_back(points.z[n]);
            part.cells.push_back(static_cast<std::uint32_t>(n));
            part.in_core.push_back(block.core.holds(at[0], at[1], at[2]));
        }
        if (!part.cells.empty()) out.parts.push_back(std::move(part));
    }
    return out;
}

}  // namespace topple::tiles

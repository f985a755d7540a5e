// SPDX-License-Identifier: MIT
#include "tiles/blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "geometry/storeys.h"
#include "tiles/binary_file.h"

namespace topple::tiles {
namespace {

namespace fs = std::filesystem;

// A block with fewer cells in its core shows no surface: the rim of what lies in the next.
constexpr std::uint64_t least_cells = 64;

double height_of(const geometry::SceneFrame& frame, float x, float y, float z) {
    const Vec3& up = frame.axes[2];
    return up[0] * x + up[1] * y + up[2] * z;
}

// Surface by height, over all bins.
std::vector<geometry::Storey> storeys_of(const fs::path& folder, std::span<const Bin> bins,
                                         const geometry::SceneFrame& frame, double cell_m,
                                         double step_m) {
    std::map<std::int64_t, std::uint64_t> cells;  // by step
    for (const Bin& bin : bins) {
        const ThinnedBin points = read_thinned(folder, bin);
        for (std::size_t n = 0; n < points.size(); ++n)
            ++cells[static_cast<std::int64_t>(
                std::floor(height_of(frame, points.x[n], points.y[n], points.z[n]) / step_m))];
    }
    if (cells.empty()) return geometry::find_storeys({}, 0, step_m);
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
    return geometry::find_storeys(area, static_cast<double>(first) * step_m, step_m);
}

constexpr std::int32_t leaf = 8;

// In voxels.
std::int32_t block_edge(double voxel_m) {
    return leaf *
           std::max(1, static_cast<std::int32_t>(std::lround(block_edge_m / (leaf * voxel_m))));
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
                       const geometry::SceneFrame& frame, double cell_m, double voxel_m) {
    constexpr std::int32_t far = 1 << 26;  // beyond all voxels, with room for a halo
    Layout out{cell_m, voxel_m, 0, frame, {}};
    out.halo = leaf * static_cast<std::int32_t>(std::ceil(halo_m / (leaf * voxel_m) - 1e-9));
    const std::int32_t edge = block_edge(voxel_m);
    const std::vector<geometry::Storey> storeys = storeys_of(folder, bins, frame, cell_m, voxel_m);
    std::vector<std::int32_t> begins;  // of each storey, voxels
    for (const geometry::Storey& s : storeys)
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

namespace {

template <class Io, class Of>
void layout_fields(Io& io, Of& layout) {
    io(layout.cell_m);
    io(layout.voxel_m);
    io(layout.halo);
    io(layout.frame.axes);
    io(layout.frame.found);
    io(layout.frame.up_method);
    io(layout.frame.note);
    io(layout.blocks);
}

}  // namespace

void write_layout(const fs::path& folder, const Layout& layout) {
    BinaryWriter out(folder / layout_name);
    layout_fields(out, layout);
    out.finish();
}

Layout read_layout(const fs::path& folder) {
    BinaryReader in(folder / layout_name);
    Layout out;
    layout_fields(in, out);
    return out;
}

TileReader::TileReader(const fs::path& folder, std::span<const Bin> bins, const Layout& layout,
                       std::span<const std::size_t> blocks)
    : folder_(folder), bins_(bins), layout_(layout), blocks_(blocks) {}

bool TileReader::sees(std::size_t block, std::size_t bin) const {
    const VoxelBox seen = layout_.blocks[block].core.grown(layout_.halo);
    // The bin's cube in voxels: its centre, and how far it reaches along each axis.
    for (std::size_t a = 0; a < 3; ++a) {
        const Vec3& axis = layout_.frame.axes[a];
        double middle = 0, reach = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            middle += axis[c] * (bins_[bin][c] + 0.5) * bin_edge_m;
            reach += std::abs(axis[c]) * 0.5 * bin_edge_m;
        }
        if ((middle - reach) / layout_.voxel_m >= seen.high[a] ||
            (middle + reach) / layout_.voxel_m < seen.low[a])
            return false;
    }
    return true;
}

BlockPoints TileReader::next() {
    const std::size_t number = blocks_[next_++];
    const Block& block = layout_.blocks[number];
    const VoxelBox seen = block.core.grown(layout_.halo);
    BlockPoints out;
    for (std::size_t b = 0; b < bins_.size(); ++b) {
        if (!sees(number, b)) continue;
        auto at = held_.find(b);
        if (at == held_.end()) at = held_.emplace(b, read_thinned(folder_, bins_[b])).first;
        const ThinnedBin& points = at->second;
        BlockPoints::Part part{b, {}, {}};
        for (std::size_t n = 0; n < points.size(); ++n) {
            const auto cell =
                voxel_at(layout_.frame, layout_.voxel_m, points.x[n], points.y[n], points.z[n]);
            if (!seen.holds(cell[0], cell[1], cell[2])) continue;
            out.cloud.x.push_back(points.x[n]);
            out.cloud.y.push_back(points.y[n]);
            out.cloud.z.push_back(points.z[n]);
            if (!points.red.empty()) {
                out.cloud.red.push_back(points.red[n]);
                out.cloud.green.push_back(points.green[n]);
                out.cloud.blue.push_back(points.blue[n]);
            }
            part.cells.push_back(static_cast<std::uint32_t>(n));
            part.in_core.push_back(block.core.holds(cell[0], cell[1], cell[2]));
        }
        if (!part.cells.empty()) out.parts.push_back(std::move(part));
    }
    const auto left = blocks_.subspan(next_);
    std::erase_if(held_, [&](const auto& bin) {
        return std::ranges::none_of(left,
                                    [&](std::size_t later) { return sees(later, bin.first); });
    });
    return out;
}

std::vector<std::vector<std::size_t>> tiles_of(const Layout& layout, double tile_m) {
    const std::int32_t block = block_edge(layout.voxel_m);
    const auto blocks = std::max(1L, std::lround(tile_m / block_edge_m));
    // By storey, as its blocks begin at one height, and the square's place.
    std::map<std::array<std::int64_t, 3>, std::vector<std::size_t>> tiles;
    const auto square = [&](std::int32_t low) {
        const std::int64_t place = low / block;  // a multiple of it
        return (place >= 0 ? place : place - blocks + 1) / blocks;
    };
    for (std::size_t b = 0; b < layout.blocks.size(); ++b) {
        const VoxelBox& core = layout.blocks[b].core;
        tiles[{core.low[2], square(core.low[0]), square(core.low[1])}].push_back(b);
    }
    std::vector<std::vector<std::size_t>> out;
    for (auto& [place, of_tile] : tiles) out.push_back(std::move(of_tile));
    return out;
}

}  // namespace topple::tiles

// SPDX-License-Identifier: MIT
#include "scale/blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "geometry/storeys.h"
#include "scale/binary_file.h"

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
        if (step - first < steps) area[step - first] = static_cast<double>(count) * cell_m * cell_m;
    }
    return geometry::find_storeys(area, static_cast<double>(first) * step_m, step_m);
}

constexpr std::int32_t leaf = 8;

// In voxels.
std::int32_t block_edge(double voxel_m) {
    return leaf *
           std::max(1, static_cast<std::int32_t>(std::lround(block_edge_m / (leaf * voxel_m))));
}

// Where storeys are cut, and up to where the lower one's blocks see, voxels.
struct SlabCut {
    std::int32_t at = 0, from_below = 0;
};

// At the leaf nearest to the middle of the slab. The lower storey's blocks see the slab, but not
// the floor on it: from there they would see its back, and all that stands on it cut off. Where the
// slab is so thin that its cut lies beside it, they see as much as sideways, and so do the upper
// storey's downwards.
SlabCut cut_slab(const geometry::Storey& above, double voxel_m, std::int32_t halo) {
    SlabCut out;
    out.at = leaf * static_cast<std::int32_t>(std::lround(above.below_m / (leaf * voxel_m)));
    out.from_below = static_cast<std::int32_t>(
        std::lround((above.floor_m - geometry::level_spread_m) / voxel_m));
    if (out.from_below < out.at) out.from_below = out.at + halo;
    return out;
}

std::int32_t floored(std::int32_t value, std::int32_t step) {
    const std::int32_t rest = value % step;
    return value - (rest < 0 ? rest + step : rest);
}

// A core to be, and how far the cells in it reach. Level, voxels.
struct Place {
    std::int32_t storey = 0;
    std::array<std::int32_t, 2> low{}, high{}, from{}, to{};
    std::uint64_t cells = 0;

    Place(std::int32_t of_storey, const std::array<std::int32_t, 2>& at, std::int32_t edge)
        : storey(of_storey),
          low(at),
          high{at[0] + edge, at[1] + edge},
          from{high[0], high[1]},
          to{low[0], low[1]} {}
    void add(const Voxel& voxel) {
        for (std::size_t a = 0; a < 2; ++a) {
            from[a] = std::min(from[a], voxel[a]);
            to[a] = std::max(to[a], voxel[a] + 1);
        }
        ++cells;
    }
    // With another's cells in its core.
    Place with(const Place& rim) const {
        Place out = *this;
        for (std::size_t a = 0; a < 2; ++a) {
            out.from[a] = std::min(from[a], rim.from[a]);
            out.to[a] = std::max(to[a], rim.to[a]);
            out.low[a] = std::min(low[a], floored(out.from[a], leaf));
            out.high[a] = std::max(high[a], floored(out.to[a] + leaf - 1, leaf));
        }
        out.cells += rim.cells;
        return out;
    }
    bool meets(const Place& other) const {
        return storey == other.storey && low[0] < other.high[0] && other.low[0] < high[0] &&
               low[1] < other.high[1] && other.low[1] < high[1];
    }
};

// A building ends where it ends: of the outermost cores many hold but a wall, all of it within the
// halo of the next one inwards, which sees all that they would see of it. They become part of that.
void join_rims(std::int32_t halo, std::vector<Place>& places) {
    for (std::size_t a = 0; a < 2; ++a) {
        for (std::size_t r = 0; r < places.size();) {
            const Place& rim = places[r];
            const auto takes = [&](const Place& next) {
                const bool below = next.high[a] == rim.low[a] && rim.to[a] - rim.low[a] <= halo;
                const bool above = next.low[a] == rim.high[a] && rim.high[a] - rim.from[a] <= halo;
                if (next.storey != rim.storey || !(below || above)) return false;
                const Place both = next.with(rim);
                return std::ranges::none_of(places, [&](const Place& other) {
                    return &other != &rim && &other != &next && both.meets(other);
                });
            };
            const auto next = std::ranges::find_if(places, takes);
            if (next == places.end()) {
                ++r;
                continue;
            }
            *next = next->with(rim);
            places.erase(places.begin() + static_cast<std::ptrdiff_t>(r));
        }
    }
}

}  // namespace

Layout cut_into_blocks(const fs::path& folder, std::span<const Bin> bins,
                       const geometry::SceneFrame& frame, double cell_m, double voxel_m) {
    constexpr std::int32_t far = 1 << 26;  // beyond all voxels, with room for a halo
    Layout out{cell_m, voxel_m, 0, frame, {}};
    out.halo = leaf * static_cast<std::int32_t>(std::ceil(halo_m / (leaf * voxel_m) - 1e-9));
    const std::int32_t edge = block_edge(voxel_m);
    const std::vector<geometry::Storey> storeys = storeys_of(folder, bins, frame, cell_m, voxel_m);
    // Below each storey, and above the last.
    std::vector<SlabCut> cuts;
    for (const geometry::Storey& s : storeys)
        cuts.push_back(std::isinf(s.below_m) ? SlabCut{-far, -far}
                                             : cut_slab(s, voxel_m, out.halo));
    cuts.push_back({far, far});
    std::map<std::array<std::int32_t, 3>, Place> places;  // by storey, i, j
    for (const Bin& bin : bins) {
        const ThinnedBin points = read_thinned(folder, bin);
        for (std::size_t n = 0; n < points.size(); ++n) {
            const Voxel at = out.voxel_at(points.x[n], points.y[n], points.z[n]);
            const auto above = std::ranges::upper_bound(cuts, at[2], {}, &SlabCut::at);
            const auto storey = static_cast<std::int32_t>(above - cuts.begin() - 1);
            const std::array<std::int32_t, 3> low{storey, floored(at[0], edge),
                                                  floored(at[1], edge)};
            places.try_emplace(low, Place{storey, {low[1], low[2]}, edge}).first->second.add(at);
        }
    }
    std::vector<Place> all;
    for (const auto& [low, place] : places) all.push_back(place);
    join_rims(out.halo, all);
    for (const Place& place : all) {
        if (place.cells < least_cells) continue;
        const auto storey = static_cast<std::size_t>(place.storey);
        Block block;
        block.core.low = {place.low[0], place.low[1], cuts[storey].at};
        block.core.high = {place.high[0], place.high[1], cuts[storey + 1].at};
        block.seen = block.core.grown(out.halo);
        block.seen.high[2] = cuts[storey + 1].from_below;
        block.floor_m = storeys[storey].floor_m;
        block.top_m = storey + 1 < storeys.size() ? storeys[storey + 1].below_m
                                                  : std::numeric_limits<double>::infinity();
        block.cells = place.cells;
        out.blocks.push_back(block);
    }
    return out;
}

namespace {

template <class Io, class Of>
void layout_fields(Io& io, Of& layout) {
    using namespace rules;
    io(layout.cell_m, within(1e-6, bin_edge_m));
    io(layout.voxel_m, within(1e-6, bin_edge_m));
    io(layout.halo, voxels);
    io(layout.frame.axes, within(-1.001, 1.001));
    io(layout.frame.found);
    io(layout.frame.up_method, shown);
    io(layout.frame.note, shown);
    io(layout.blocks, of_all([](const Block& block, const auto& must) {
           for (const VoxelBox* box : {&block.core, &block.seen})
               must(box->low, voxels), must(box->high, voxels);
       }));
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
    const VoxelBox& seen = layout_.blocks[block].seen;
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
    const VoxelBox& seen = block.seen;
    BlockPoints out;
    for (std::size_t b = 0; b < bins_.size(); ++b) {
        if (!sees(number, b)) continue;
        auto held = held_.find(b);
        if (held == held_.end()) held = held_.emplace(b, read_thinned(folder_, bins_[b])).first;
        const ThinnedBin& points = held->second;
        BlockPoints::Part part{b, {}, {}};
        for (std::size_t n = 0; n < points.size(); ++n) {
            const Voxel at = layout_.voxel_at(points.x[n], points.y[n], points.z[n]);
            if (!seen.holds(at)) continue;
            add_cell(points, n, out.cloud);
            part.cells.push_back(static_cast<std::uint32_t>(n));
            part.in_core.push_back(block.core.holds(at));
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
    // By a core's middle: at rims it is larger.
    const auto square = [&](const VoxelBox& core, std::size_t a) {
        const std::int64_t place = floored((core.low[a] + core.high[a]) / 2, block) / block;
        return (place >= 0 ? place : place - blocks + 1) / blocks;
    };
    for (std::size_t b = 0; b < layout.blocks.size(); ++b) {
        const VoxelBox& core = layout.blocks[b].core;
        tiles[{core.low[2], square(core, 0), square(core, 1)}].push_back(b);
    }
    std::vector<std::vector<std::size_t>> out;
    for (auto& [place, of_tile] : tiles) out.push_back(std::move(of_tile));
    return out;
}

}  // namespace topple::tiles

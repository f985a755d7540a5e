// SPDX-License-Identifier: MIT
#include "safety/human/convolution.h"

#include <algorithm>
#include <cmath>

#include "disturbance.hpp"
#include "disturbance_reach.hpp"
#include "safety/human/human_field.h"
#include "topple/kernels/queue.h"

namespace topple::safety {
namespace {

constexpr std::uint32_t block = 64;  // cells, as in the kernels
constexpr std::uint64_t tile_bytes = std::uint64_t{64} << 20;
constexpr std::uint32_t largest_tile = 16384;  // cells

unsigned all_bands(const SecondaryMotion& motion) {
    unsigned count = 0;
    for (const MotionLayer& layer : motion.layers) count += layer.bands.count;
    return count;
}

}  // namespace

Strikes no_strikes(const SecondaryMotion& motion) {
    return Strikes(motion.energy_J.size());
}

std::vector<Extent> extents(const SolidCells& cells, std::span<const std::int32_t> object_of_cell,
                            std::span<const RiskObject> objects) {
    std::vector<Extent> out(objects.size(), {INFINITY, -INFINITY});
    for (std::size_t c = 0; c < object_of_cell.size(); ++c) {
        if (object_of_cell[c] < 0) continue;
        Extent& extent = out[static_cast<std::size_t>(object_of_cell[c])];
        extent.bottom_m = std::min(extent.bottom_m, cells.k[c] * cells.voxel_m);
        extent.top_m = std::max(extent.top_m, (cells.k[c] + 1) * cells.voxel_m);
    }
    for (std::size_t o = 0; o < out.size(); ++o)
        if (objects[o].base_m < out[o].top_m) out[o].bottom_m = objects[o].base_m;
    return out;
}

// A run of active blocks, and what the device made of it.
struct Convolution::Tile {
    std::span<const std::uint32_t> starts;  // padded index of each block's first cell
    std::uint32_t cells = 0;
    std::vector<std::uint32_t> output_first;  // of each layer in `density`
    std::vector<float> density;               // layers x directions x the layer's bands x cells
    std::span<Target> targets;                // those in the tile
};

Convolution::Convolution(device::Device& device, const WalkableMap& map,
                         const PrimaryMotion& motion, const SecondaryMotion& secondary,
                         const Surroundings& surroundings,
                         std::span<const std::int32_t> object_of_cell,
                         std::span<const Extent> extents, const HumanOptions& options)
    : device_(device),
      map_(map),
      motion_(motion),
      secondary_(secondary),
      surroundings_(surroundings),
      object_of_cell_(object_of_cell),
      extents_(extents),
      options_(options),
      band_m_(options.body_height_m / band_count),
      footprint_(make_footprint(map.cell_m, secondary)) {
    // A margin of the footprint's radius on all sides, and a row more above and below for the cells
    // of a block that lie beside the map.
    const std::int64_t r = footprint_.radius;
    width_ = (map.nx + 2 * r + block - 1) / block * block;
    height_ = map.ny + 2 * r + 2;
    const SightLines lines = sight_lines(footprint_, static_cast<std::int32_t>(width_));
    // From the plane of the strike's direction to that of the walker's heading, too.
    std::vector<std::int32_t> delta;
    for (std::size_t i = 0; i + 1 < footprint_.first.size(); ++i) {
        const auto d = static_cast<std::int64_t>(i % direction_count);
        for (std::uint32_t e = footprint_.first[i]; e < footprint_.first[i + 1]; ++e) {
            const auto& o = footprint_.offsets[footprint_.row[e]];
            delta.push_back(static_cast<std::int32_t>(
                (footprint_.heading[e] - d) * width_ * height_ + o.y * width_ + o.x));
        }
    }
    using device::Buffer;
    line_first_ = Buffer<std::uint32_t>(device, lines.first, "reach.row_first");
    step_a_ = Buffer<std::int32_t>(device, lines.a, "reach.step_a");
    step_b_ = Buffer<std::int32_t>(device, lines.b, "reach.step_b");
    entry_first_ = Buffer<std::uint32_t>(device, footprint_.first, "footprint.first");
    entry_delta_ = Buffer<std::int32_t>(device, delta, "footprint.delta");
    entry_row_ = Buffer<std::uint32_t>(device, footprint_.row, "footprint.row");
    entry_weight_ = Buffer<float>(device, footprint_.weight, "footprint.weight");
}

std::uint32_t Convolution::padded(std::size_t map_cell) const {
    const Place at = map_.place(static_cast<std::uint32_t>(map_cell));
    const std::int64_t r = footprint_.radius;
    return static_cast<std::uint32_t>((at.y + r + 1) * width_ + at.x + r);
}

std::vector<float> Convolution::primary(const std::vector<bool>& component) const {
    const auto plane = static_cast<std::size_t>(width_ * height_);
    std::vector<float> out(direction_count * plane, 0.0f);
    for (const std::uint32_t c : map_.walkable) {
        if (!component[static_cast<std::size_t>(map_.component[c])]) continue;
        for (unsigned d = 0; d < direction_count; ++d) {
            out[d * plane + padded(c)] = static_cast<float>(motion_.frequency(d, c, map_.size()));
        }
    }
    return out;
}

// Bit b of a cell: a solid crosses the plane in the middle of band b. The floor itself is no
// obstacle to what moves above it.
std::vector<std::uint32_t> Convolution::solid_bands(double floor_m) const {
    std::vector<std::uint32_t> out(static_cast<std::size_t>(width_ * height_), 0);
    const SolidCells& cells = *surroundings_.cells;
    const double step = std::max(options_.step_height_m, cells.voxel_m) + 1e-6;
    for (std::size_t v = 0; v < cells.size(); ++v) {
        const double bottom = cells.k[v] * cells.voxel_m - floor_m, top = bottom + cells.voxel_m;
        if (is_floor_cell(surroundings_, v) && top <= step) continue;
        const double first = std::ceil(bottom / band_m_ - 0.5),
                     last = std::ceil(top / band_m_ - 0.5);
        std::uint32_t bits = 0;
        for (double b = std::max(first, 0.0); b < std::min(last, double{band_count}); ++b) {
            bits |= 1u << static_cast<unsigned>(b);
        }
        if (bits) out[padded(map_.cell_of(cells.i[v], cells.j[v]))] |= bits;
    }
    return out;
}

// First cells of the blocks within the footprint's radius of a place that is walked on, ascending.
std::vector<std::uint32_t> Convolution::active_blocks(const std::vector<bool>& component) const {
    const std::int64_t blocks_wide = width_ / block, r = footprint_.radius;
    std::vector<bool> active(static_cast<std::size_t>(blocks_wide * height_));
    for (const std::uint32_t c : map_.walkable) {
        if (!component[static_cast<std::size_t>(map_.component[c])]) continue;
        bool walked = false;
        for (unsigned d = 0; d < direction_count && !walked; ++d) {
            walked = motion_.visits[d * map_.size() + c] > 0;
        }
        if (!walked) continue;
        const auto [x, y] = map_.place(c);  // padded: x + r, y + r + 1
        for (std::int64_t ty = std::max<std::int64_t>(y - r, 0); ty <= std::min(y + r, map_.ny - 1);
             ++ty) {
            for (std::int64_t b = x / block; b <= std::min(x + 2 * r, map_.nx + r - 1) / block;
                 ++b) {
                active[static_cast<std::size_t>((ty + r + 1) * blocks_wide + b)] = true;
            }
        }
    }
    std::vector<std::uint32_t> starts;
    for (std::size_t b = 0; b < active.size(); ++b) {
        if (active[b]) starts.push_back(static_cast<std::uint32_t>(b * block));
    }
    return starts;
}

bool Convolution::target_of(std::size_t voxel, std::int32_t number, double floor_m, Target& target,
                            std::int32_t di, std::int32_t dj) const {
    if (number < 0) return false;
    const SolidCells& cells = *surroundings_.cells;
    const double height = (cells.k[voxel] + 0.5) * cells.voxel_m;
    const double band = std::floor((height - floor_m) / band_m_);
    if (band < 0 || band >= band_count) return false;
    const std::int32_t i = cells.i[voxel] + di, j = cells.j[voxel] + dj;
    if (!map_.holds(i, j)) return false;
    const Extent& extent = extents_[static_cast<std::size_t>(object_of_cell_[voxel])];
    const double part =
        (height - extent.bottom_m) / (extent.top_m - extent.bottom_m) * strike_heights;
    // What hangs below its base is met at its foot.
    target = {padded(map_.cell_of(i, j)), static_cast<std::uint8_t>(band),
              static_cast<std::uint8_t>(std::max(part, 0.0)), number, 0};
    return true;
}

void Convolution::sort_unique(std::vector<Target>& targets) {
    std::sort(targets.begin(), targets.end(),
              [](const Target& a, const Target& b) { return a.key() < b.key(); });
    targets.erase(std::unique(targets.begin(), targets.end(),
                              [](const Target& a, const Target& b) { return a.key() == b.key(); }),
                  targets.end());
}

void Convolution::run(Tile& tile, const device::Buffer<float>& primary,
                      const device::Buffer<std::uint32_t>& solid) {
    const auto rows = static_cast<std::uint32_t>(footprint_.offsets.size());
    const std::uint64_t outputs =
        std::uint64_t{all_bands(secondary_)} * direction_count * tile.cells;
    device::Buffer<std::uint32_t> starts(device_, tile.starts, "tile.block_start");
    device::Buffer<std::uint32_t> blocked(device_, std::uint64_t{rows} * tile.cells,
                                          "tile.blocked");
    device::Buffer<float> density(device_, outputs, "tile.density");
    device::Queue queue(device_);
    queue.add<kernels::DisturbanceReach>(std::uint64_t{rows} * tile.cells,
                                         {.block_start = starts,
                                          .solid = solid,
                                          .row_first = line_first_,
                                          .step_a = step_a_,
                                          .step_b = step_b_,
                                          .blocked = blocked},
                                         {.cell_count = tile.cells, .row_count = rows});
    std::uint32_t output_first = 0;
    for (std::uint32_t layer = 0; layer < secondary_.layers.size(); ++layer) {
        const Bands bands = secondary_.layers[layer].bands;
        tile.output_first.push_back(output_first);
        output_first += direction_count * bands.count * tile.cells;
        const std::uint64_t quads = (bands.count + 3) / 4;
        queue.add<kernels::Disturbance>(
            direction_count * quads * tile.cells,
            {.block_start = starts,
             .primary = primary,
             .blocked = blocked,
             .entry_first = entry_first_,
             .entry_delta = entry_delta_,
             .entry_row = entry_row_,
             .entry_weight = entry_weight_,
             .density = density},
            {.cell_count = tile.cells,
             .row_count = rows,
             .plane_cells = static_cast<std::uint32_t>(width_ * height_),
             .direction_count = direction_count,
             .footprint_first = layer * direction_count,
             .band_first = bands.first,
             .band_count = bands.count,
             .output_first = tile.output_first[layer]});
    }
    queue.run();
    tile.density = density.download();
}

// Each target takes the larger density of its band and the one above.
void Convolution::collect_strikes(Tile& tile, std::span<Strikes> strikes) const {
    for (Target& target : tile.targets) {
        const auto at = std::upper_bound(tile.starts.begin(), tile.starts.end(), target.cell);
        if (at == tile.starts.begin() || target.cell - *(at - 1) >= block) continue;  // not active
        const auto place = static_cast<std::size_t>(at - 1 - tile.starts.begin()) * block +
                           target.cell - *(at - 1);
        for (std::size_t n = 0; n < secondary_.layers.size(); ++n) {
            const MotionLayer& layer = secondary_.layers[n];
            const Bands bands = layer.bands;
            for (unsigned d = 0; d < direction_count; ++d) {
                float most = 0;
                for (unsigned b = target.band; b <= target.band + 1u; ++b) {
                    if (b < bands.first || b >= bands.first + bands.count) continue;
                    const std::size_t plane = d * bands.count + (b - bands.first);
                    most = std::max(
                        most, tile.density[tile.output_first[n] + plane * tile.cells + place]);
                }
                target.exposure += most;
                double& strike =
                    strikes[static_cast<std::size_t>(target.object)][layer.level][d][target.part];
                strike = std::max(strike, double{most});
            }
        }
    }
}

std::vector<Passing> Convolution::passing(const Tile& tile) const {
    std::vector<Passing> sum(std::size_t{band_count} * tile.cells);
    for (std::size_t n = 0; n < secondary_.layers.size(); ++n) {
        const Bands bands = secondary_.layers[n].bands;
        const double speed = secondary_.layers[n].speed_m_s;
        const auto energy = static_cast<float>(secondary_.energy_J[secondary_.layers[n].level]);
        for (unsigned d = 0; d < direction_count; ++d) {
            const auto [dx, dy] = direction(d);
            const auto vx = static_cast<float>(dx * speed), vy = static_cast<float>(dy * speed);
            for (unsigned b = 0; b < bands.count; ++b) {
                const float* density = &tile.density[tile.output_first[n] +
                                                     std::size_t{d * bands.count + b} * tile.cells];
                Passing* to = &sum[std::size_t{bands.first + b} * tile.cells];
                for (std::uint32_t c = 0; c < tile.cells; ++c) {
                    to[c].velocity[0] += density[c] * vx;
                    to[c].velocity[1] += density[c] * vy;
                    to[c].passes += density[c];
                    to[c].energy += density[c] * energy;
                }
            }
        }
    }
    return sum;
}

template <class Visit>
void Convolution::each_place(const Tile& tile, const Visit& visit) const {
    const std::int64_t r = footprint_.radius;
    for (std::uint32_t c = 0; c < tile.cells; ++c) {
        const std::int64_t at = tile.starts[c / block] + c % block;
        const Place place{at % width_ - r, at / width_ - r - 1};
        if (map_.inside(place)) visit(place, c);
    }
}

void Convolution::offer_arrows(const Tile& tile, std::span<const Passing> passing, double floor_m,
                               ArrowSample& arrows) const {
    each_place(tile, [&](const Place& place, std::uint32_t c) {
        const auto [x, y] = map_.center(place);
        for (unsigned b = 0; b < band_count; ++b) {
            const Passing& s = passing[std::size_t{b} * tile.cells + c];
            if (s.passes <= 0) continue;
            arrows.offer({x, y, floor_m + (b + 0.5) * band_m_},
                         {double{s.velocity[0] / s.passes}, double{s.velocity[1] / s.passes}, 0},
                         double{s.passes});
        }
    });
}

void Convolution::add_space(const Tile& tile, std::span<const Passing> passing, double floor_m,
                            SpaceSums& space) const {
    const double low = (floor_m - space.corner_m()[2]) / space.cell_m();
    const double high = low + band_count * band_m_ / space.cell_m();
    each_place(tile, [&](const Place& place, std::uint32_t c) {
        for (auto k = static_cast<std::int32_t>(std::ceil(low - 0.5)); k + 0.5 < high; ++k) {
            const double above_m = (k + 0.5 - low) * space.cell_m();
            const auto b = std::min(static_cast<unsigned>(above_m / band_m_), band_count - 1);
            space.add({static_cast<std::int32_t>(place.x), static_cast<std::int32_t>(place.y), k},
                      passing[std::size_t{b} * tile.cells + c]);
        }
    });
}

template <class Visit>
void Convolution::sweep(double floor_m, const std::vector<bool>& component,
                        const std::vector<std::uint32_t>& starts, std::vector<Target>& targets,
                        std::span<Strikes> strikes, const Visit& visit) {
    const device::Buffer<float> primary_field(device_, primary(component), "primary motion");
    const device::Buffer<std::uint32_t> solid(device_, solid_bands(floor_m), "solid bands");
    std::vector<Strikes> here(strikes.size(), no_strikes(secondary_));

    const std::uint64_t per_cell =
        4 * std::max<std::uint64_t>(footprint_.offsets.size(),
                                    std::uint64_t{all_bands(secondary_)} * direction_count);
    const std::uint64_t fits =
        std::clamp<std::uint64_t>(tile_bytes / per_cell, block, largest_tile);
    const std::size_t blocks_per_tile = fits / block;
    for (std::size_t first = 0; first < starts.size(); first += blocks_per_tile) {
        Tile tile;
        tile.starts =
            std::span(starts).subspan(first, std::min(blocks_per_tile, starts.size() - first));
        tile.cells = static_cast<std::uint32_t>(tile.starts.size() * block);
        const auto before = [](const Target& t, std::uint32_t cell) { return t.cell < cell; };
        const auto low =
            std::lower_bound(targets.begin(), targets.end(), tile.starts.front(), before);
        const auto high = std::lower_bound(low, targets.end(), tile.starts.back() + block, before);
        tile.targets = std::span<Target>(low, high);
        run(tile, primary_field, solid);
        collect_strikes(tile, here);
        visit(tile);
    }
    // Walks at different levels are different events.
    for (std::size_t o = 0; o < strikes.size(); ++o) {
        for (std::size_t n = 0; n < strikes[o].size(); ++n) {
            for (unsigned d = 0; d < direction_count; ++d) {
                for (std::size_t h = 0; h < strike_heights; ++h)
                    strikes[o][n][d][h] += here[o][n][d][h];
            }
        }
    }
}

void Convolution::add_level(double floor_m, const std::vector<bool>& component,
                            std::span<Strikes> strikes, std::span<float> exposure,
                            ArrowSample& arrows, SpaceSums& space) {
    std::vector<Target> all;
    Target target;
    for (std::size_t v = 0; v < object_of_cell_.size(); ++v) {
        if (!target_of(v, object_of_cell_[v], floor_m, target)) continue;
        if (all.empty() || all.back().key() != target.key()) all.push_back(target);
    }
    sort_unique(all);
    sweep(floor_m, component, active_blocks(component), all, strikes, [&](const Tile& tile) {
        const std::vector<Passing> passes = passing(tile);
        offer_arrows(tile, passes, floor_m, arrows);
        if (space.made()) add_space(tile, passes, floor_m, space);
    });
    for (std::size_t v = 0; v < object_of_cell_.size(); ++v) {
        if (!target_of(v, object_of_cell_[v], floor_m, target)) continue;
        const auto found =
            std::lower_bound(all.begin(), all.end(), target,
                             [](const Target& a, const Target& b) { return a.key() < b.key(); });
        exposure[v] += found->exposure;
    }
}

void Convolution::add_placements(double floor_m, const std::vector<bool>& component,
                                 std::span<const std::vector<std::uint32_t>> cells_of_object,
                                 std::span<const Placement> placements,
                                 std::span<Strikes> strikes) {
    std::vector<Target> all;
    Target target;
    for (std::size_t p = 0; p < placements.size(); ++p) {
        const Placement& at = placements[p];
        const std::size_t begin = all.size();
        for (const std::uint32_t v : cells_of_object[at.object]) {
            if (!target_of(v, static_cast<std::int32_t>(p), floor_m, target, at.di, at.dj))
                continue;
            if (all.size() == begin || all.back().key() != target.key()) all.push_back(target);
        }
    }
    sort_unique(all);
    std::vector<std::uint32_t> starts;
    std::size_t next = 0;
    for (const std::uint32_t start : active_blocks(component)) {
        while (next < all.size() && all[next].cell < start) ++next;
        if (next < all.size() && all[next].cell < start + block) starts.push_back(start);
    }
    sweep(floor_m, component, starts, all, strikes, [](const Tile&) {});
}

}  // namespace topple::safety

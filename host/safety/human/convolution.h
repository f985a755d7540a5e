// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "physics/toppling.h"
#include "safety/human/footprint.h"
#include "safety/human/human_field.h"
#include "safety/human/secondary_motion.h"
#include "safety/human/walkable_map.h"
#include "safety/objects.h"
#include "safety/space_sums.h"
#include "topple/kernels/buffer.h"

namespace topple::safety {

// Passes at each level of energy over an object, per walk, by direction and by the part of its
// height that they meet: the most that any of its cells there gets.
inline constexpr std::size_t strike_heights = physics::Toppling::heights;
using Strikes = std::vector<std::array<std::array<double, strike_heights>, direction_count>>;

// An object's base and the top of its cells, grid frame.
struct Extent {
    double bottom_m = 0, top_m = 0;
    double height_m(std::size_t part) const {  // of that part's middle, above the bottom
        return (static_cast<double>(part) + 0.5) / strike_heights * (top_m - bottom_m);
    }
};
std::vector<Extent> extents(const SolidCells& cells, std::span<const std::int32_t> object_of_cell,
                            std::span<const RiskObject> objects);

Strikes no_strikes(const SecondaryMotion& motion);

// Of all strikes of one walk the one that does most: of the largest S, then of the largest W. Their
// total probability is at most 1.
std::vector<WorkSample> strongest_strikes(const Strikes& strikes, const SecondaryMotion& motion,
                                          const RiskObject& object, const Extent& extent,
                                          double restitution);

// Primary motion convolved with the secondary, on the device (kernels disturbance_reach,
// disturbance). Sparse: blocks of 64 map cells near places that are walked on, in tiles whose
// buffers stay below 64 MiB. A cell is reached from where the horizontal line from the walker, at
// the middle of the height band, crosses no solid before the cell; so unreachable cells get exactly
// 0. A part is as thick as a band: what lies in band b is struck by parts that move at b or at b +
// 1, as a hand that passes just above a table top strikes the book that lies on it.
class Convolution {
  public:
    Convolution(device::Device& device, const WalkableMap& map, const PrimaryMotion& motion,
                const SecondaryMotion& secondary, const Surroundings& surroundings,
                std::span<const std::int32_t> object_of_cell, std::span<const Extent> extents,
                const HumanOptions& options);

    double band_m() const { return band_m_; }

    // The walks within the given components, whose floor is at floor_m: adds to the objects'
    // strikes, to the solid cells' exposure and to the sums over space, where these are made, and
    // offers arrows for the report.
    void add_level(double floor_m, const std::vector<bool>& component, std::span<Strikes> strikes,
                   std::span<float> exposure, ArrowSample& arrows, SpaceSums& space);
    // The same for objects that stand elsewhere: adds to the strikes of each placement.
    void add_placements(double floor_m, const std::vector<bool>& component,
                        std::span<const std::vector<std::uint32_t>> cells_of_object,
                        std::span<const Placement> placements, std::span<Strikes> strikes);

  private:
    // A movable object's presence in a map cell and height band, with a part of its own height.
    struct Target {
        std::uint32_t cell;  // of the padded map
        std::uint8_t band, part;
        std::int32_t object;
        float exposure = 0;
        auto key() const { return std::tuple(cell, band, object, part); }
    };
    struct Tile;

    std::uint32_t padded(std::size_t map_cell) const;
    std::vector<float> primary(const std::vector<bool>& component) const;  // a plane per direction
    std::vector<std::uint32_t> solid_bands(double floor_m) const;
    std::vector<std::uint32_t> active_blocks(const std::vector<bool>& component) const;
    // Of a voxel moved by (di, dj), as one of `number`; false: none, outside of the map or above
    // the body.
    bool target_of(std::size_t voxel, std::int32_t number, double floor_m, Target& target,
                   std::int32_t di = 0, std::int32_t dj = 0) const;
    static void sort_unique(std::vector<Target>& targets);
    // Runs all blocks, in tiles; adds the targets' strikes; shows each tile to `visit`.
    template <class Visit>
    void sweep(double floor_m, const std::vector<bool>& component,
               const std::vector<std::uint32_t>& starts, std::vector<Target>& targets,
               std::span<Strikes> strikes, const Visit& visit);
    void run(Tile& tile, const device::Buffer<float>& primary,
             const device::Buffer<std::uint32_t>& solid);
    void collect_strikes(Tile& tile, std::span<Strikes> strikes) const;
    // Of all layers and directions, by band and cell of the tile.
    std::vector<Passing> passing(const Tile& tile) const;
    // Calls visit(place, cell) for the tile's cells on the map, by their numbers in the tile.
    template <class Visit>
    void each_place(const Tile& tile, const Visit& visit) const;
    void offer_arrows(const Tile& tile, std::span<const Passing> passing, double floor_m,
                      ArrowSample& arrows) const;
    // To cells of space as wide as the map's: each takes the band that its middle lies in.
    void add_space(const Tile& tile, std::span<const Passing> passing, double floor_m,
                   SpaceSums& space) const;

    device::Device& device_;
    const WalkableMap& map_;
    const PrimaryMotion& motion_;
    const SecondaryMotion& secondary_;
    const Surroundings& surroundings_;
    std::span<const std::int32_t> object_of_cell_;
    std::span<const Extent> extents_;  // by object
    HumanOptions options_;
    double band_m_;
    Footprint footprint_;
    std::int64_t width_ = 0, height_ = 0;  // of the padded map, cells; width_ a multiple of 64
    device::Buffer<std::uint32_t> line_first_, entry_first_, entry_row_;
    device::Buffer<std::int32_t> step_a_, step_b_, entry_delta_;
    device::Buffer<float> entry_weight_;
};

}  // namespace topple::safety

// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "topple/cloud_view.h"

namespace topple::geometry {

inline constexpr std::int64_t key_bias = std::int64_t{1} << 20;
// Offsets within a cell are told in so many parts of its edge.
inline constexpr double cell_parts = 65536;

// The readings of one row of a depth frame, an array for each quantity, an entry for each pixel.
struct RowReadings {
    std::vector<std::uint32_t> kept;    // 1: the pixel has a reading on a surface
    std::vector<std::uint32_t> inside;  // 1: that lies within the grid's reach
    std::vector<std::uint32_t> weight;  // inverse variance, in 65535ths of the best reading's
    std::vector<double> depth_m;
    // Of those inside, by axis: cells, and 65536ths of one, from the grid's lowest corner.
    std::array<std::vector<std::int32_t>, 3> cell, part;
    // Room to look at neighbours in: largest jumps; the row between two pixels without a reading,
    // and a row of such.
    std::vector<float> limit;
    std::vector<std::uint16_t> padded, none;
    explicit RowReadings(std::size_t width);
};

// Back-projects depth frames into a grid of cells, key_bias of which lie before the origin on each
// axis. Positions are in double precision: the grid's reach takes 37 bits.
class BackProjection {
  public:
    // The intrinsics must be positive and finite.
    BackProjection(const Intrinsics& intrinsics, double cell_m);
    void row(const DepthFrame& frame, std::uint32_t v, RowReadings& out) const;

  private:
    // What depends on a reading's depth alone.
    struct DepthReading {
        float largest_jump = 0;  // to a neighbour on one surface, as stored
        std::uint32_t weight = 0;
        double depth_m = 0;
    };
    void look(const DepthFrame& frame, std::uint32_t v, RowReadings& out) const;

    Intrinsics intrinsics_;
    double per_cell_ = 0;
    std::vector<DepthReading> by_depth_;  // as stored
    std::vector<double> columns_;         // of pixels: the ray's slope
};

}  // namespace topple::geometry

// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "topple/input.h"

namespace topple::live {

// Which way the pixels of an image look from a sensor, in whose axes all places here are: those of
// a pinhole camera, or of an image of all that is around, by azimuth in columns and elevation in
// rows, from above (z) down.
class Projection {
  public:
    explicit Projection(const Intrinsics& pinhole);
    static Projection around(std::uint32_t rows, double depth_scale);

    std::uint32_t width() const { return k_.width; }
    std::uint32_t height() const { return k_.height; }
    std::size_t pixels() const { return std::size_t{k_.width} * k_.height; }
    double depth_scale() const { return k_.depth_scale; }
    bool is_around() const { return around_; }

    // Where a reading lies in a pixel: `depth_m` along z of a camera, else so far from the sensor.
    std::array<float, 3> place(std::size_t u, std::size_t v, double depth_m) const;
    struct Seen {
        std::size_t pixel;
        float depth_m;
    };
    // None: the place is out of view.
    std::optional<Seen> see(const std::array<float, 3>& place) const;
    // By pixel, the least stored reading of it and its eight neighbours; 0 where one of these has
    // none, or, of what is around, more than six.
    std::vector<std::uint16_t> nearest_around(const std::vector<std::uint16_t>& stored) const;

  private:
    Intrinsics k_;  // of what is around, size and scale alone
    bool around_ = false;
};

}  // namespace topple::live

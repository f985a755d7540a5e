// SPDX-License-Identifier: MIT
#include "live/projection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace topple::live {

Projection::Projection(const Intrinsics& pinhole) : k_(pinhole) {}

Projection Projection::around(std::uint32_t rows, double depth_scale) {
    Projection out{Intrinsics{2 * rows, rows, 1, 1, 0, 0, depth_scale}};
    out.around_ = true;
    return out;
}

std::array<float, 3> Projection::place(std::size_t u, std::size_t v, double depth_m) const {
    const auto column = static_cast<double>(u), row = static_cast<double>(v);
    if (!around_)
        return {static_cast<float>(depth_m * (column - k_.cx) / k_.fx),
                static_cast<float>(depth_m * (row - k_.cy) / k_.fy), static_cast<float>(depth_m)};
    const double azimuth = 2 * std::numbers::pi * (column + 0.5) / k_.width,
                 from_above = std::numbers::pi * (row + 0.5) / k_.height;
    const double level_m = depth_m * std::sin(from_above);
    return {static_cast<float>(-level_m * std::cos(azimuth)),
            static_cast<float>(-level_m * std::sin(azimuth)),
            static_cast<float>(depth_m * std::cos(from_above))};
}

std::optional<Projection::Seen> Projection::see(const std::array<float, 3>& place) const {
    const auto [x, y, z] = place;
    if (around_) {
        const double range = std::hypot(x, y, z);
        if (!(range > 0)) return std::nullopt;
        const double turns = std::atan2(y, x) / (2 * std::numbers::pi) + 0.5;
        const double above = std::acos(std::clamp(z / range, -1.0, 1.0)) / std::numbers::pi;
        const auto u =
            std::min(static_cast<std::size_t>(turns * k_.width), std::size_t{k_.width} - 1);
        const auto v =
            std::min(static_cast<std::size_t>(above * k_.height), std::size_t{k_.height} - 1);
        return Seen{v * k_.width + u, static_cast<float>(range)};
    }
    if (!(z > 0)) return std::nullopt;
    const auto u = static_cast<int>(
        std::lround(x / z * static_cast<float>(k_.fx) + static_cast<float>(k_.cx)));
    const auto v = static_cast<int>(
        std::lround(y / z * static_cast<float>(k_.fy) + static_cast<float>(k_.cy)));
    if (u < 0 || v < 0 || u >= static_cast<int>(k_.width) || v >= static_cast<int>(k_.height))
        return std::nullopt;
    return Seen{static_cast<std::size_t>(v) * k_.width + static_cast<std::size_t>(u), z};
}

std::vector<std::uint16_t> Projection::nearest_around(
    const std::vector<std::uint16_t>& stored) const {
    const std::size_t width = k_.width, height = k_.height;
    std::vector<std::uint16_t> out(stored.size(), 0);
    for (std::size_t v = 1; v + 1 < height; ++v) {
        for (std::size_t u = 0; u < width; ++u) {
            if (!around_ && (u == 0 || u + 1 == width)) continue;
            std::uint16_t least = 65535;
            std::size_t readings = 0;
            for (std::size_t row = v - 1; row <= v + 1; ++row) {
                for (std::size_t column = u + width - 1; column <= u + width + 1; ++column) {
                    const std::uint16_t one = stored[row * width + column % width];
                    if (one == 0) continue;
                    least = std::min(least, one);
                    ++readings;
                }
            }
            // A sweep has gaps between its rows, of which three pixels in a row are one.
            if (readings >= (around_ ? 3u : 9u)) out[v * width + u] = least;
        }
    }
    return out;
}

}  // namespace topple::live

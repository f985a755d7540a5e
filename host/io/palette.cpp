// SPDX-License-Identifier: MIT
#include "io/palette.h"

#include <algorithm>
#include <cmath>

namespace topple::io {

std::array<std::uint8_t, 3> colour_of(std::int32_t id) {
    if (id < 0) return {150, 150, 150};
    // Hues go round by the golden ratio, so that few ids lie far apart and many still differ; three
    // steps of lightness and two of saturation tell near hues apart.
    const double golden = 0.6180339887498949;
    const double hue = std::fmod(0.58 + golden * id, 1.0) * 6;
    static constexpr std::array<double, 3> lightness_of{0.56, 0.43, 0.70};
    const double lightness = lightness_of[static_cast<std::size_t>(id) % 3];
    const double saturation = id / 3 % 2 == 0 ? 0.62 : 0.42;
    const double chroma = saturation * std::min(lightness, 1 - lightness);
    std::array<std::uint8_t, 3> rgb{};
    for (std::size_t i = 0; i < 3; ++i) {
        // CSS Color 4, 8.1: f(n) = L - a max(-1, min(k - 3, 9 - k, 1)), k = n + H / 30 degrees,
        // mod 12.
        static constexpr std::array<double, 3> n{0, 8, 4};
        const double k = std::fmod(n[i] + hue * 2, 12.0);
        const double value = lightness - chroma * std::max(-1.0, std::min({k - 3, 9 - k, 1.0}));
        rgb[i] = static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255));
    }
    return rgb;
}

}  // namespace topple::io

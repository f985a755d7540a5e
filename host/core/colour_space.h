// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

// Colours as files store them (sRGB), as light adds up (linear), and as eyes tell them apart
// (CIE L*a*b*).
namespace topple {

using Rgb8 = std::array<std::uint8_t, 3>;  // sRGB, red, green, blue

// Of colours, whose mean is rounded channel by channel.
struct ColourSum {
    std::array<std::uint64_t, 3> channel{};
    std::uint64_t count = 0;

    void add(const Rgb8& colour) {
        for (std::size_t c = 0; c < 3; ++c) channel[c] += colour[c];
        ++count;
    }
    Rgb8 mean() const {
        Rgb8 out{};
        for (std::size_t c = 0; c < 3; ++c)
            out[c] = static_cast<std::uint8_t>((channel[c] + count / 2) / count);
        return out;
    }
};

// IEC 61966-2-1; both from 0 to 1.
inline double linear_of_srgb(double v) {
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}
inline double srgb_of_linear(double v) {
    return v <= 0.0031308 ? v * 12.92 : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

// The byte of a channel of 0 to 1; what lies beyond is cut.
inline std::uint8_t channel_byte(double v) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0, 1.0) * 255));
}

// CIE L*a*b* of an sRGB colour, channels from 0 to 1, under D65: L* from 0 (black) to 100 (white),
// a* from green (about -86) to red (98), b* from blue (-108) to yellow (94). The Euclidean distance
// of two is about how different they look; 2.3 is just noticeable.
inline std::array<double, 3> lab_of_srgb(const std::array<double, 3>& srgb) {
    std::array<double, 3> linear{};
    for (std::size_t c = 0; c < 3; ++c) linear[c] = linear_of_srgb(srgb[c]);
    // To CIE XYZ, each relative to the white point.
    constexpr std::array<std::array<double, 3>, 3> to_xyz{{{0.4124564, 0.3575761, 0.1804375},
                                                           {0.2126729, 0.7151522, 0.0721750},
                                                           {0.0193339, 0.1191920, 0.9503041}}};
    std::array<double, 3> f{};
    for (std::size_t a = 0; a < 3; ++a) {
        const auto& row = to_xyz[a];
        const double t = (row[0] * linear[0] + row[1] * linear[1] + row[2] * linear[2]) /
                         (row[0] + row[1] + row[2]);
        constexpr double knee = 6.0 / 29;
        f[a] = t > knee * knee * knee ? std::cbrt(t) : t / (3 * knee * knee) + 4.0 / 29;
    }
    return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

}  // namespace topple

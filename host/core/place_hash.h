// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

#include "core/random.h"

namespace topple {

// Well mixed, the same for the same whole numbers.
inline std::uint64_t hash_of(std::int64_t x, std::int64_t y, std::int64_t z) {
    std::uint64_t out = 0;
    for (const std::int64_t v : {x, y, z}) out = Random(out ^ static_cast<std::uint64_t>(v)).bits();
    return out;
}

// Of a place, metres, by which samples are drawn: whatever its number in a cloud, and for nearly
// all places also where rounding differs.
inline std::uint64_t place_hash(double x, double y, double z) {
    constexpr double steps_per_m = 4096;
    const auto step = [](double v) {
        return static_cast<std::int64_t>(std::llround(v * steps_per_m));
    };
    return hash_of(step(x), step(y), step(z));
}

}  // namespace topple

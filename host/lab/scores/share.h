// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>

namespace topple::scenes {

// A share, and of how many cases; NaN of none.
struct Share {
    double value = std::numeric_limits<double>::quiet_NaN();
    std::uint64_t of = 0;
};

inline Share share(std::uint64_t hits, std::uint64_t of) {
    if (of == 0) return {};
    return {static_cast<double>(hits) / static_cast<double>(of), of};
}

}  // namespace topple::scenes

// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

namespace topple::oracle {

// Sum of values[order[n]] - origin over the segment [first, last).
inline std::uint32_t segment_sum(const std::vector<std::int32_t>& values,
                                 const std::vector<std::uint32_t>& order, std::uint32_t first,
                                 std::uint32_t last, std::int32_t origin) {
    std::int64_t sum = 0;
    for (std::uint32_t n = first; n < last; ++n) sum += std::int64_t{values[order[n]]} - origin;
    return static_cast<std::uint32_t>(sum);
}

}  // namespace topple::oracle

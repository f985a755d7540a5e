// SPDX-License-Identifier: MIT
#include "fitted/network.h"

#include <algorithm>
#include <cmath>

namespace topple::fitted {

void InputScaling::scale(std::span<const float> values, std::span<float> to) const {
    for (std::size_t n = 0; n < names.size(); ++n)
        to[n] = std::isnan(values[n])
                    ? 0
                    : (std::clamp(values[n], low[n], high[n]) - mean[n]) / deviation[n];
    for (std::size_t m = 0; m < missing.size(); ++m)
        to[names.size() + m] = std::isnan(values[missing[m]]) ? 1 : 0;
}

}  // namespace topple::fitted

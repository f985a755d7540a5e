// SPDX-License-Identifier: MIT
#include "core/basis.h"

#include <array>
#include <cstddef>

namespace topple {

double probability_solid(Basis basis) {
    constexpr std::array<double, basis_count> table{0.99, 0.98, 0.97, 0.9, 0.9, 0.8};
    return table[static_cast<std::size_t>(basis)];
}

}  // namespace topple

// SPDX-License-Identifier: MIT
#pragma once

#include "core/solid_cells.h"
#include "standard.h"

namespace topple::test {

// A column of cells of one primitive, sorted among others by where it stands.
inline void add_column(SolidCells& cells, std::int32_t i, std::int32_t k, std::int32_t end,
                       std::int32_t primitive, Basis basis) {
    for (; k < end; ++k) cells.add({i, 0, k}, primitive, basis);
}

}  // namespace topple::test

// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/colour_space.h"
#include "report/cells.h"

namespace topple::report {

// What cells look like: each has the mean colour of what was seen in it; those in which nothing was
// have the mean of their neighbours of the same body, ring after ring.
class CellColours {
  public:
    // Of so many cells.
    explicit CellColours(std::size_t cells) : sums_(cells) {}
    // 0, 0, 0 is not known, and left out.
    void add(std::uint32_t cell, const Rgb8& colour);

    // index, body: of each cell; `table` finds the cells by index. Nothing where nothing of a body
    // was seen.
    std::vector<std::optional<Rgb8>> spread(const CellTable& table,
                                            const std::vector<std::array<std::int32_t, 3>>& index,
                                            const std::vector<std::int32_t>& body) const;

  private:
    std::vector<ColourSum> sums_;
};

}  // namespace topple::report

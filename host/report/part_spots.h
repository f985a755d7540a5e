// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "report/cells.h"
#include "topple/scene.h"

// Places by which a primitive is found again, though a later parse numbers it otherwise.
namespace topple::report {

// Of each group of cells the exposed one that lies deep among its own, four cells from those of
// other groups or as far as it gets, and of these the one nearest to the group's middle; one that
// was seen where any was. CellTable::absent where none is exposed. groups: how many there are.
std::vector<std::uint32_t> inner_cells(const std::vector<Cell>& cells, const CellTable& table,
                                       std::size_t groups);

// Each group's place moved to the nearest of its primitive's points, where it has any.
std::vector<std::optional<Vec3>> nearest_points(
    const ScenePoints& points, std::span<const std::pair<std::int32_t, std::int32_t>> groups,
    std::vector<std::optional<Vec3>> places);

}  // namespace topple::report

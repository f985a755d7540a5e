// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "topple/input.h"

namespace topple {

// A disturbance over space, not only where it meets things (paper, 5.1, Figs. 10 and 11): of the
// cells that it reaches what passes in one event, a walk or a gale. Of an earthquake: the cells on
// which things stand. Cell (i, j, k) spans corner_m +
// [i, i + 1] along_m[0] + [j, j + 1] along_m[1] + [k, k + 1] along_m[2], a cube, in metres.
struct SpaceField {
    Vec3 corner_m{};
    std::array<Vec3, 3> along_m{};
    std::vector<std::array<std::int32_t, 3>> cell;  // ascending, each once
    // Mean over all that passes, m/s. Ways that cancel out leave little of it.
    std::vector<std::array<float, 3>> velocity_m_s;
    // Of people: parts of bodies that pass in one walk. Of wind: the share of gales that blow
    // there. Of an earthquake 1.
    std::vector<float> frequency;
    // Mean over all that passes: m v^2 / 2 of parts of bodies, J; rho v^2 / 2 of wind, J/m^3; v^2 /
    // 2 of the ground's or floor's peak velocity, J/kg.
    std::vector<float> energy;
    std::string energy_unit = "J";
    std::size_t size() const { return cell.size(); }
};

}  // namespace topple

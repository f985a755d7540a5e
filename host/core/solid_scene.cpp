// SPDX-License-Identifier: MIT
#include "core/solid_scene.h"

#include <string>

#include "topple/error.h"

namespace topple {
namespace {

[[noreturn]] void refuse(const std::string& why) {
    throw Error(ErrorKind::usage, "solid scene: " + why);
}

void check(const SolidCells& cells, std::size_t primitives) {
    const std::size_t count = cells.size();
    bool whole = cells.unseen_below.empty() || cells.unseen_below.size() == count;
    SolidCells::each_array([&](const auto& array) { whole = whole && array.size() == count; },
                           cells);
    if (!whole) refuse("arrays of cells that differ in length");
    for (std::size_t n = 0; n < count; ++n) {
        if (n > 0 && place_of(cells, n) <= place_of(cells, n - 1))
            refuse("cells are not sorted by (i, j, k) at cell " + std::to_string(n));
        if (cells.primitive[n] < -1 || cells.primitive[n] >= static_cast<std::int64_t>(primitives))
            refuse("cell " + std::to_string(n) + " is of primitive " +
                   std::to_string(cells.primitive[n]) + ", but there are roles of " +
                   std::to_string(primitives) + " only");
        if (static_cast<std::uint8_t>(cells.basis[n]) >= basis_count)
            refuse("cell " + std::to_string(n) + " is solid for no reason that there is");
    }
}

}  // namespace

SolidScene::SolidScene(SolidCells cells, std::vector<Role> roles, SolidCells strays,
                       BoundaryCells boundary)
    : cells_(std::move(cells)),
      strays_(std::move(strays)),
      boundary_(std::move(boundary)),
      roles_(std::move(roles)) {
    check(cells_, roles_.size());
    check(strays_, 0);
    if (!boundary_.fits(roles_.size()))
        refuse("a boundary that is not sorted, or names what is not there");
    columns_ = CellColumns(cells_);
}

SolidCells SolidScene::with_strays() const {
    SolidCells out;
    out.voxel_m = cells_.voxel_m;
    std::size_t stray = 0;
    for (std::size_t n = 0; n < cells_.size(); ++n) {
        for (; stray < strays_.size() && place_of(strays_, stray) < place_of(cells_, n); ++stray)
            out.add(strays_, stray, -1);
        out.add(cells_, n, cells_.primitive[n]);
    }
    for (; stray < strays_.size(); ++stray) out.add(strays_, stray, -1);
    out.unseen_below.clear();
    return out;
}

}  // namespace topple

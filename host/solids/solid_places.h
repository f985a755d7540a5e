// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "core/boundary_cells.h"
#include "core/rows.h"
#include "core/solid_cells.h"
#include "solids/matching.h"

namespace topple::solids {

inline constexpr std::size_t no_cell = ~std::size_t{0};

// Calls visit(at, cell, first, last) for each voxel that is a cell, or of which the boundary tells,
// in their order: the cell or no_cell, and the entries [first, last) of the boundary.
template <class Visit>
void each_solid_place(const SolidCells& cells, const BoundaryCells& boundary, const Visit& visit) {
    std::size_t n = 0, m = 0;
    while (n < cells.size() || m < boundary.size()) {
        const bool is_cell = m == boundary.size() ||
                             (n < cells.size() && place_of(cells, n) <= place_of(boundary, m));
        const Place at = is_cell ? place_of(cells, n) : place_of(boundary, m);
        const std::size_t first = m;
        while (m < boundary.size() && place_of(boundary, m) == at) ++m;
        visit(at, is_cell ? n : no_cell, first, m);
        n += is_cell;
    }
}

// Calls visit(b, n) for each entry b of the boundary that lies in a cell, n.
template <class Visit>
void each_bounded_cell(const SolidCells& cells, const BoundaryCells& boundary, const Visit& visit) {
    each_match(
        boundary.size(), [&](std::size_t b) { return place_of(boundary, b); }, cells.size(),
        [&](std::size_t n) { return place_of(cells, n); }, visit);
}

// The patches that were seen on each primitive.
class PatchesSeenOn {
  public:
    explicit PatchesSeenOn(std::span<const SurfacePatch> patches)
        : of_(primitives(patches), [&](const auto& add) {
              for (std::uint32_t n = 0; n < patches.size(); ++n)
                  if (patches[n].primitive >= 0)
                      add(static_cast<std::size_t>(patches[n].primitive), n);
          }) {}
    // Ascending; none where the primitive is -1.
    std::span<const std::uint32_t> operator()(std::int32_t primitive) const {
        const auto p = static_cast<std::size_t>(primitive);
        return primitive >= 0 && p < of_.size() ? of_[p] : std::span<const std::uint32_t>();
    }

  private:
    static std::size_t primitives(std::span<const SurfacePatch> patches) {
        std::int32_t most = 0;
        for (const SurfacePatch& patch : patches) most = std::max(most, patch.primitive + 1);
        return static_cast<std::size_t>(most);
    }
    Rows<std::uint32_t> of_;
};

}  // namespace topple::solids

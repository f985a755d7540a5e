// SPDX-License-Identifier: MIT
#include "solids/taken_away.h"

#include <algorithm>
#include <utility>

namespace topple {
namespace {

// The kept primitive that has most of a voxel, if that is at least half of it; -1: none has.
std::int32_t heir_of(const BoundaryCells& boundary, const std::vector<bool>& kept,
                     const Place& at) {
    std::int32_t heir = -1;
    std::uint32_t most = BoundaryCells::whole / 2 - 1;
    for (std::size_t n = first_at(boundary, at); n < boundary.size() && place_of(boundary, n) == at;
         ++n) {
        const std::int32_t p = boundary.primitive[n];
        if (!kept[p] || boundary.share[n] <= most) continue;
        most = boundary.share[n];
        heir = p;
    }
    return heir;
}

}  // namespace

TakenAway take_away(const SolidScene& solids, const std::vector<bool>& kept) {
    TakenAway out;
    std::vector<Role> roles;
    for (std::size_t p = 0; p < kept.size(); ++p) {
        out.number.push_back(kept[p] ? static_cast<std::int32_t>(roles.size()) : -1);
        if (kept[p]) roles.push_back(solids.role(static_cast<std::int32_t>(p)));
    }
    const auto number = [&](std::int32_t p) { return p < 0 ? -1 : out.number[p]; };
    const SolidCells& from = solids.cells();
    SolidCells cells;
    cells.voxel_m = from.voxel_m;
    for (std::size_t n = 0; n < from.size(); ++n) {
        const Place at = place_of(from, n);
        std::int32_t now = number(from.primitive[n]);
        if (from.primitive[n] >= 0 && now < 0) {
            now = number(heir_of(solids.boundary(), kept, at));
            out.changed.push_back({at, now});
            if (now < 0) continue;
        }
        cells.add(from, n, now);
    }
    std::vector<bool> left;
    for (const std::int32_t p : solids.boundary().primitive) left.push_back(number(p) >= 0);
    BoundaryCells boundary = solids.boundary().only(left);
    for (std::int32_t& p : boundary.primitive) p = number(p);
    for (SurfacePatch& patch : boundary.patches) patch.primitive = number(patch.primitive);
    out.solids = std::make_shared<const SolidScene>(std::move(cells), std::move(roles),
                                                    solids.strays(), std::move(boundary));
    return out;
}

}  // namespace topple

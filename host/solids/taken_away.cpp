// SPDX-License-Identifier: MIT
#include "solids/taken_away.h"

#include <algorithm>
#include <utility>

namespace topple {
namespace {

// The kept primitive that has most of a voxel, if that is at least half of it; -1: none has.
std::int32_t heir_of(const BoundaryCells& boundary, const std::vector<bool>& kept,
                     const std::array<std::int32_t, 3>& at) {
    const auto place = [&](std::size_t n) {
        return std::array{boundary.i[n], boundary.j[n], boundary.k[n]};
    };
    std::int32_t heir = -1;
    std::uint32_t most = BoundaryCells::whole / 2 - 1;
    for (std::size_t n = boundary.first_from(at[0], at[1], at[2], 0);
         n < boundary.size() && place(n) == at; ++n) {
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
        std::int32_t now = number(from.primitive[n]);
        if (from.primitive[n] >= 0 && now < 0) {
            const std::array at{from.i[n], from.j[n], from.k[n]};
            now = number(heir_of(solids.boundary(), kept, at));
            out.changed.push_back({at, now});
            if (now < 0) continue;
        }
        cells.i.push_back(from.i[n]);
        cells.j.push_back(from.j[n]);
        cells.k.push_back(from.k[n]);
        cells.primitive.push_back(now);
        cells.basis.push_back(from.basis[n]);
        if (!from.unseen_below.empty()) cells.unseen_below.push_back(from.unseen_below[n]);
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

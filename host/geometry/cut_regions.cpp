// SPDX-License-Identifier: MIT
#include <utility>

#include "geometry/merge.h"
#include "geometry/split.h"

namespace topple::geometry {

bool on_two_sides(const CutSides& a, const CutSides& b) {
    for (const auto& [cut, side] : a)
        for (const auto& [other, other_side] : b)
            if (cut == other && side != other_side) return true;
    return false;
}

CutRegions::CutRegions(const Regions& all)
    : regions(all),
      members(all.regions.size()),
      flush(all.regions.size()),
      ledges(all.regions.size()) {
    for (std::uint32_t i = 0; i < all.label.size(); ++i)
        if (all.label[i] >= 0) members[all.label[i]].push_back(i);
}

bool CutRegions::parted(std::size_t a, std::size_t b) const {
    return on_two_sides(flush[a], flush[b]) || on_two_sides(ledges[a], ledges[b]);
}

std::size_t CutRegions::take_out(const Surfels& surfels, std::size_t region,
                                 std::vector<std::uint32_t> part) {
    const std::size_t fresh = members.size();
    for (const std::uint32_t i : part) regions.label[i] = static_cast<std::int32_t>(fresh);
    std::erase_if(members[region], [&](std::uint32_t i) {
        return regions.label[i] == static_cast<std::int32_t>(fresh);
    });
    members.push_back(std::move(part));
    flush.push_back(flush[region]);
    ledges.push_back(ledges[region]);
    const int degree = regions.regions[region].model.degree;
    regions.regions[region] = fit_region(surfels, members[region], degree, surfels.cell_m);
    regions.regions.push_back(fit_region(surfels, members[fresh], degree, surfels.cell_m));
    return fresh;
}

}  // namespace topple::geometry

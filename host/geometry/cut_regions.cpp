// SPDX-License-Identifier: MIT
#include <cmath>
#include <iterator>
#include <utility>

#include "geometry/algebraic_model.h"
#include "geometry/merge.h"
#include "geometry/split.h"

namespace topple::geometry {
namespace {

Region fit(const Surfels& s, const std::vector<std::uint32_t>& members, int degree) {
    Region region;
    if (degree == 1) {
        PlaneMoments moments;
        for (const std::uint32_t i : members) moments.add(position(s, i), normal(s, i));
        region.model = fit_plane(moments, s.cell_m);
    } else {
        std::vector<Eigen::Vector3d> points, normals;
        for (const std::uint32_t i : members) {
            points.push_back(position(s, i));
            normals.push_back(normal(s, i));
        }
        region.model = fit_quadric(points, normals, s.cell_m);
    }
    double sum = 0;
    for (const std::uint32_t i : members) {
        const double d = distance(region.model, position(s, i));
        sum += d * d;
    }
    region.surfels = members.size();
    region.residual_m = std::sqrt(sum / static_cast<double>(members.size()));
    return region;
}

}  // namespace

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
        if (all.label[i] >= 0) members[static_cast<std::size_t>(all.label[i])].push_back(i);
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
    regions.regions[region] = fit(surfels, members[region], degree);
    regions.regions.push_back(fit(surfels, members[fresh], degree));
    return fresh;
}

}  // namespace topple::geometry

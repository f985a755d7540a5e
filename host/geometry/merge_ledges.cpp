// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "geometry/ledges.h"
#include "geometry/merge.h"
#include "geometry/region_facts.h"
#include "geometry/split.h"

namespace topple::geometry {
namespace {

// Below this a part of a region, in surfels, is noise at the ledge: less than half of a face.
constexpr std::size_t least_ledge_part = least_piece / 2;

}  // namespace

std::uint32_t cut_at_ledges(const Surfels& s, const Vec3& upwards,
                            const std::vector<std::int32_t>& solid, CutRegions& cuts,
                            RegionFacts& facts, ThreadPool& threads) {
    const Eigen::Vector3d up(upwards[0], upwards[1], upwards[2]);
    std::map<std::int32_t, std::vector<std::size_t>> regions_of_root;
    for (std::size_t k = 0; k < solid.size(); ++k)
        if (!cuts.members[k].empty()) regions_of_root[solid[k]].push_back(k);
    std::vector<std::vector<std::size_t>> regions_of;
    for (auto& [root, regions] : regions_of_root) regions_of.push_back(std::move(regions));
    std::vector<std::size_t> surfels(regions_of.size(), 0);
    for (std::size_t n = 0; n < regions_of.size(); ++n)
        for (const std::size_t k : regions_of[n]) surfels[n] += cuts.members[k].size();
    std::vector<std::optional<double>> ledge(regions_of.size());
    threads.each_largest_first(surfels, [&](std::size_t n) {
        std::vector<std::uint32_t> members;
        members.reserve(surfels[n]);
        for (const std::size_t k : regions_of[n])
            members.insert(members.end(), cuts.members[k].begin(), cuts.members[k].end());
        ledge[n] = find_ledge(s, members, up);
    });
    const std::uint32_t before = cuts.count;
    std::vector<std::int32_t> changed;
    for (std::size_t n = 0; n < regions_of.size(); ++n) {
        if (!ledge[n]) continue;
        for (const std::size_t k : regions_of[n]) {
            changed.push_back(static_cast<std::int32_t>(k));
            std::vector<std::uint32_t> above;
            for (const std::uint32_t i : cuts.members[k])
                if (up.dot(position(s, i)) > *ledge[n]) above.push_back(i);
            const std::size_t below = cuts.members[k].size() - above.size();
            if (std::min(above.size(), below) < least_ledge_part) {
                cuts.ledges[k].emplace_back(cuts.count, above.size() > below);
                continue;
            }
            const std::size_t fresh = cuts.take_out(s, k, std::move(above));
            cuts.ledges[k].emplace_back(cuts.count, false);
            cuts.ledges[fresh].emplace_back(cuts.count, true);
            changed.push_back(static_cast<std::int32_t>(fresh));
        }
        ++cuts.count;
    }
    if (!changed.empty()) facts.update(changed);
    return cuts.count - before;
}

}  // namespace topple::geometry

// SPDX-License-Identifier: MIT
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/rows.h"
#include "solids/explaining.h"
#include "solids/patch_map.h"
#include "solids/patches.h"

namespace topple::solids {
namespace {

using Beside = std::pair<std::int32_t, std::size_t>;  // a patch, how many points are near it

Eigen::Vector3d normal_of(const SurfacePatch& patch, const Eigen::Vector3d& p) {
    const Vec3 g = patch.gradient({p.x(), p.y(), p.z()});
    return Eigen::Vector3d(g[0], g[1], g[2]).normalized();
}

// Whether a patch is the rounded edge of two much larger ones, A and B: where depth readings of
// both sides mix, its points lie between them. All of them are near both, and it faces between
// them.
bool is_edge(const Eigen::Vector3d& normal, std::span<const Eigen::Vector3d> beside) {
    const auto angle = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
        return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
    };
    constexpr double slack = 0.26, least = 0.5, most = 2.6;  // radians
    for (std::size_t a = 0; a < beside.size(); ++a) {
        for (std::size_t b = a + 1; b < beside.size(); ++b) {
            const double whole = angle(beside[a], beside[b]);
            if (whole > least && whole < most &&
                angle(beside[a], normal) + angle(normal, beside[b]) < whole + slack)
                return true;
        }
    }
    return false;
}

}  // namespace

void drop_explained(const GridPoints& points, std::span<const SurfacePatch> patches, double cell_m,
                    PointLabels& labels, ThreadPool& threads) {
    constexpr double explained = 0.8;       // share of its points that makes a patch none
    constexpr std::size_t looked_at = 200;  // of them
    constexpr std::size_t much_larger = 4;
    const auto members = places_by_label(labels.patch, patches.size());
    const PatchMap map(points, labels.patch, labels.patch, cell_m, threads);
    const std::vector<std::int32_t> primitive = labels.primitive_of_patch(patches.size());
    // The patch of more points that lies nearest to a point, within its noise; -1 where none does.
    // Those of fewer points were asked before, and may be dropped.
    const auto explain = [&](const Eigen::Vector3d& p, std::int32_t own,
                             std::span<const std::int32_t> near) {
        const auto rank = [&](std::int32_t patch) {
            return std::pair(members[patch].size(), patch);
        };
        const auto mine = rank(own);
        return explaining(patches, near, p, [&](std::int32_t other) { return rank(other) > mine; });
    };
    // A patch asks only those of more points, each of which stands until its own turn: in whatever
    // order they are asked, the answers are the same.
    threads.run(patches.size(), 4, [&](std::uint64_t from, std::uint64_t to) {
        std::vector<std::int32_t> room;
        std::vector<Beside> beside;
        for (std::uint64_t p = from; p < to; ++p) {
            const auto own = static_cast<std::int32_t>(p);
            const std::span<const std::uint32_t> mine = members[p];
            std::size_t looked = 0, met = 0;
            beside.clear();  // much larger patches: points near them
            Eigen::Vector3d middle = Eigen::Vector3d::Zero();
            for (const std::uint32_t n : mine) {
                if (!points.is_chosen(n, mine.size() / looked_at + 1)) continue;
                ++looked;
                const Eigen::Vector3d at = points[n];
                middle += at;
                const std::span<const std::int32_t> near = map.around(at, room);
                met += explain(at, own, near) >= 0;
                for (const std::int32_t other : near) {
                    const auto o = static_cast<std::size_t>(other);
                    if (members[o].size() <= much_larger * mine.size() ||
                        !(std::abs(distance_to(patches[o], at)) < cell_m / 2))
                        continue;
                    const auto known = std::ranges::find(beside, other, &Beside::first);
                    if (known == beside.end())
                        beside.emplace_back(other, 1);
                    else
                        ++known->second;
                }
            }
            if (looked == 0) continue;
            const double enough = explained * static_cast<double>(looked);
            middle /= static_cast<double>(looked);
            std::vector<Eigen::Vector3d> sides;
            for (const auto& [other, count] : beside) {
                if (static_cast<double>(count) >= enough)
                    sides.push_back(normal_of(patches[other], middle));
            }
            if (static_cast<double>(met) < enough && !is_edge(normal_of(patches[p], middle), sides))
                continue;
            for (const std::uint32_t n : mine) {
                const Eigen::Vector3d at = points[n];
                const std::int32_t other = explain(at, own, map.around(at, room));
                labels.patch[n] = other;
                if (other >= 0) labels.primitive[n] = primitive[other];
            }
        }
    });
}

}  // namespace topple::solids

// SPDX-License-Identifier: MIT
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "solids/explaining.h"
#include "solids/grid_points.h"
#include "solids/patch_map.h"
#include "solids/patches.h"

namespace topple::solids {
namespace {

Eigen::Vector3d normal_of(const SurfacePatch& patch, const Eigen::Vector3d& p) {
    const Vec3 g = patch.gradient({p.x(), p.y(), p.z()});
    return Eigen::Vector3d(g[0], g[1], g[2]).normalized();
}

// The patch of more points that lies nearest to a point, within its noise; -1 where none does.
struct Explainer {
    std::span<const SurfacePatch> patches;
    const std::vector<std::size_t>& points;  // of each patch
    const std::vector<bool>& dropped;

    std::int32_t operator()(const Eigen::Vector3d& p, std::int32_t own,
                            std::span<const std::int32_t> near) const {
        const auto mine = std::pair(points[static_cast<std::size_t>(own)], own);
        return explaining(patches, near, p, [&](std::int32_t other) {
            const auto o = static_cast<std::size_t>(other);
            return other != own && !dropped[o] && std::pair(points[o], other) >= mine;
        });
    }
};

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

void drop_explained(const CloudView& cloud, std::span<const SurfacePatch> patches,
                    const std::array<Vec3, 3>& axes, double cell_m,
                    std::vector<std::int32_t>& primitive_of_point,
                    std::vector<std::int32_t>& patch_of_point) {
    constexpr double explained = 0.8;       // share of its points that makes a patch none
    constexpr std::size_t looked_at = 200;  // of them
    constexpr std::size_t much_larger = 4;
    std::vector<std::vector<std::uint32_t>> members(patches.size());
    PatchMap map(cell_m);
    const auto point = [&](std::size_t n) {
        return rotated(axes, cloud.x[n], cloud.y[n], cloud.z[n]);
    };
    for (std::size_t n = 0; n < patch_of_point.size(); ++n) {
        if (patch_of_point[n] < 0) continue;
        members[static_cast<std::size_t>(patch_of_point[n])].push_back(
            static_cast<std::uint32_t>(n));
        map.add(point(n), patch_of_point[n]);
    }
    std::vector<std::size_t> size, order(patches.size());
    for (const auto& m : members) size.push_back(m.size());
    std::vector<std::int32_t> primitive(patches.size(), -1);
    for (std::size_t p = 0; p < patches.size(); ++p)
        for (const std::uint32_t n : members[p])
            primitive[p] = std::max(primitive[p], primitive_of_point[n]);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t p) { return size[p]; });
    std::vector<bool> dropped(patches.size(), false);
    const Explainer explain{patches, size, dropped};
    std::vector<std::int32_t> near;
    for (const std::size_t p : order) {
        const auto own = static_cast<std::int32_t>(p);
        std::size_t looked = 0, met = 0;
        std::map<std::int32_t, std::size_t> beside;  // much larger patches: points near them
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (const std::uint32_t n : members[p]) {
            if (!is_chosen(cloud, n, size[p] / looked_at + 1)) continue;
            ++looked;
            const Eigen::Vector3d at = point(n);
            middle += at;
            map.around(at, near);
            met += explain(at, own, near) >= 0;
            for (const std::int32_t other : near) {
                const auto o = static_cast<std::size_t>(other);
                if (!dropped[o] && size[o] > much_larger * size[p])
                    beside[other] += std::abs(distance_to(patches[o], at)) < cell_m / 2;
            }
        }
        if (looked == 0) continue;
        const double enough = explained * static_cast<double>(looked);
        middle /= static_cast<double>(looked);
        std::vector<Eigen::Vector3d> sides;
        for (const auto& [other, count] : beside) {
            if (static_cast<double>(count) >= enough)
                sides.push_back(normal_of(patches[static_cast<std::size_t>(other)], middle));
        }
        if (static_cast<double>(met) < enough && !is_edge(normal_of(patches[p], middle), sides))
            continue;
        for (const std::uint32_t n : members[p]) {
            const Eigen::Vector3d at = point(n);
            map.around(at, near);
            const std::int32_t other = explain(at, own, near);
            patch_of_point[n] = other;
            if (other >= 0) primitive_of_point[n] = primitive[static_cast<std::size_t>(other)];
        }
        dropped[p] = true;
    }
}

}  // namespace topple::solids

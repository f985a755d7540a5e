// SPDX-License-Identifier: MIT
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "core/union_find.h"
#include "solids/explaining.h"
#include "solids/grid_points.h"
#include "solids/patch_map.h"
#include "solids/patches.h"
#include "solids/plane_through.h"

namespace topple::solids {
namespace {

// A point of a primitive that no patch explains.
struct Left {
    std::int32_t primitive;
    std::array<std::int32_t, 3> cell;
    Eigen::Vector3d at;
    std::uint32_t point;
    auto order() const { return std::tuple(primitive, cell, at.x(), at.y(), at.z()); }
};

// A primitive in a cell, and in the cells around.
using Key = std::pair<std::int32_t, std::array<std::int32_t, 3>>;
std::array<Key, 27> around(const Key& key) {
    std::array<Key, 27> out;
    for (std::int32_t n = 0; n < 27; ++n)
        out[static_cast<std::size_t>(n)] = {
            key.first,
            {key.second[0] + n / 9 - 1, key.second[1] + n / 3 % 3 - 1, key.second[2] + n % 3 - 1}};
    return out;
}

// Sorted by order(): of each the number of the piece that hangs together over cells.
std::vector<std::size_t> pieces_of(std::span<const Left> left) {
    std::map<Key, std::size_t> first;
    UnionFind pieces(left.size());
    for (std::size_t n = 0; n < left.size(); ++n)
        pieces.join(n, first.try_emplace({left[n].primitive, left[n].cell}, n).first->second);
    for (const auto& [key, n] : first) {
        for (const Key& beside : around(key)) {
            const auto found = first.find(beside);
            if (found != first.end()) pieces.join(n, found->second);
        }
    }
    std::vector<std::size_t> out(left.size());
    for (std::size_t n = 0; n < left.size(); ++n) out[n] = pieces.root(n);
    return out;
}

// The plane through a piece's points, which faces nowhere yet.
SurfacePatch patch_through(std::span<const Eigen::Vector3d> points) {
    const PlaneThrough plane(points);
    const auto count = static_cast<double>(points.size());
    return fit_patch(plane.model(), std::sqrt(plane.squares[0] / count), points);
}

// A narrow face that may be, and how much of its primitive lies before and behind it nearby.
struct Face {
    SurfacePatch patch;
    std::int32_t primitive;
    std::vector<std::uint32_t> points;
    std::size_t before = 0, behind = 0;
};

}  // namespace

void add_narrow_faces(const CloudView& cloud, const std::array<Vec3, 3>& axes, double cell_m,
                      std::vector<SurfacePatch>& patches,
                      std::vector<std::int32_t>& primitive_of_point,
                      std::vector<std::int32_t>& patch_of_point) {
    PatchMap map(cell_m);
    const auto point = [&](std::size_t n) {
        return rotated(axes, cloud.x[n], cloud.y[n], cloud.z[n]);
    };
    std::vector<std::int32_t> primitive(patches.size(), -1);
    std::vector<std::uint32_t> off;
    for (std::size_t n = 0; n < patch_of_point.size(); ++n) {
        if (primitive_of_point[n] < 0) continue;
        if (patch_of_point[n] < 0) {
            off.push_back(static_cast<std::uint32_t>(n));
            continue;
        }
        const auto patch = static_cast<std::size_t>(patch_of_point[n]);
        primitive[patch] = std::max(primitive[patch], primitive_of_point[n]);
        const Eigen::Vector3d at = point(n);
        map.add(at, patch_of_point[n]);
        if (std::abs(distance_to(patches[patch], at)) > outlier * patches[patch].noise_m)
            off.push_back(static_cast<std::uint32_t>(n));
    }
    std::vector<Left> left;
    std::vector<std::int32_t> near;
    for (const std::uint32_t n : off) {
        const Eigen::Vector3d at = point(n);
        map.around(at, near);
        const std::int32_t other = explaining(patches, near, at, [](std::int32_t) { return true; });
        if (other >= 0) {
            patch_of_point[n] = other;
            primitive_of_point[n] = primitive[static_cast<std::size_t>(other)];
        } else {
            left.push_back({primitive_of_point[n], map.cell_of(at), at, n});
        }
    }
    std::ranges::sort(left, {}, &Left::order);
    const std::vector<std::size_t> piece = pieces_of(left);
    std::map<std::size_t, std::vector<std::size_t>> members;
    for (std::size_t n = 0; n < left.size(); ++n) members[piece[n]].push_back(n);
    std::vector<Face> faces;
    std::map<Key, std::vector<std::size_t>> beside;  // faces around cells of a primitive
    for (const auto& [number, all] : members) {
        if (all.size() < least_points) continue;
        constexpr double enough = 0.8;  // share of the points that the plane explains
        std::vector<Eigen::Vector3d> points;
        for (const std::size_t n : all) points.push_back(left[n].at);
        Face face{patch_through(points), left[number].primitive, {}};
        for (const std::size_t n : all)
            if (std::abs(distance_to(face.patch, left[n].at)) <= outlier * face.patch.noise_m)
                face.points.push_back(left[n].point);
        if (static_cast<double>(face.points.size()) < enough * static_cast<double>(all.size()))
            continue;
        double noise = 0;  // the primitive's own here
        for (const std::size_t n : all) {
            map.around(left[n].at, near);
            for (const std::int32_t p : near)
                if (primitive[static_cast<std::size_t>(p)] == face.primitive)
                    noise = std::max(noise, patches[static_cast<std::size_t>(p)].noise_m);
        }
        if (face.patch.noise_m > noise) continue;
        for (const std::size_t n : all)
            for (const Key& key : around({face.primitive, left[n].cell}))
                if (beside[key].empty() || beside[key].back() != faces.size())
                    beside[key].push_back(faces.size());
        faces.push_back(std::move(face));
    }
    if (faces.empty()) return;
    for (std::size_t n = 0; n < patch_of_point.size(); ++n) {
        if (patch_of_point[n] < 0) continue;
        const Eigen::Vector3d at = point(n);
        const auto found = beside.find({primitive_of_point[n], map.cell_of(at)});
        if (found == beside.end()) continue;
        for (const std::size_t f : found->second) {
            const double d = distance_to(faces[f].patch, at),
                         rim = outlier * faces[f].patch.noise_m;
            faces[f].before += d > rim;
            faces[f].behind += d < -rim;
        }
    }
    for (Face& face : faces) {
        constexpr double most_before = 0.05;  // share
        if (face.before > face.behind) {
            for (double& c : face.patch.c) c = -c;
            std::swap(face.before, face.behind);
        }
        if (static_cast<double>(face.before) > most_before * static_cast<double>(face.behind))
            continue;
        for (const std::uint32_t n : face.points)
            patch_of_point[n] = static_cast<std::int32_t>(patches.size());
        patches.push_back(face.patch);
    }
}

}  // namespace topple::solids

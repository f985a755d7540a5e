// SPDX-License-Identifier: MIT
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "core/sort_unique.h"
#include "core/union_find.h"
#include "solids/explaining.h"
#include "solids/patch_map.h"
#include "solids/patches.h"
#include "solids/plane_through.h"

namespace topple::solids {
namespace {

// A point of a primitive that no patch explains.
struct Left {
    std::int32_t primitive;
    Place cell;
    Eigen::Vector3d at;
    std::uint32_t point;
    auto order() const { return std::tuple(primitive, cell, at.x(), at.y(), at.z()); }
};

// A primitive in a cell.
using Key = std::pair<std::int32_t, Place>;

// A key, and the first place that has it.
using FirstOfKey = std::pair<Key, std::size_t>;

// Sorted by order(): of each the number of the piece that hangs together over cells.
std::vector<std::size_t> pieces_of(std::span<const Left> left) {
    std::vector<FirstOfKey> first;  // sorted
    UnionFind pieces(left.size());
    for (std::size_t n = 0; n < left.size(); ++n) {
        const Key key{left[n].primitive, left[n].cell};
        if (first.empty() || first.back().first != key) first.emplace_back(key, n);
        pieces.join(n, first.back().second);
    }
    for (const auto& [key, n] : first) {
        for (const Place& cell : around(key.second)) {
            const Key beside(key.first, cell);
            if (!(beside < key)) continue;  // which finds this one
            const auto found = std::ranges::lower_bound(first, beside, {}, &FirstOfKey::first);
            if (found != first.end() && found->first == beside) pieces.join(n, found->second);
        }
    }
    std::vector<std::size_t> out(left.size());
    for (std::size_t n = 0; n < left.size(); ++n) out[n] = pieces.root(n);
    return out;
}

// Of a piece's places in `left`, which ascend, the first in each cell: however many points lie
// there.
std::vector<std::size_t> firsts_of_cells(std::span<const Left> left,
                                         std::span<const std::size_t> all) {
    std::vector<std::size_t> out;
    for (const std::size_t n : all)
        if (out.empty() || left[n].cell != left[out.back()].cell) out.push_back(n);
    return out;
}

// The plane through a piece's points, which faces nowhere yet.
SurfacePatch patch_through(std::span<const Eigen::Vector3d> points) {
    const PlaneThrough plane(points);
    const auto count = static_cast<double>(points.size());
    return fit_patch(plane.model(), std::sqrt(plane.squares[0] / count), points);
}

// A narrow face that may be, and how much of its primitive lies before and behind it nearby.
struct NarrowFace {
    SurfacePatch patch;
    std::int32_t primitive;
    std::vector<std::uint32_t> points;
    std::size_t before = 0, behind = 0;
};

constexpr std::uint64_t point_chunk = 1 << 14;  // points handed to a thread at once

// The cells of a primitive around which there are faces, and which, sorted; each once.
using FaceNear = std::pair<Key, std::size_t>;

// Counts for each face the points of its primitive nearby that lie before and behind it.
void count_sides(const GridPoints& points, const PatchMap& map, std::span<const FaceNear> beside,
                 const PointLabels& labels, std::span<NarrowFace> faces, ThreadPool& threads) {
    std::vector<bool> asked;  // by primitive
    for (const NarrowFace& face : faces) {
        const auto p = static_cast<std::size_t>(face.primitive);
        if (asked.size() <= p) asked.resize(p + 1, false);
        asked[p] = true;
    }
    struct Count {
        std::size_t before = 0, behind = 0;
    };
    std::vector<std::vector<Count>> parts(points.size() / point_chunk + 1);
    threads.run(points.size(), point_chunk, [&](std::uint64_t first, std::uint64_t last) {
        std::vector<Count>& part = parts[first / point_chunk];
        part.resize(faces.size());
        for (std::uint64_t n = first; n < last; ++n) {
            const auto p = static_cast<std::size_t>(labels.primitive[n]);
            if (labels.patch[n] < 0 || p >= asked.size() || !asked[p]) continue;
            const Eigen::Vector3d at = points[n];
            const Key key{labels.primitive[n], map.cell_of(at)};
            for (auto near = std::ranges::lower_bound(beside, key, {}, &FaceNear::first);
                 near != beside.end() && near->first == key; ++near) {
                const SurfacePatch& patch = faces[near->second].patch;
                const double d = distance_to(patch, at), rim = outlier * patch.noise_m;
                part[near->second].before += d > rim;
                part[near->second].behind += d < -rim;
            }
        }
    });
    for (const std::vector<Count>& part : parts) {
        for (std::size_t f = 0; f < part.size(); ++f) {
            faces[f].before += part[f].before;
            faces[f].behind += part[f].behind;
        }
    }
}

}  // namespace

void add_narrow_faces(const GridPoints& points, double cell_m, std::vector<SurfacePatch>& patches,
                      PointLabels& labels, ThreadPool& threads) {
    const PatchMap map(points, labels.patch, labels.primitive, cell_m, threads);
    const std::vector<std::int32_t> primitive = labels.primitive_of_patch(patches.size());
    std::vector<std::vector<Left>> parts(points.size() / point_chunk + 1);
    threads.run(points.size(), point_chunk, [&](std::uint64_t first, std::uint64_t last) {
        std::vector<std::int32_t> room;
        for (std::uint64_t n = first; n < last; ++n) {
            if (labels.primitive[n] < 0) continue;
            const Eigen::Vector3d at = points[n];
            if (labels.patch[n] >= 0) {
                const SurfacePatch& own = patches[labels.patch[n]];
                if (!(std::abs(distance_to(own, at)) > outlier * own.noise_m)) continue;
            }
            const std::int32_t other =
                explaining(patches, map.around(at, room), at, [](std::int32_t) { return true; });
            if (other >= 0) {
                labels.patch[n] = other;
                labels.primitive[n] = primitive[other];
            } else {
                parts[first / point_chunk].push_back(
                    {labels.primitive[n], map.cell_of(at), at, static_cast<std::uint32_t>(n)});
            }
        }
    });
    std::vector<Left> left = joined(parts);
    std::ranges::sort(left, {}, &Left::order);
    const std::vector<std::size_t> piece = pieces_of(left);
    std::map<std::size_t, std::vector<std::size_t>> members;
    for (std::size_t n = 0; n < left.size(); ++n) members[piece[n]].push_back(n);
    std::vector<NarrowFace> faces;
    std::vector<FaceNear> beside;
    std::vector<std::int32_t> room;
    for (const auto& [number, all] : members) {
        if (all.size() < least_points) continue;
        const std::vector<std::size_t> one_a_cell = firsts_of_cells(left, all);
        constexpr double enough = 0.8;  // share of the points that the plane explains
        std::vector<Eigen::Vector3d> own;
        for (const std::size_t n : all) own.push_back(left[n].at);
        NarrowFace face{patch_through(own), left[number].primitive, {}};
        for (const std::size_t n : all)
            if (std::abs(distance_to(face.patch, left[n].at)) <= outlier * face.patch.noise_m)
                face.points.push_back(left[n].point);
        if (static_cast<double>(face.points.size()) < enough * static_cast<double>(all.size()))
            continue;
        double noise = 0;  // the primitive's own here
        for (const std::size_t n : one_a_cell) {
            for (const std::int32_t p : map.around(left[n].at, room))
                if (primitive[p] == face.primitive) noise = std::max(noise, patches[p].noise_m);
        }
        if (face.patch.noise_m > noise) continue;
        for (const std::size_t n : one_a_cell)
            for (const Place& cell : around(left[n].cell))
                beside.emplace_back(Key(face.primitive, cell), faces.size());
        faces.push_back(std::move(face));
    }
    if (faces.empty()) return;
    sort_unique(beside);
    count_sides(points, map, beside, labels, faces, threads);
    for (NarrowFace& face : faces) {
        constexpr double most_before = 0.05;  // share
        if (face.before > face.behind) {
            for (double& c : face.patch.c) c = -c;
            std::swap(face.before, face.behind);
        }
        if (static_cast<double>(face.before) > most_before * static_cast<double>(face.behind))
            continue;
        for (const std::uint32_t n : face.points)
            labels.patch[n] = static_cast<std::int32_t>(patches.size());
        patches.push_back(face.patch);
    }
}

}  // namespace topple::solids

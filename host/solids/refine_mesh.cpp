// SPDX-License-Identifier: MIT
#include "solids/refine_mesh.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <tuple>

#include "core/vectors.h"
#include "solids/meeting_point.h"

namespace topple::solids {
namespace {

constexpr std::uint32_t no_vertex = std::numeric_limits<std::uint32_t>::max();

// An edge of a triangle, from its corner `slot` to the next.
struct Edge {
    std::uint32_t low, high, triangle;
    std::uint8_t slot;
    auto order() const { return std::tuple(low, high, triangle); }
};

bool is_curved(const Facet& facet, std::span<const SurfacePatch> patches) {
    return facet.patch != no_patch && !patches[facet.patch].flat();
}

// The edges with a curved patch on one side or both, two by two.
std::vector<Edge> curved_edges(const SurfaceMesh& mesh, std::span<const SurfacePatch> patches) {
    std::vector<bool> at_curve(mesh.vertex.size(), false);
    for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
        if (!is_curved(mesh.facet[t], patches)) continue;
        for (const std::uint32_t v : mesh.triangle[t]) at_curve[v] = true;
    }
    std::vector<Edge> out;
    for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t) {
        for (std::uint8_t n = 0; n < 3; ++n) {
            const std::uint32_t a = mesh.triangle[t][n], b = mesh.triangle[t][(n + 1) % 3];
            if (at_curve[a] && at_curve[b]) out.push_back({std::min(a, b), std::max(a, b), t, n});
        }
    }
    std::ranges::sort(out, {}, &Edge::order);
    return out;
}

// The new vertex in the middle of each triangle's edges.
using Middles = std::vector<std::array<std::uint32_t, 3>>;

// On the patches of two triangles, where their edge is to be split; none where it is straight.
std::optional<Vec3> bent_middle(const SurfaceMesh& mesh, const Edge& one, const Edge& other,
                                std::span<const SurfacePatch> patches, double voxel_m,
                                const MeetingPoint& meet) {
    constexpr double tolerance = 0.01;  // of a voxel
    constexpr double furthest = 0.4;    // of the edge: what bends more is no arc
    const Facet &f = mesh.facet[one.triangle], &g = mesh.facet[other.triangle];
    if (f.patch == no_patch || g.patch == no_patch ||
        (!is_curved(f, patches) && !is_curved(g, patches)))
        return std::nullopt;
    const Vec3 &a = mesh.vertex[one.low], &b = mesh.vertex[one.high];
    const Vec3 middle{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
    const std::array of{std::min(f.patch, g.patch), std::max(f.patch, g.patch)};
    const Vec3 on = meet(std::span(of).first(f.patch == g.patch ? 1 : 2), middle, middle);
    const double off = length(minus(on, middle));
    if (!(off > tolerance * voxel_m) || off > furthest * length(minus(a, b))) return std::nullopt;
    return on;
}

Middles add_middles(SurfaceMesh& mesh, std::span<const SurfacePatch> patches, double voxel_m,
                    ThreadPool& pool) {
    constexpr std::uint64_t chunk = 1 << 11;  // edges handed to a thread at once
    const std::vector<Edge> edges = curved_edges(mesh, patches);
    const MeetingPoint meet(patches, voxel_m);
    std::vector<std::optional<Vec3>> on(edges.size() / 2);
    pool.each(on.size(), chunk, [&](std::size_t n) {
        on[n] = bent_middle(mesh, edges[2 * n], edges[2 * n + 1], patches, voxel_m, meet);
    });
    Middles out(mesh.triangle.size(), {no_vertex, no_vertex, no_vertex});
    for (std::size_t n = 0; n < on.size(); ++n) {
        if (!on[n]) continue;
        const Edge &one = edges[2 * n], &other = edges[2 * n + 1];
        out[one.triangle][one.slot] = out[other.triangle][other.slot] =
            static_cast<std::uint32_t>(mesh.vertex.size());
        mesh.vertex.push_back(*on[n]);
        mesh.corner.push_back(mesh.corner[one.low]);
    }
    return out;
}

// Splits a triangle at the middles of its edges.
void split(std::size_t t, const std::array<std::uint32_t, 3>& middle, SurfaceMesh& mesh) {
    const auto added = 3 - std::ranges::count(middle, no_vertex);
    if (added == 0) return;
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        mesh.triangle.push_back({a, b, c});
        mesh.facet.push_back(mesh.facet[t]);
    };
    // Turned so that its first edge is split and, where two are, its last one is not.
    std::size_t turn = 0;
    while (middle[turn] == no_vertex || (added == 2 && middle[(turn + 2) % 3] != no_vertex)) ++turn;
    const auto corner = [&](std::size_t n) { return mesh.triangle[t][(turn + n) % 3]; };
    const std::uint32_t a = corner(0), b = corner(1), c = corner(2), ab = middle[turn],
                        bc = middle[(turn + 1) % 3], ca = middle[(turn + 2) % 3];
    if (added == 1) {
        add(ab, b, c);
        mesh.triangle[t] = {a, ab, c};
    } else if (added == 2) {
        add(ab, b, bc);
        add(ab, bc, c);
        mesh.triangle[t] = {a, ab, c};
    } else {
        add(ab, b, bc);
        add(bc, c, ca);
        add(ab, bc, ca);
        mesh.triangle[t] = {a, ab, ca};
    }
}

}  // namespace

void refine(SurfaceMesh& mesh, std::span<const SurfacePatch> patches, double voxel_m,
            ThreadPool& pool) {
    constexpr int rounds = 2;  // a voxel's edge in four
    for (int round = 0; round < rounds; ++round) {
        const Middles middles = add_middles(mesh, patches, voxel_m, pool);
        for (std::size_t t = 0; t < middles.size(); ++t) split(t, middles[t], mesh);
    }
}

}  // namespace topple::solids

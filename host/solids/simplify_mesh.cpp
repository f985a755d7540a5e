// SPDX-License-Identifier: MIT
#include "solids/simplify_mesh.h"

#include <algorithm>
#include <cmath>
#include <memory_resource>
#include <numeric>
#include <utility>

#include "core/vectors.h"
#include "geometry/cell_grid.h"
#include "solids/error_quadric.h"
#include "solids/vertex_rings.h"

namespace topple::solids {
namespace {

class Simplifier {
  public:
    Simplifier(SurfaceMesh& mesh, std::span<const SurfacePatch> patches,
               const SimplifyOptions& options)
        : mesh_(mesh),
          patches_(patches),
          most_(options.tolerance_m * options.tolerance_m),
          longest_(options.longest_m > 0 ? options.longest_m * options.longest_m : INFINITY),
          around_(mesh) {}

    // Of the planes of the mesh as it is.
    void find_quadrics(ThreadPool& pool) {
        constexpr std::uint64_t chunk = 1 << 12;
        std::vector<Vec3> normal(mesh_.triangle.size());
        pool.each(normal.size(), chunk, [&](std::size_t t) {
            if (!is_curved(t))
                normal[t] = normal_at(static_cast<std::uint32_t>(t), mesh_.triangle[t][0]);
        });
        quadric_.resize(around_.size());
        pool.each(around_.size(), chunk,
                  [&](std::size_t v) { add_planes(static_cast<std::uint32_t>(v), normal); });
    }

    // First within blocks, by all threads: what lies in one of them with all around it depends on
    // nothing outside. Then what is left, at their borders mostly.
    void run(ThreadPool& pool) {
        asked_.assign(around_.size(), 0);
        changed_.assign(around_.size(), 0);
        if (around_.size() == 0) return;
        const geometry::KeyGroups blocks = geometry::group_cells(
            around_.size(), [&](std::size_t v) { return block_of(v); }, pool);
        std::vector<Workspace> work(blocks.size() + 1);
        pool.each(blocks.size(), 1, [&](std::size_t b) {
            std::vector<std::uint32_t> inner;
            for (const std::uint32_t v : blocks.group(b))
                if (is_inner(v)) inner.push_back(v);
            merge_among(std::move(inner), work[b]);
        });
        changed_.assign(around_.size(), 0);
        std::vector<std::uint32_t> all(around_.size());
        std::iota(all.begin(), all.end(), 0U);
        merge_among(std::move(all), work.back());
    }

    // Takes what is no longer used out of the mesh.
    void compact() {
        std::vector<std::uint32_t> number(mesh_.vertex.size());
        std::uint32_t vertices = 0;
        for (std::uint32_t v = 0; v < around_.size(); ++v) {
            if (around_[v].empty()) continue;
            mesh_.vertex[vertices] = mesh_.vertex[v];
            mesh_.corner[vertices] = mesh_.corner[v];
            number[v] = vertices++;
        }
        std::size_t triangles = 0;
        for (std::size_t t = 0; t < mesh_.triangle.size(); ++t) {
            const auto [a, b, c] = mesh_.triangle[t];
            if (a == b) continue;
            mesh_.triangle[triangles] = {number[a], number[b], number[c]};
            mesh_.facet[triangles++] = mesh_.facet[t];
        }
        mesh_.vertex.resize(vertices);
        mesh_.corner.resize(vertices);
        mesh_.triangle.resize(triangles);
        mesh_.facet.resize(triangles);
    }

  private:
    Vec3 area(const std::array<std::uint32_t, 3>& t) const {
        const Vec3& p = mesh_.vertex[t[0]];
        return cross(minus(mesh_.vertex[t[1]], p), minus(mesh_.vertex[t[2]], p));
    }
    // The vertices after v in a triangle, going round, and before it.
    static std::uint32_t after(const std::array<std::uint32_t, 3>& t, std::uint32_t v) {
        return t[0] == v ? t[1] : t[1] == v ? t[2] : t[0];
    }
    static std::uint32_t before(const std::array<std::uint32_t, 3>& t, std::uint32_t v) {
        return t[0] == v ? t[2] : t[1] == v ? t[0] : t[1];
    }

    static Vec3 side_of(const Facet& facet) {
        Vec3 out{};
        out[facet.direction / 2] = facet.direction % 2 ? 1 : -1;
        return out;
    }
    // The direction that triangle t, of corners `own`, should face: its patch's at a place, so that
    // folds are smoothed out; without one its own, or its voxel's side's where it is but a line.
    Vec3 outside_of(std::uint32_t t, const std::array<std::uint32_t, 3>& own,
                    const Vec3& at) const {
        constexpr double line = 0.05;  // height over the longest side
        if (mesh_.facet[t].patch != no_patch) return outwards(mesh_.facet[t], patches_, at);
        const Vec3 out = area(own);
        return length(out) > line * longest_side(own) ? out : side_of(mesh_.facet[t]);
    }
    // Squared.
    double longest_side(const std::array<std::uint32_t, 3>& t) const {
        double out = 0;
        for (std::size_t n = 0; n < 3; ++n) {
            const Vec3 edge = minus(mesh_.vertex[t[n]], mesh_.vertex[t[(n + 1) % 3]]);
            out = std::max(out, dot(edge, edge));
        }
        return out;
    }

    bool is_curved(std::size_t t) const {
        const std::uint32_t patch = mesh_.facet[t].patch;
        return patch != no_patch && !patches_[patch].flat();
    }
    Vec3 normal_at(std::uint32_t t, std::uint32_t v) const {
        return unit(outside_of(t, mesh_.triangle[t], mesh_.vertex[v]));
    }

    // normal_of: triangles; 0 of those on curved patches.
    void add_planes(std::uint32_t v, std::span<const Vec3> normal_of) {
        // How much further than from a patch a vertex may be from what no patch tells of.
        constexpr double unknown = 20;
        const bool bordered = is_bordered(v);
        for (const std::uint32_t t : around_[v]) {
            const bool known = mesh_.facet[t].patch != no_patch;
            const Vec3& at = mesh_.vertex[v];
            const Vec3 normal = normal_of[t] == Vec3{} ? normal_at(t, v) : normal_of[t];
            Vec3 counted = normal;
            if (!known)
                for (double& x : counted) x /= unknown;
            quadric_[v].add_plane(counted, at);
            if (!bordered) continue;
            const std::uint32_t next = after(mesh_.triangle[t], v),
                                last = before(mesh_.triangle[t], v);
            if (is_border(t, v, next)) add_border(v, next, normal, quadric_[v]);
            if (is_border(t, last, v)) add_border(last, v, normal_at(t, last), quadric_[v]);
        }
    }
    // The plane through a border of primitives across the surface.
    void add_border(std::uint32_t from, std::uint32_t to, const Vec3& normal,
                    ErrorQuadric& out) const {
        // How much further than from a patch a vertex may be from it.
        constexpr double wider = 10;
        Vec3 across = unit(cross(minus(mesh_.vertex[to], mesh_.vertex[from]), normal));
        for (double& x : across) x /= wider;
        out.add_plane(across, mesh_.vertex[from]);
    }
    // Whether a vertex has triangles of several primitives.
    bool is_bordered(std::uint32_t v) const {
        return std::ranges::any_of(around_[v], [&](std::uint32_t t) {
            return mesh_.facet[t].primitive != mesh_.facet[around_[v].front()].primitive;
        });
    }
    // Whether another primitive lies beyond the edge from v to `next` of triangle t.
    bool is_border(std::uint32_t t, std::uint32_t v, std::uint32_t next) const {
        for (const std::uint32_t other : around_[v]) {
            if (before(mesh_.triangle[other], v) == next)
                return mesh_.facet[other].primitive != mesh_.facet[t].primitive;
        }
        return false;
    }

    // What one thread works with.
    struct Workspace {
        std::pmr::monotonic_buffer_resource rings;
        std::vector<std::uint32_t> neighbours;  // of the vertex that is looked at
        std::vector<std::uint32_t> gained;
        std::vector<std::pair<double, std::uint32_t>> nearest;
    };

    // The block of voxels that a vertex lies in.
    geometry::GridCell block_of(std::size_t v) const {
        constexpr int block_bits = 5;
        const auto& [i, j, k] = mesh_.corner[v];
        return {i >> block_bits, j >> block_bits, k >> block_bits};
    }
    // Whether all neighbours are of the same block.
    bool is_inner(std::uint32_t v) const {
        return std::ranges::all_of(around_[v], [&](std::uint32_t t) {
            return block_of(after(mesh_.triangle[t], v)) == block_of(v);
        });
    }

    void merge_among(std::vector<std::uint32_t> vertices, Workspace& work) {
        bool any = true;
        for (std::uint32_t round = 1; any; ++round) {
            any = false;
            std::erase_if(vertices, [&](std::uint32_t v) { return around_[v].empty(); });
            for (const std::uint32_t v : vertices) {
                // Changes of one round lie apart, or long fans would arise.
                if (around_[v].empty() || asked_[v] != 0 || changed_[v] == round) continue;
                asked_[v] = 1;
                if (!remove(v, work)) continue;
                any = true;
                for (const std::uint32_t n : work.neighbours) {
                    asked_[n] = 0;
                    changed_[n] = round;
                }
            }
        }
    }

    // Merges v into the nearest neighbour that can take it.
    bool remove(std::uint32_t v, Workspace& work) {
        work.neighbours.clear();
        for (const std::uint32_t t : around_[v])
            work.neighbours.push_back(after(mesh_.triangle[t], v));
        work.nearest.clear();
        const bool bordered = is_bordered(v);
        for (const std::uint32_t u : work.neighbours) {
            // No error is less than 0, but for rounding.
            const double own = quadric_[v].at(mesh_.vertex[u]);
            if (own > 2 * most_ || own + quadric_[u].at(mesh_.vertex[u]) > most_) continue;
            const Vec3 way = minus(mesh_.vertex[u], mesh_.vertex[v]);
            work.nearest.emplace_back(dot(way, way), u);
        }
        std::ranges::sort(work.nearest);
        for (const auto& [distance, u] : work.nearest) {
            if ((bordered && !runs_along_border(v, u)) || !stays_closed(u, work.neighbours) ||
                !stays_flat(v, u, work.neighbours))
                continue;
            merge(v, u, work);
            return true;
        }
        return false;
    }
    bool runs_along_border(std::uint32_t v, std::uint32_t u) const {
        for (const std::uint32_t t : around_[v])
            if (after(mesh_.triangle[t], v) == u) return is_border(t, v, u);
        return false;
    }
    // The link condition: u and the vertex that has these neighbours have none in common but those
    // across their edge.
    bool stays_closed(std::uint32_t u, std::span<const std::uint32_t> neighbours) const {
        std::size_t common = 0;
        for (const std::uint32_t t : around_[u]) {
            const std::uint32_t n = after(mesh_.triangle[t], u);
            common += std::ranges::find(neighbours, n) != neighbours.end();
        }
        return common == 2;
    }
    // No triangle turns far or becomes a line, and no edge too long.
    bool stays_flat(std::uint32_t v, std::uint32_t u,
                    std::span<const std::uint32_t> neighbours) const {
        constexpr double turn = 0.5;     // cosine
        constexpr double narrow = 0.01;  // height over the longest side
        for (const std::uint32_t n : neighbours) {
            const Vec3 edge = minus(mesh_.vertex[n], mesh_.vertex[u]);
            if (dot(edge, edge) > longest_) return false;
        }
        for (const std::uint32_t t : around_[v]) {
            auto moved = mesh_.triangle[t];
            if (std::ranges::find(moved, u) != moved.end()) continue;
            const Vec3 outside = outside_of(t, moved, mesh_.vertex[u]);
            std::ranges::replace(moved, v, u);
            const Vec3 then = area(moved);
            const double size = length(then);
            if (!(size > narrow * longest_side(moved))) return false;
            // What is on no patch stays on the side that its voxel's side was on.
            if (mesh_.facet[t].patch == no_patch && dot(side_of(mesh_.facet[t]), then) < 0)
                return false;
            if (dot(outside, then) < turn * length(outside) * size) return false;
        }
        return true;
    }
    void merge(std::uint32_t v, std::uint32_t u, Workspace& work) {
        work.gained.clear();
        for (const std::uint32_t t : around_[v]) {
            auto& triangle = mesh_.triangle[t];
            if (std::ranges::find(triangle, u) == triangle.end()) {
                std::ranges::replace(triangle, v, u);
                work.gained.push_back(t);
                continue;
            }
            for (const std::uint32_t w : triangle)
                if (w != v) around_.erase(w, t);
            triangle = {0, 0, 0};
        }
        around_.clear(v);
        around_.append(u, work.gained, work.rings);
        quadric_[u].add(quadric_[v]);
    }

    SurfaceMesh& mesh_;
    std::span<const SurfacePatch> patches_;
    double most_, longest_;  // squared
    VertexRings around_;     // of a vertex that is gone, none
    std::vector<ErrorQuadric> quadric_;
    // By vertex: whether it can't go before something around it has changed, and in which round
    // something has.
    std::vector<std::uint8_t> asked_;
    std::vector<std::uint32_t> changed_;
};

}  // namespace

void simplify(SurfaceMesh& mesh, std::span<const SurfacePatch> patches,
              const SimplifyOptions& options, ThreadPool& pool) {
    Simplifier simplifier(mesh, patches, options);
    simplifier.find_quadrics(pool);
    simplifier.run(pool);
    simplifier.compact();
}

}  // namespace topple::solids

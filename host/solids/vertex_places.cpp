// SPDX-License-Identifier: MIT
#include "solids/vertex_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/rows.h"
#include "core/sort_unique.h"
#include "core/vectors.h"
#include "solids/meeting_point.h"

namespace topple::solids {
namespace {

// In voxels.
// How far from its corner a vertex of which not all patches are known goes along each axis; along
// one in which there is but one voxel, so that sticks and boards don't wither.
constexpr double farthest_unknown = 0.4, farthest_thin = 0.15;
constexpr double place_slack = 0.002;     // what is no further outside is not
constexpr std::uint64_t chunk = 1 << 11;  // vertices handed to a thread at once

class Places {
  public:
    Places(std::span<const ObjectVoxel> voxels, const BlockSurface& surface,
           std::span<const Facet> facet, const ObjectEntries& entries,
           std::span<const SurfacePatch> patches)
        : voxels_(voxels),
          surface_(surface),
          facet_(facet),
          entries_(entries),
          faces_(surface.corner.size(),
                 [&](const auto& add) {
                     for (std::uint32_t f = 0; f < surface.face.size(); ++f)
                         for (const std::uint32_t v : surface.face[f].vertex) add(v, f);
                 }),
          patches_(patches),
          h_(entries.voxel_m()),
          meet_(patches, h_),
          known_(surface.corner.size()),
          open_(voxels.size(), 0) {}

    std::vector<Vec3> find(ThreadPool& pool) {
        std::vector<Vec3> at(surface_.corner.size());
        pool.run(at.size(), chunk, [&](std::uint64_t first, std::uint64_t last) {
            Scratch scratch;
            for (std::uint64_t v = first; v < last; ++v) at[v] = place(v, corner(v), scratch);
        });
        smooth(at, pool);
        pool.run(at.size(), chunk, [&](std::uint64_t first, std::uint64_t last) {
            Scratch scratch;
            for (std::uint64_t v = first; v < last; ++v)
                if (!known_[v]) at[v] = place(v, at[v], scratch);
        });
        return at;
    }

  private:
    Vec3 corner(std::size_t v) const {
        const auto& c = surface_.corner[v];
        return {c[0] * h_, c[1] * h_, c[2] * h_};
    }

    // Of the vertex that is placed: its patches, others, and the voxels around it.
    struct Scratch {
        std::vector<std::uint32_t> of, others, around;
    };

    // Where the patches of the vertex's faces meet next to `base`.
    Vec3 place(std::size_t v, const Vec3& base, Scratch& s) {
        s.of.clear();
        s.around.clear();
        known_[v] = true;
        for (const std::uint32_t f : faces_[v]) {
            if (facet_[f].patch == no_patch)
                known_[v] = false;
            else
                s.of.push_back(facet_[f].patch);
            s.around.push_back(surface_.face[f].voxel);
            if (surface_.face[f].beyond != no_voxel) s.around.push_back(surface_.face[f].beyond);
        }
        if (s.of.empty()) return base;
        sort_unique(s.of);
        const Vec3 met = meet_(s.of, base, corner(v));
        sort_unique(s.around);
        return on_solid(met, s.around) ? met : cut(met, base, corner(v), s);
    }

    // Whether the solid reaches p, as the voxels nearest to it say.
    bool on_solid(const Vec3& p, std::span<const std::uint32_t> around) const {
        double nearest = std::numeric_limits<double>::infinity();
        for (const std::uint32_t n : around) nearest = std::min(nearest, distance(n, p));
        return std::ranges::any_of(around, [&](std::uint32_t n) {
            return distance(n, p) <= nearest + place_slack * h_ &&
                   entries_.solid(voxels_[n], p, place_slack * h_);
        });
    }
    double distance(std::uint32_t n, const Vec3& p) const {
        double most = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            const double low = voxels_[n].at[a] * h_;
            most = std::max({most, low - p[a], p[a] - low - h_});
        }
        return most;
    }

    // A patch may end before the vertex, at another one that none of its faces stands for: the
    // place next to `met` where the solid ends there, too; `met` where there is none.
    Vec3 cut(const Vec3& met, const Vec3& base, const Vec3& corner, Scratch& s) const {
        s.others.clear();
        for (const std::uint32_t n : s.around) entries_.add_patches(voxels_[n], s.others);
        sort_unique(s.others);
        Vec3 best = met;
        double least = h_;
        const auto attempt = [&] {
            const Vec3 p = meet_(s.of, base, corner);
            const double moved = length(minus(p, met));
            if (moved >= least || !on_solid(p, s.around)) return;
            least = moved;
            best = p;
        };
        for (std::size_t a = 0; a < s.others.size(); ++a) {
            s.of.push_back(s.others[a]);
            attempt();
            for (std::size_t b = 0; b < a; ++b) {
                s.of.push_back(s.others[b]);
                attempt();
                s.of.pop_back();
            }
            s.of.pop_back();
        }
        return best;
    }

    // Taubin's smoothing of the vertices that are not known: steps towards the mean of their
    // neighbours, and away from it, so that nothing shrinks much. What lies on patches moves along
    // the edge where these end, between neighbours that lie on them, too.
    void smooth(std::vector<Vec3>& at, ThreadPool& pool) {
        constexpr int rounds = 10;
        constexpr double towards = 0.5, away = -0.53;
        find_beside(pool);
        std::vector<Vec3> next(beside_.size());
        for (int round = 0; round < 2 * rounds; ++round) {
            const double share = round % 2 ? away : towards;
            pool.each(beside_.size(), chunk,
                      [&](std::size_t n) { next[n] = moved(beside_[n], share, at); });
            pool.each(beside_.size(), chunk,
                      [&](std::size_t n) { at[beside_[n].vertex] = next[n]; });
        }
    }
    // What a vertex that is not known is drawn to.
    struct Beside {
        std::uint32_t vertex, count;
        std::size_t first;  // of neighbours_
        Vec3 reach;         // how far it may go
    };
    Vec3 reach_of(std::uint32_t v) const {
        Vec3 out{farthest_unknown * h_, farthest_unknown * h_, farthest_unknown * h_};
        for (const std::uint32_t f : faces_[v]) {
            const VoxelFace& face = surface_.face[f];
            const unsigned both = 3U << 2 * face.axis();
            if ((open_[face.voxel] & both) == both) out[face.axis()] = farthest_thin * h_;
        }
        return out;
    }
    // By vertex, those with two neighbours or more.
    void find_beside(ThreadPool& pool) {
        for (const VoxelFace& face : surface_.face)
            open_[face.voxel] |= static_cast<std::uint8_t>(1U << face.direction);
        struct Part {
            std::vector<Beside> beside;
            std::vector<std::uint32_t> neighbours;
        };
        std::vector<Part> parts((known_.size() + chunk - 1) / chunk);
        pool.each(parts.size(), 1, [&](std::size_t p) {
            const auto end = std::min((p + 1) * chunk, known_.size());
            std::vector<std::uint32_t> own, others, found;
            for (std::size_t at = p * chunk; at < end; ++at) {
                if (known_[at]) continue;
                const auto v = static_cast<std::uint32_t>(at);
                find_neighbours(v, own, others, found);
                if (found.size() < 2) continue;
                Part& part = parts[p];
                part.beside.push_back({v, static_cast<std::uint32_t>(found.size()),
                                       part.neighbours.size(), reach_of(v)});
                part.neighbours.insert(part.neighbours.end(), found.begin(), found.end());
            }
        });
        for (const Part& part : parts) {
            for (Beside b : part.beside) {
                b.first += neighbours_.size();
                beside_.push_back(b);
            }
            neighbours_.insert(neighbours_.end(), part.neighbours.begin(), part.neighbours.end());
        }
    }
    // Those along edges; of a vertex on patches, that lie on all of these and are not known. own,
    // others: room for patches.
    void find_neighbours(std::uint32_t v, std::vector<std::uint32_t>& own,
                         std::vector<std::uint32_t>& others,
                         std::vector<std::uint32_t>& found) const {
        found.clear();
        for (const std::uint32_t f : faces_[v]) {
            const auto& vertex = surface_.face[f].vertex;
            const auto slot =
                static_cast<std::size_t>(std::ranges::find(vertex, v) - vertex.begin());
            found.push_back(vertex[(slot + 1) % 4]);
            found.push_back(vertex[(slot + 3) % 4]);
        }
        sort_unique(found);
        find_patches(v, own);
        if (own.empty()) return;
        std::erase_if(found, [&](std::uint32_t u) {
            find_patches(u, others);
            return known_[u] || !std::ranges::includes(others, own);
        });
    }
    void find_patches(std::uint32_t v, std::vector<std::uint32_t>& out) const {
        out.clear();
        for (const std::uint32_t f : faces_[v])
            if (facet_[f].patch != no_patch) out.push_back(facet_[f].patch);
        sort_unique(out);
    }
    Vec3 moved(const Beside& b, double share, const std::vector<Vec3>& at) const {
        Vec3 sum{};
        for (const std::uint32_t u : std::span(neighbours_).subspan(b.first, b.count))
            for (std::size_t a = 0; a < 3; ++a) sum[a] += at[u][a];
        const Vec3 middle = corner(b.vertex);
        Vec3 out{};
        for (std::size_t a = 0; a < 3; ++a) {
            const double now = at[b.vertex][a];
            out[a] = std::clamp(now + share * (sum[a] / b.count - now), middle[a] - b.reach[a],
                                middle[a] + b.reach[a]);
        }
        return out;
    }

    std::span<const ObjectVoxel> voxels_;
    const BlockSurface& surface_;
    std::span<const Facet> facet_;
    const ObjectEntries& entries_;
    Rows<std::uint32_t> faces_;  // at each vertex
    std::span<const SurfacePatch> patches_;
    double h_;
    MeetingPoint meet_;
    std::vector<std::uint8_t> known_;  // of each vertex: each of its faces has a patch
    std::vector<std::uint8_t> open_;   // of each voxel, bits of the directions of its faces
    std::vector<Beside> beside_;
    std::vector<std::uint32_t> neighbours_;
};

}  // namespace

std::vector<Vec3> vertex_places(std::span<const ObjectVoxel> voxels, const BlockSurface& surface,
                                std::span<const Facet> facet, const ObjectEntries& entries,
                                std::span<const SurfacePatch> patches, ThreadPool& pool) {
    return Places(voxels, surface, facet, entries, patches).find(pool);
}

}  // namespace topple::solids

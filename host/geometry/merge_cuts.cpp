// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "geometry/algebraic_model.h"
#include "geometry/face_limits.h"
#include "geometry/merge.h"
#include "geometry/minimum_cut.h"
#include "geometry/region_facts.h"
#include "geometry/split.h"

namespace topple::geometry {

namespace {

// Faces of different solids that happen to be flush are cut apart. All of these are set by hand,
// and tried in scenes whose right cuts are known (tests/host/geometry/merge_test.cpp).

// How far in front of a face a surfel can't belong to its solid, in cells beyond the noise, which
// may spread a face over two layers of cells.
constexpr double front_cells = 1.5;
// Cosine of the angle (45 degrees) below which two faces bound a solid at an edge.
constexpr double crease_cos = 0.7;
// How many times its own surfels a face may have in front of it: else it is a fragment beside them.
constexpr double most_in_front = 4;
// The longest cut, over the side of a square as large as the smaller part; unless that part is so
// many cells thick, and this share of it lies in front of the face.
constexpr double longest_neck = 1.5, least_thickness_cells = 4, least_proven_share = 0.8;
// How much shorter a level cut counts: things stand on one another.
constexpr double level_bias = 0.15;
// What a surfel that nothing speaks against costs when it is cut off, in cells of cut times the
// side of a square as large as the whole face.
constexpr double kept_weight = 2;

using Members = std::vector<std::uint32_t>;
// What is known of a face that meets a solid in a convex edge: the solid lies behind all of its
// faces. `inside` lie at that edge; `outside` lie in front of another face: they belong to
// something else.
struct Contradiction {
    Members inside, outside;  // places in the list of members
};

struct Division {
    Members inside, outside;  // surfels
    double neck = 0;          // length of the cut over the side of a square of the smaller part
    double thickness = 0;     // surfels outside over the length of the cut: cells
};

class Cutter {
  public:
    Cutter(const Surfels& surfels, const Vec3& up, const std::vector<std::int32_t>& solid,
           CutRegions& cuts, RegionFacts& facts)
        : s_(surfels),
          up_(up[0], up[1], up[2]),
          out_(cuts),
          facts_(facts),
          solid_(solid),
          place_(surfels.size(), 0) {
        for (std::size_t k = 0; k < solid_.size(); ++k) {
            const auto of = static_cast<std::size_t>(solid_[k]);
            if (faces_.size() <= of) faces_.resize(of + 1);
            faces_[of].push_back(k);
        }
        stale_.assign(faces_.size(), false);
    }

    void run() {
        // Pieces are appended, and come to their turn.
        for (std::size_t k = 0; k < out_.members.size(); ++k)
            while (cut(k)) {
            }
    }

  private:
    std::int32_t label(std::uint32_t i) const { return out_.regions.label[i]; }
    const Region& region(std::size_t k) const { return out_.regions.regions[k]; }
    Eigen::Vector3d direction(std::size_t k) const {
        const auto& c = region(k).model.coefficients;
        return {c[1], c[2], c[3]};
    }

    bool cut(std::size_t k) {
        if (region(k).model.degree != 1 || out_.members[k].size() < 2 * least_piece) return false;
        const std::vector<Contradiction> all = contradictions(k);
        if (all.empty()) return false;
        std::optional<Division> best;
        Face face(*this, out_.members[k]);
        for (const Contradiction& c : all) {
            facts_.threads().poll();
            Division d = divide(face, c);
            if (std::min(d.inside.size(), d.outside.size()) < least_piece) continue;
            const bool block = d.thickness >= least_thickness_cells &&
                               static_cast<double>(c.outside.size()) >=
                                   least_proven_share * static_cast<double>(d.outside.size());
            if (d.neck > longest_neck && !block) continue;
            if (!best || d.neck < best->neck) best = std::move(d);
        }
        if (best) apply(k, std::move(*best));
        return best.has_value();
    }

    // A face's neighbour at which the two bound one solid, and the surfels of the face there.
    struct Edge {
        std::size_t neighbour;
        Members own;
    };

    // The convex edges of a face, longest first.
    std::vector<Edge> convex_edges(std::size_t k) const {
        std::vector<Edge> out;
        for (const std::int32_t other : facts_.touching(k)) {
            const auto b = static_cast<std::size_t>(other);
            const Border& border = facts_.border(static_cast<std::int32_t>(k), other);
            if (!convex_edge(border, k, b)) continue;
            Edge edge{b, {}};
            for (const auto& [i, j] : border.pairs) edge.own.push_back(b > k ? i : j);
            out.push_back(std::move(edge));
        }
        std::stable_sort(out.begin(), out.end(),
                         [](const Edge& x, const Edge& y) { return x.own.size() > y.own.size(); });
        return out;
    }

    bool convex_edge(const Border& border, std::size_t a, std::size_t b) const {
        if (region(b).model.degree != 1 || region(b).surfels < least_piece) return false;
        if (std::abs(direction(a).dot(direction(b))) > crease_cos) return false;
        const double side = std::sqrt(static_cast<double>(region(b).surfels));
        return static_cast<double>(border.pairs.size()) >= least_border * side &&
               border.inside_share > least_inside_share;
    }

    double tolerance(std::size_t k) const { return facts_.samples()[k].tolerance_m; }
    double reach(std::size_t k) const { return tolerance(k) + front_cells * s_.cell_m; }

    bool same_plane(std::size_t a, std::size_t b) const {
        if (direction(a).dot(direction(b)) < parallel_cos) return false;
        const auto& o = region(b).model.origin;
        const double off = distance(region(a).model, {o[0], o[1], o[2]});
        return std::abs(off) < tolerance(a) + tolerance(b);
    }

    // Whether two neighbours of a face speak of the same solid: as merged before, or as faces in
    // one plane.
    bool same_solid(std::size_t a, std::size_t b) const {
        if (a < solid_.size() && b < solid_.size()) return solid_[a] == solid_[b];
        return same_plane(a, b);
    }

    // Whether a face of the solid was cut since: what else is known of it may no longer hold.
    bool stale(std::size_t k) const { return k < solid_.size() && stale_[solid_[k]]; }

    // The faces of the solid that a neighbour belongs to, but `k`.
    std::vector<std::size_t> faces_with(std::size_t neighbour, std::size_t k) const {
        if (neighbour >= solid_.size()) return {neighbour};
        std::vector<std::size_t> out;
        for (const std::size_t f : faces_[solid_[neighbour]])
            if (f != k && region(f).model.degree == 1 && region(f).surfels >= least_piece)
                out.push_back(f);
        return out;
    }

    std::vector<Contradiction> contradictions(std::size_t k) {
        const Members& own = out_.members[k];
        for (std::uint32_t m = 0; m < own.size(); ++m) place_[own[m]] = m;
        const std::vector<Edge> edges = convex_edges(k);
        std::vector<bool> used(edges.size(), false), front(own.size());
        std::vector<Contradiction> out;
        for (std::size_t e = 0; e < edges.size(); ++e) {
            facts_.threads().poll();
            const std::size_t neighbour = edges[e].neighbour;
            if (used[e] || stale(neighbour)) continue;
            std::fill(front.begin(), front.end(), false);
            for (const std::size_t f : faces_with(neighbour, k))
                mark_front(own, f, f == neighbour, front);
            Contradiction c;
            for (std::uint32_t m = 0; m < own.size(); ++m)
                if (front[m]) c.outside.push_back(m);
            if (c.outside.size() < least_piece) continue;
            for (std::size_t f = e; f < edges.size(); ++f) {
                if (!same_solid(neighbour, edges[f].neighbour)) continue;
                used[f] = true;
                for (const std::uint32_t i : edges[f].own)
                    if (!front[place_[i]]) c.inside.push_back(place_[i]);
            }
            if (!c.inside.empty()) out.push_back(std::move(c));
        }
        return out;
    }

    // A face that is not itself at the edge tells of surfels in front of it only where it is no
    // fragment beside them.
    void mark_front(const Members& own, std::size_t f, bool at_edge,
                    std::vector<bool>& front) const {
        const AlgebraicModel& plane = region(f).model;
        const double far = reach(f);
        std::vector<std::uint32_t> found;
        for (std::uint32_t m = 0; m < own.size(); ++m)
            if (distance(plane, position(s_, own[m])) > far) found.push_back(m);
        if (!at_edge && static_cast<double>(found.size()) >
                            most_in_front * static_cast<double>(region(f).surfels))
            return;
        for (const std::uint32_t m : found) front[m] = true;
    }

    // A face as a graph of neighbouring surfels, whose edges tell how long a cut between them is,
    // in cells. Level cuts count a little less: things stand on one another.
    struct Face {
        const Members& members;
        // Noise may spread a face over two layers of cells: a surfel counts as the share of a
        // cell's area that it covers.
        std::vector<double> area;
        std::vector<CutEdge> edges;
        MinimumCut graph;

        Face(const Cutter& of, const Members& face)
            : members(face),
              area(of.areas(face)),
              edges(of.edges(face, area)),
              graph(face.size(), edges) {}
    };

    std::vector<double> areas(const Members& members) const {
        std::vector<double> out;
        for (const std::uint32_t i : members) out.push_back(covered(i));
        return out;
    }

    std::vector<CutEdge> edges(const Members& members, const std::vector<double>& area) const {
        std::vector<CutEdge> out;
        for (std::uint32_t m = 0; m < members.size(); ++m) {
            const std::uint32_t i = members[m];
            for (const std::uint32_t j : s_.around(i)) {
                if (j > i && label(j) == label(i))
                    out.push_back({m, place_[j], area[m] * area[place_[j]] * weight(i, j)});
            }
        }
        return out;
    }

    // The shortest cut through the face that parts the one from the other.
    Division divide(Face& face, const Contradiction& c) const {
        const std::vector<double>& area = face.area;
        const double pull = (solid_.empty() ? 0 : kept_weight) /
                            std::sqrt(std::accumulate(area.begin(), area.end(), 0.0));
        std::vector<CutNode> nodes(area.size());
        for (std::size_t m = 0; m < nodes.size(); ++m) nodes[m].from_source = pull * area[m];
        for (const std::uint32_t m : c.inside) nodes[m].from_source = cut_never;
        for (const std::uint32_t m : c.outside) nodes[m] = {0, cut_never};
        const std::vector<bool> within = face.graph.part(nodes);
        Division out;
        double length = 0, inside = 0, outside = 0;
        for (std::size_t m = 0; m < nodes.size(); ++m) {
            (within[m] ? out.inside : out.outside).push_back(face.members[m]);
            (within[m] ? inside : outside) += area[m];
        }
        for (const CutEdge& e : face.edges)
            if (within[e.a] != within[e.b]) length += e.weight;
        out.neck = length / std::sqrt(std::max(std::min(inside, outside), 1.0));
        double proven = 0;
        for (const std::uint32_t m : c.outside) proven += area[m];
        out.thickness = proven / std::max(length, 1.0);
        return out;
    }

    // Cells of its face's area that a surfel stands for: in a single layer it has eight neighbours.
    double covered(std::uint32_t i) const {
        int neighbours = 0;
        for (const std::uint32_t j : s_.around(i)) neighbours += label(j) == label(i);
        return neighbours > 8 ? 8.0 / neighbours : 1.0;
    }

    // Share of a cell's width of cut between two neighbours: straight and diagonal neighbours in a
    // plane add up to 1 across each cell.
    double weight(std::uint32_t i, std::uint32_t j) const {
        const Eigen::Vector3d d = position(s_, i) - position(s_, j);
        const double length = std::max(d.norm(), 0.5 * s_.cell_m);
        const double level = level_bias * std::abs(d.dot(up_)) / length;
        return s_.cell_m / length / (1 + EIGEN_PI / 2 - 0.15) * (1 - level);
    }

    void apply(std::size_t k, Division d) {
        if (k < solid_.size()) stale_[solid_[k]] = true;
        const std::size_t fresh = out_.take_out(s_, k, std::move(d.outside));
        out_.flush[k].emplace_back(out_.count, false);
        out_.flush[fresh].emplace_back(out_.count, true);
        ++out_.count;
        facts_.update({static_cast<std::int32_t>(k), static_cast<std::int32_t>(fresh)});
    }

    const Surfels& s_;
    Eigen::Vector3d up_;
    CutRegions& out_;
    RegionFacts& facts_;
    std::vector<std::int32_t> solid_;              // of each region, as merged before
    std::vector<std::vector<std::size_t>> faces_;  // of each solid
    std::vector<bool> stale_;                      // of each solid
    Members place_;                                // of a surfel in its region's list
};

}  // namespace

void cut_flush_faces(const Surfels& surfels, const Vec3& up, const std::vector<std::int32_t>& solid,
                     CutRegions& cuts, RegionFacts& facts) {
    Cutter(surfels, up, solid, cuts, facts).run();
}

}  // namespace topple::geometry

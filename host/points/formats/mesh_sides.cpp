// SPDX-License-Identifier: MIT
#include "points/formats/mesh_sides.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <iterator>
#include <span>
#include <tuple>
#include <utility>

#include "core/vectors.h"
#include "io/text.h"

namespace topple::io {
namespace {

// What is no narrower may be a room.
constexpr double least_room_m = 1.5;
// Triangles that are looked at where more meet at an edge, and bodies as what others may lie in.
constexpr std::size_t most_at_edge = 8, most_hollow = 200;

std::size_t hash_of(const std::array<float, 3>& place) {
    std::uint64_t hash = 0;
    for (const float v : place)
        hash = (hash ^ std::bit_cast<std::uint32_t>(v) ^ hash >> 29) * 0x9E3779B97F4A7C15u;
    return hash ^ hash >> 32;
}

// A side of a triangle: which places it joins, the lower number first, and whether that is its way.
struct Edge {
    std::uint32_t a, b, triangle;
    bool forward;
};

std::vector<Edge> sorted_edges(const TriangleMesh& mesh) {
    std::vector<Edge> out;
    out.reserve(3 * mesh.size());
    for (std::uint32_t t = 0; t < mesh.size(); ++t) {
        const auto& corner = mesh.triangles()[t];
        for (std::size_t n = 0; n < 3; ++n) {
            const std::uint32_t from = corner[n], to = corner[(n + 1) % 3];
            out.push_back({std::min(from, to), std::max(from, to), t, from < to});
        }
    }
    std::ranges::sort(out, {}, [](const Edge& e) { return std::tuple(e.a, e.b, e.triangle); });
    return out;
}

// Calls use(edges) for all that join the same places.
template <class Use>
void each_group(const std::vector<Edge>& edges, const Use& use) {
    for (std::size_t n = 0; n < edges.size();) {
        std::size_t end = n + 1;
        while (end < edges.size() && edges[end].a == edges[n].a && edges[end].b == edges[n].b)
            ++end;
        use(std::span(edges).subspan(n, end - n));
        n = end;
    }
}

// Pieces of triangles joined by edges of two, and whether each turns with its piece's first.
class Pieces {
  public:
    explicit Pieces(std::size_t triangles) : parent_(triangles), odd_(triangles, false) {
        for (std::uint32_t t = 0; t < triangles; ++t) parent_[t] = t;
    }
    // The piece's first, and whether the triangle turns against it.
    std::pair<std::uint32_t, bool> find(std::uint32_t t) {
        std::uint32_t root = t;
        bool odd = false;
        for (; parent_[root] != root; root = parent_[root]) odd = odd != odd_[root];
        bool left = odd;
        while (parent_[t] != t) {
            const std::uint32_t next = parent_[t];
            const bool step = odd_[t];
            parent_[t] = root;
            odd_[t] = left;
            left = left != step;
            t = next;
        }
        return {root, odd};
    }
    void join(std::uint32_t a, std::uint32_t b, bool against) {
        const auto [of_a, odd_a] = find(a);
        const auto [of_b, odd_b] = find(b);
        if (of_a == of_b) {
            // A band with one side only has none to turn to.
            if ((odd_a != odd_b) != against) one_sided_.push_back(of_a);
            return;
        }
        const auto [low, high] = std::minmax(of_a, of_b);
        parent_[high] = low;
        odd_[high] = (odd_a != odd_b) != against;
    }
    std::vector<std::uint32_t> one_sided() {
        for (std::uint32_t& t : one_sided_) t = find(t).first;
        std::ranges::sort(one_sided_);
        return one_sided_;
    }

  private:
    std::vector<std::uint32_t> parent_;
    std::vector<bool> odd_;  // against the parent
    std::vector<std::uint32_t> one_sided_;
};

struct Piece {
    double with = 0, against = 0;  // area of the triangles that turn with its first, or not
    std::uint64_t turned = 0;
    bool one_sided = false, closed = true;
    double volume = 0;
    Vec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};

    bool turns(bool odd) const { return !one_sided && odd == (with >= against); }
    bool within(const Piece& other) const {
        for (std::size_t a = 0; a < 3; ++a)
            if (low[a] < other.low[a] || high[a] > other.high[a]) return false;
        return true;
    }
    double narrowest() const {
        return std::min({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    }
};

}  // namespace

void TriangleMesh::add(const std::array<Vec3, 3>& corners) {
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t n = 0; n < 3; ++n) {
        std::array<float, 3> place{};
        for (std::size_t a = 0; a < 3; ++a) place[a] = static_cast<float>(corners[n][a]) + 0.0f;
        triangle[n] = number_of(place);
    }
    triangle_.push_back(triangle);
}

std::uint32_t TriangleMesh::number_of(const std::array<float, 3>& place) {
    if (2 * place_.size() >= bucket_.size()) grow();
    std::size_t at = hash_of(place) & (bucket_.size() - 1);
    for (; bucket_[at] != 0; at = (at + 1) & (bucket_.size() - 1))
        if (place_[bucket_[at] - 1] == place) return bucket_[at] - 1;
    place_.push_back(place);
    bucket_[at] = static_cast<std::uint32_t>(place_.size());
    return bucket_[at] - 1;
}

void TriangleMesh::grow() {
    bucket_.assign(std::max<std::size_t>(64, 4 * std::bit_ceil(place_.size())), 0);
    for (std::uint32_t n = 0; n < place_.size(); ++n) {
        std::size_t at = hash_of(place_[n]) & (bucket_.size() - 1);
        while (bucket_[at] != 0) at = (at + 1) & (bucket_.size() - 1);
        bucket_[at] = n + 1;
    }
}

std::vector<std::string> MeshSides::notes() const {
    std::vector<std::string> out;
    if (against_neighbours > 0) {
        out.push_back("The corners of " + counted(against_neighbours, "triangle") +
                      " went round the other way than those of their neighbours: they were turned "
                      "to face the same side.");
    }
    if (bodies > 0) {
        out.push_back((bodies == 1 ? std::string("A closed body had its")
                                   : std::to_string(bodies) + " closed bodies had their") +
                      " inside out, by the order of corners: the faces were turned.");
    }
    return out;
}

MeshSides find_sides(const TriangleMesh& mesh, double unit_m) {
    const std::vector<Edge> edges = sorted_edges(mesh);
    Pieces pieces(mesh.size());
    each_group(edges, [&](std::span<const Edge> group) {
        if (group.size() == 2 && group[0].triangle != group[1].triangle)
            pieces.join(group[0].triangle, group[1].triangle, group[0].forward == group[1].forward);
    });
    std::vector<std::uint32_t> piece_of(mesh.size());
    std::vector<bool> odd(mesh.size());
    std::vector<Piece> piece;
    std::vector<std::uint32_t> number(mesh.size(), UINT32_MAX);
    const auto corners_of = [&](std::size_t t) {
        std::array<Vec3, 3> out{};
        for (std::size_t n = 0; n < 3; ++n) {
            const auto& place = mesh.places()[mesh.triangles()[t][n]];
            out[n] = {place[0], place[1], place[2]};
        }
        return out;
    };
    for (std::uint32_t t = 0; t < mesh.size(); ++t) {
        const auto [root, against] = pieces.find(t);
        if (number[root] == UINT32_MAX) {
            number[root] = static_cast<std::uint32_t>(piece.size());
            piece.emplace_back();
        }
        piece_of[t] = number[root];
        odd[t] = against;
        Piece& p = piece[piece_of[t]];
        const auto corner = corners_of(t);
        const Vec3 normal = cross(minus(corner[1], corner[0]), minus(corner[2], corner[0]));
        (against ? p.against : p.with) += std::sqrt(dot(normal, normal));
        for (const Vec3& c : corner) {
            for (std::size_t a = 0; a < 3; ++a) {
                p.low[a] = std::min(p.low[a], c[a]);
                p.high[a] = std::max(p.high[a], c[a]);
            }
        }
    }
    for (const std::uint32_t root : pieces.one_sided()) piece[number[root]].one_sided = true;
    MeshSides out;
    out.turned.resize(mesh.size());
    for (std::uint32_t t = 0; t < mesh.size(); ++t) {
        Piece& p = piece[piece_of[t]];
        out.turned[t] = p.turns(odd[t]);
        p.turned += out.turned[t];
        const auto corner = corners_of(t);
        const double six =
            dot(minus(corner[0], p.low), cross(minus(corner[1], p.low), minus(corner[2], p.low)));
        p.volume += out.turned[t] ? -six : six;
    }
    // A piece is closed where each of its edges is gone along both ways as often.
    each_group(edges, [&](std::span<const Edge> group) {
        for (const Edge& e : group) {
            int balance = 0;
            for (const Edge& f : group.first(std::min(group.size(), most_at_edge))) {
                if (piece_of[f.triangle] == piece_of[e.triangle])
                    balance += f.forward != out.turned[f.triangle] ? 1 : -1;
            }
            if (balance != 0 || group.size() > most_at_edge)
                piece[piece_of[e.triangle]].closed = false;
        }
    });
    // The largest that may have hollows.
    std::vector<Piece> solid;
    std::ranges::copy_if(piece, std::back_inserter(solid),
                         [](const Piece& p) { return p.closed && p.volume > 0; });
    std::ranges::stable_sort(solid, std::greater(), &Piece::volume);
    solid.resize(std::min(solid.size(), most_hollow));
    std::vector<bool> inside_out(piece.size());
    for (std::size_t n = 0; n < piece.size(); ++n) {
        const Piece& p = piece[n];
        out.against_neighbours += p.one_sided ? 0 : p.turned;
        inside_out[n] =
            p.closed && p.volume < 0 && p.narrowest() * unit_m < least_room_m &&
            std::ranges::none_of(solid, [&](const Piece& other) { return p.within(other); });
        out.bodies += inside_out[n];
    }
    if (out.against_neighbours == 0 && out.bodies == 0) {
        out.turned.clear();
        return out;
    }
    for (std::uint32_t t = 0; t < mesh.size(); ++t)
        if (inside_out[piece_of[t]]) out.turned[t] = !out.turned[t];
    return out;
}

}  // namespace topple::io

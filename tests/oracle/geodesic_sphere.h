// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "topple/input.h"

// Directions for tests that sample landscapes.
namespace topple::test {

// A geodesic mesh of the unit sphere: 10 f^2 + 2 directions for frequency f, six neighbours each
// (the twelve of valence five repeat themselves once). Direction 0 is exactly +z.
struct SphereMesh {
    std::vector<float> x, y, z;
    std::vector<std::uint32_t> neighbour;  // 6 per direction
    std::size_t size() const { return x.size(); }
};

struct Icosahedron {
    std::array<Vec3, 12> vertex;
    std::array<std::array<std::uint32_t, 3>, 20> face;
};

// One vertex at each pole; two rings of five between. Square roots only: the same bits everywhere.
inline Icosahedron icosahedron() {
    const double root5 = std::sqrt(5.0), ring = 2 / root5, height = 1 / root5;
    const double c1 = (root5 - 1) / 4, s1 = std::sqrt(10 + 2 * root5) / 4;   // 72 degrees
    const double c2 = -(root5 + 1) / 4, s2 = std::sqrt(10 - 2 * root5) / 4;  // 144 degrees
    const double c[5] = {1, c1, c2, c2, c1}, s[5] = {0, s1, s2, -s2, -s1};
    Icosahedron ico;
    ico.vertex[0] = {0, 0, 1};
    ico.vertex[11] = {0, 0, -1};
    for (std::uint32_t n = 0; n < 5; ++n) {
        ico.vertex[1 + n] = {ring * c[n], ring * s[n], height};
        ico.vertex[6 + n] = {-ring * c[(n + 3) % 5], -ring * s[(n + 3) % 5],
                             -height};  // + 36 degrees
    }
    for (std::uint32_t n = 0; n < 5; ++n) {
        const std::uint32_t m = (n + 1) % 5;
        ico.face[n] = {0, 1 + n, 1 + m};
        ico.face[5 + n] = {1 + n, 6 + n, 1 + m};
        ico.face[10 + n] = {1 + m, 6 + n, 6 + m};
        ico.face[15 + n] = {11, 6 + m, 6 + n};
    }
    return ico;
}

// Numbers the points of the subdivided faces; a point on an edge or corner is one point, whichever
// face asks. A face asks once for each.
class SubdividedFaces {
  public:
    static constexpr std::uint32_t none = UINT32_MAX;

    SubdividedFaces(const Icosahedron& ico, unsigned frequency)
        : ico_(ico), frequency_(frequency), shared_(corners + corners * corners * frequency, none) {
        direction.reserve(10 * std::size_t{frequency} * frequency + 2);
    }
    std::uint32_t number(const std::array<std::uint32_t, 3>& corner,
                         const std::array<unsigned, 3>& weight) {
        std::array<Weighed, 3> key{};
        std::size_t count = 0;
        for (std::size_t n = 0; n < 3; ++n)
            if (weight[n]) key[count++] = {corner[n], weight[n]};
        const std::span<Weighed> at(key.data(), count);
        std::sort(at.begin(), at.end());
        const auto next = static_cast<std::uint32_t>(direction.size());
        if (count < 3) {
            // A corner by its number, a point on an edge by both ends and the weight of the first.
            std::uint32_t& known =
                shared_[count == 1 ? at[0].first
                                   : corners + (at[0].first * corners + at[1].first) * frequency_ +
                                         at[0].second];
            if (known != none) return known;
            known = next;
        }
        direction.push_back(place(at));
        return next;
    }
    std::vector<Vec3> direction;

  private:
    using Weighed = std::pair<std::uint32_t, unsigned>;  // a corner, by its number
    static constexpr std::size_t corners = 12;

    Vec3 place(std::span<const Weighed> key) const {
        if (key.size() == 1) return ico_.vertex[key[0].first];
        Vec3 p{};
        for (const auto& [corner, weight] : key) {
            for (std::size_t a = 0; a < 3; ++a)
                p[a] += ico_.vertex[corner][a] * weight / frequency_;
        }
        const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        return {p[0] / length, p[1] / length, p[2] / length};
    }
    const Icosahedron& ico_;
    unsigned frequency_;
    std::vector<std::uint32_t> shared_;  // of corners and points on edges: the number
};

inline SphereMesh geodesic_sphere(unsigned frequency) {
    const Icosahedron ico = icosahedron();
    SubdividedFaces points(ico, frequency);
    std::vector<std::array<std::uint32_t, 2>> edges;
    edges.reserve(60 * std::size_t{frequency} * (frequency + 1));
    std::vector<std::uint32_t> number;  // of this face's points
    for (const auto& face : ico.face) {
        number.assign((frequency + 1) * (std::size_t{frequency} + 1), SubdividedFaces::none);
        const auto at = [&](unsigned a, unsigned b) {
            std::uint32_t& known = number[a * (frequency + 1) + b];
            if (known == SubdividedFaces::none)
                known = points.number(face, {frequency - a - b, a, b});
            return known;
        };
        for (unsigned a = 0; a < frequency; ++a) {
            for (unsigned b = 0; a + b < frequency; ++b) {
                const std::uint32_t p = at(a, b), q = at(a + 1, b), r = at(a, b + 1);
                edges.insert(edges.end(), {{p, q}, {q, r}, {r, p}, {q, p}, {r, q}, {p, r}});
            }
        }
    }
    // From the north pole down: neighbours have close numbers.
    const std::size_t n = points.direction.size();
    std::vector<std::uint32_t> order(n), rank(n);
    for (std::uint32_t v = 0; v < n; ++v) order[v] = v;
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const double za = points.direction[a][2], zb = points.direction[b][2];
        return za != zb ? za > zb : a < b;
    });
    SphereMesh mesh;
    for (std::uint32_t v = 0; v < n; ++v) {
        rank[order[v]] = v;
        mesh.x.push_back(static_cast<float>(points.direction[order[v]][0]));
        mesh.y.push_back(static_cast<float>(points.direction[order[v]][1]));
        mesh.z.push_back(static_cast<float>(points.direction[order[v]][2]));
    }
    for (auto& edge : edges) edge = {rank[edge[0]], rank[edge[1]]};
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    mesh.neighbour.assign(n * 6, 0);
    for (std::size_t e = 0; e < edges.size();) {
        const std::uint32_t v = edges[e][0];
        std::size_t k = 0;
        for (; e < edges.size() && edges[e][0] == v; ++e) mesh.neighbour[v * 6 + k++] = edges[e][1];
        for (; k < 6; ++k) mesh.neighbour[v * 6 + k] = mesh.neighbour[v * 6];
    }
    return mesh;
}

}  // namespace topple::test

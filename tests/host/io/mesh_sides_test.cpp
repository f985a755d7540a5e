// SPDX-License-Identifier: MIT
#include "points/formats/mesh_sides.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mesh_files.h"

namespace topple::io {
namespace {

using Triangles = std::vector<std::array<Vec3, 3>>;

// A box of `edge` times 2 x 1 x 0.5 at `at`, faces seen from outside.
Triangles box(double edge = 1, const Vec3& at = {0, 0, 0}) {
    Triangles out;
    const auto corners = test::box_corners();
    for (const auto& t : test::box_triangles()) {
        std::array<Vec3, 3> triangle{};
        for (std::size_t n = 0; n < 3; ++n)
            for (std::size_t a = 0; a < 3; ++a) triangle[n][a] = edge * corners[t[n]][a] + at[a];
        out.push_back(triangle);
    }
    return out;
}
Triangles turned(Triangles of, std::initializer_list<std::size_t> which = {}) {
    for (std::size_t n = 0; n < of.size(); ++n)
        if (which.size() == 0 || std::ranges::find(which, n) != which.end())
            std::swap(of[n][0], of[n][1]);
    return of;
}
Triangles operator+(Triangles a, const Triangles& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}
Triangles without_top(Triangles of) {
    of.resize(10);
    return of;
}

TEST(MeshSides, outside_is_out) {
    const Triangles apart = box(1, {0, 0, 3}), within = box(0.2, {0.1, 0.1, 0.1});
    const struct {
        const char* what;
        Triangles mesh;
        double unit_m;
        std::uint64_t against, bodies, turned;
    } cases[] = {
        {"right", box() + apart, 1, 0, 0, 0},
        {"inside out", turned(box()), 1, 0, 1, 12},
        {"one of two", turned(box()) + apart, 1, 0, 1, 12},
        {"two that share an edge", turned(box()) + turned(box(1, {2, 1, 0})), 1, 0, 2, 24},
        {"some triangles", turned(box(), {1, 4, 7}), 1, 3, 0, 3},
        {"most triangles", turned(box(), {0, 1, 2, 3, 4, 5, 6, 7, 8}), 1, 3, 1, 9},
        {"open, and so it may be", turned(without_top(box())), 1, 0, 0, 0},
        {"open, but at odds", turned(without_top(box()), {2}), 1, 1, 0, 1},
        {"a room", turned(box(4)), 1, 0, 0, 0},
        {"the same in millimetres", turned(box(4)), 0.001, 0, 1, 12},
        {"a hollow", box() + turned(within), 1, 0, 0, 0},
        {"nothing", {}, 1, 0, 0, 0},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.what);
        TriangleMesh mesh;
        for (const auto& triangle : c.mesh) mesh.add(triangle);
        const MeshSides sides = find_sides(mesh, c.unit_m);
        EXPECT_EQ(sides.against_neighbours, c.against);
        EXPECT_EQ(sides.bodies, c.bodies);
        EXPECT_EQ(static_cast<std::uint64_t>(std::ranges::count(sides.turned, true)), c.turned);
        EXPECT_EQ(sides.notes().size(), std::size_t{c.against > 0} + std::size_t{c.bodies > 0});
    }
}

}  // namespace
}  // namespace topple::io

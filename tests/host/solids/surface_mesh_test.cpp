// SPDX-License-Identifier: MIT
#include "solids/surface_mesh.h"

#include "core/vectors.h"
#include "device/devices.h"
#include "host/solids/boxes.h"
#include "solids/block_surface.h"
#include "solids/boundary.h"
#include "solids/shaded_mesh.h"
#include "solids/simplify_mesh.h"
#include "testing.h"

namespace topple::solids {
namespace {

constexpr double h = 0.02;
ThreadPool pool(2);

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

double volume_of(const std::vector<Vec3>& vertex, const Triangles& triangles) {
    double six = 0;
    for (const auto& [a, b, c] : triangles) six += dot(vertex[a], cross(vertex[b], vertex[c]));
    return six / 6;
}

double area_of(const SurfaceMesh& mesh, std::size_t t) {
    const auto& [a, b, c] = mesh.triangle[t];
    const Vec3& p = mesh.vertex[a];
    return length(cross(minus(mesh.vertex[b], p), minus(mesh.vertex[c], p))) / 2;
}

// 2 for each part that is like a ball, 2 less for each hole through one.
long euler_of(const SurfaceMesh& mesh) {
    return static_cast<long>(mesh.vertex.size()) - static_cast<long>(mesh.triangle.size() / 2);
}

// Each edge has two triangles, which walk it in opposite directions, and around each vertex there
// is one fan.
void expect_closed(const SurfaceMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    std::vector<std::map<std::uint32_t, std::uint32_t>> around(mesh.vertex.size());
    for (const auto& t : mesh.triangle) {
        for (std::size_t n = 0; n < 3; ++n) {
            ASSERT_NE(t[n], t[(n + 1) % 3]);
            ASSERT_EQ(++edges[std::pair(t[n], t[(n + 1) % 3])], 1);
            around[t[n]][t[(n + 1) % 3]] = t[(n + 2) % 3];
        }
    }
    for (const auto& [edge, count] : edges)
        ASSERT_TRUE(edges.contains(std::pair(edge.second, edge.first)));
    for (std::size_t v = 0; v < around.size(); ++v) {
        ASSERT_FALSE(around[v].empty()) << "vertex " << v << " is unused";
        std::size_t steps = 0;
        std::uint32_t at = around[v].begin()->first;
        do {
            at = around[v].at(at);
            ++steps;
        } while (at != around[v].begin()->first && steps <= around[v].size());
        ASSERT_EQ(steps, around[v].size()) << "vertex " << v << " has two fans";
    }
}

// Of unit length, and within 90 degrees of the triangles', but for folds of hardly any area.
void expect_normals(const ShadedMesh& mesh) {
    for (const Vec3& n : mesh.normal) ASSERT_NEAR(length(n), 1, 1e-9);
    double against = 0, all = 0;
    for (const auto& [a, b, c] : mesh.triangle) {
        const Vec3 across =
            cross(minus(mesh.vertex[b], mesh.vertex[a]), minus(mesh.vertex[c], mesh.vertex[a]));
        all += length(across);
        for (const std::uint32_t v : {a, b, c})
            against += dot(mesh.normal[v], across) > 0 ? 0 : length(across) / 3;
    }
    EXPECT_LE(against, 3e-4 * all);
}

BoundaryCells boundary_of(const Scanned& scanned, std::size_t primitives = 1) {
    const auto device = device::open_native();
    return find_boundary(*device, scanned.cells, scanned.seen(), scanned.patches,
                         std::vector<bool>(primitives, false));
}

// All primitives are one object.
SurfaceMesh mesh_of(const SolidCells& cells, const BoundaryCells& boundary,
                    std::size_t primitives = 1) {
    const std::vector<std::int32_t> object(primitives, 0);
    return surface_mesh(object_voxels(cells, boundary, object), boundary, object, cells.voxel_m,
                        pool);
}

// A solid of revolution about z, or a ball, by its quadric; with points all over it.
Scanned round(const SurfacePatch& quadric, double half_height, double radius, bool ball) {
    Scanned out;
    out.patches = {quadric};
    const Vec3& o = quadric.origin;
    const auto add = [&](double x, double y, double z, std::int32_t patch) {
        test::add(out.cloud, o[0] + x, o[1] + y, o[2] + z);
        out.primitive.push_back(0);
        out.patch.push_back(patch);
    };
    constexpr double spacing = 0.004;
    const int rings = static_cast<int>(2 * half_height / spacing);
    for (int k = 0; k < rings; ++k) {
        const double z = ((k + 0.5) / rings * 2 - 1) * half_height;
        const double r = ball ? std::sqrt(radius * radius - z * z) : radius;
        const int steps = static_cast<int>(2 * std::numbers::pi * radius / spacing);
        for (int n = 0; n < steps; ++n) {
            const double angle = 2 * std::numbers::pi * n / steps;
            add(r * std::cos(angle), r * std::sin(angle), z, 0);
        }
    }
    for (const double side : {-1.0, 1.0}) {
        if (ball) break;
        out.patches.push_back(plane({o[0], o[1], o[2] + side * half_height}, {0, 0, side}));
        for (double x = -radius; x < radius; x += spacing)
            for (double y = -radius; y < radius; y += spacing)
                if (std::hypot(x, y) < radius)
                    add(x, y, side * half_height,
                        static_cast<std::int32_t>(out.patches.size() - 1));
    }
    std::set<std::array<std::int32_t, 3>> cells;
    const auto index = [](double v) { return static_cast<std::int32_t>(std::floor(v / h)); };
    for (std::size_t n = 0; n < out.cloud.size(); ++n)
        cells.insert({index(out.cloud.x[n]), index(out.cloud.y[n]), index(out.cloud.z[n])});
    const double reach = std::hypot(half_height, radius);
    for (std::int32_t i = index(o[0] - reach); i <= index(o[0] + reach); ++i)
        for (std::int32_t j = index(o[1] - reach); j <= index(o[1] + reach); ++j)
            for (std::int32_t k = index(o[2] - reach); k <= index(o[2] + reach); ++k) {
                const Vec3 p{(i + 0.5) * h, (j + 0.5) * h, (k + 0.5) * h};
                if (quadric.value(p) < 0 && std::abs(p[2] - o[2]) < half_height)
                    cells.insert({i, j, k});
            }
    out.cells.voxel_m = h;
    for (const auto& at : cells) out.cells.add(at, 0, Basis::surface);
    return out;
}

SurfacePatch quadric(const Vec3& middle, double radius, double along_z) {
    SurfacePatch out;
    out.origin = middle;
    const double s = 1 / (2 * radius);
    out.c = {-radius / 2, 0, 0, 0, s, s, s * along_z, 0, 0, 0};
    out.noise_m = 1e-4;
    out.offset_m = 3e-5;
    return out;
}

void expect_volume(const Scanned& scanned, double volume) {
    const BoundaryCells boundary = boundary_of(scanned);
    SurfaceMesh mesh = mesh_of(scanned.cells, boundary);
    expect_closed(mesh);
    EXPECT_NEAR(volume_of(mesh.vertex, mesh.triangle) / volume, 1, 0.01);
    expect_normals(shaded(mesh, boundary.patches));
    const std::size_t before = mesh.triangle.size();
    simplify(mesh, boundary.patches, {.tolerance_m = 0.01 * h}, pool);
    expect_closed(mesh);
    EXPECT_LT(mesh.triangle.size(), before);
    EXPECT_NEAR(volume_of(mesh.vertex, mesh.triangle) / volume, 1, 0.01);
    expect_normals(shaded(mesh, boundary.patches));
}

TEST(SurfaceMesh, a_tilted_box_is_six_flat_faces) {
    for (int turn = 0; turn < 6; ++turn) {
        SCOPED_TRACE(turn);
        const Box box{{0.31 + 0.0037 * turn, -0.2, 0.5 + 0.003 * turn},
                      {0.05, 0.08, 0.12},
                      turned(0.3 * turn, 0.1 * turn, -0.07 * turn)};
        const Scanned scanned = scan({box}, h);
        expect_volume(scanned, box.volume());
        const BoundaryCells boundary = boundary_of(scanned);
        SurfaceMesh mesh = mesh_of(scanned.cells, boundary);
        for (const Vec3& v : mesh.vertex)
            EXPECT_TRUE(box.holds({v[0], v[1], v[2]}, 0.02 * h))
                << (box.axes.transpose() * (Eigen::Vector3d(v[0], v[1], v[2]) - box.middle))
                       .transpose();
        simplify(mesh, boundary.patches, {.tolerance_m = 0.01 * h}, pool);
        EXPECT_LE(mesh.vertex.size(), 16u) << "corners, and what a fold left at them";
    }
}

TEST(SurfaceMesh, a_cylinder_and_a_ball_are_round) {
    const Vec3 middle{0.107, -0.203, 0.511};
    for (const double radius : {0.05, 0.113}) {
        SCOPED_TRACE(radius);
        expect_volume(round(quadric(middle, radius, 0), 0.103, radius, false),
                      std::numbers::pi * radius * radius * 0.206);
        expect_volume(round(quadric(middle, radius, 1), radius, radius, true),
                      4 * std::numbers::pi / 3 * radius * radius * radius);
    }
}

// 18 mm, so that each of its voxels holds both of its sides or one.
TEST(SurfaceMesh, a_thin_board_is_one_closed_sheet_of_its_thickness) {
    for (const double pitch : {0.0, 0.02, 0.3}) {
        SCOPED_TRACE(pitch);
        const Box board{{0.013, 0.021, 0.507}, {0.2, 0.15, 0.009}, turned(0.2, pitch, 0)};
        const Scanned scanned = scan({board}, h);
        expect_volume(scanned, board.volume());
        const BoundaryCells boundary = boundary_of(scanned);
        const SurfaceMesh mesh = mesh_of(scanned.cells, boundary);
        for (const Vec3& v : mesh.vertex) {
            const Eigen::Vector3d own =
                board.axes.transpose() * (Eigen::Vector3d(v[0], v[1], v[2]) - board.middle);
            const bool at_rim = std::abs(own.x()) > 0.2 - h || std::abs(own.y()) > 0.15 - h;
            EXPECT_LT(std::abs(own.z()), 0.009 + (at_rim ? 0.1 * h : 1e-4));
            EXPECT_GT(std::abs(own.z()), at_rim ? -1 : 0.009 - 1e-4);
        }
        EXPECT_EQ(euler_of(mesh), 2) << "one sheet, no hole";
    }
}

// Two primitives of one object side by side leave no wall between them; two objects each close.
TEST(SurfaceMesh, what_lies_between_an_objects_primitives_is_no_surface) {
    const Box left{{-0.05, 0, 0.1}, {0.05, 0.06, 0.1}, Eigen::Matrix3d::Identity(), 0b111101},
        right{{0.05, 0, 0.1}, {0.05, 0.06, 0.1}, Eigen::Matrix3d::Identity(), 0b111110};
    const Scanned scanned = scan({left, right}, h);
    const BoundaryCells boundary = boundary_of(scanned, 2);
    const SurfaceMesh whole = mesh_of(scanned.cells, boundary, 2);
    expect_closed(whole);
    EXPECT_EQ(euler_of(whole), 2);
    EXPECT_NEAR(volume_of(whole.vertex, whole.triangle) / (left.volume() + right.volume()), 1,
                0.01);
    const std::vector<std::int32_t> apart{0, 1};
    const auto voxels = object_voxels(scanned.cells, boundary, apart);
    const auto second = std::ranges::find(voxels, 1, &ObjectVoxel::object);
    double volume = 0;
    for (const auto& part : {std::span(voxels.begin(), second), std::span(second, voxels.end())}) {
        const SurfaceMesh mesh = surface_mesh(part, boundary, apart, h, pool);
        expect_closed(mesh);
        volume += volume_of(mesh.vertex, mesh.triangle);
    }
    EXPECT_NEAR(volume / (left.volume() + right.volume()), 1, 0.01);
}

// A floor of which only the top was seen: a layer of voxels, askew, so that the floor's plane
// leaves some of them nearly nothing.
TEST(SurfaceMesh, a_floor_seen_from_above_has_no_holes) {
    const Box floor{{0, 0, 0.1}, {0.6, 0.5, 1e-4}, turned(0, 0.03, 0.01), 0b100000};
    const Scanned scanned = scan({floor}, h);
    for (const bool sheet : {false, true}) {
        SCOPED_TRACE(sheet);
        const auto device = device::open_native();
        const BoundaryCells boundary =
            find_boundary(*device, scanned.cells, scanned.seen(), scanned.patches, {sheet});
        const SurfaceMesh mesh = mesh_of(scanned.cells, boundary);
        expect_closed(mesh);
        EXPECT_EQ(euler_of(mesh), 2);
        EXPECT_GT(volume_of(mesh.vertex, mesh.triangle), 0.2 * h * 1.2);
        double seen = 0;
        for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
            if (mesh.facet[t].patch != no_patch) seen += area_of(mesh, t);
        EXPECT_NEAR(seen, 1.2, 0.05);
    }
}

SolidCells cells_of(const std::vector<std::array<std::int32_t, 3>>& places) {
    SolidCells out;
    out.voxel_m = h;
    for (const auto& at : std::set(places.begin(), places.end())) out.add(at, 0, Basis::surface);
    return out;
}

// Voxels of a lump, a hole through it, and single ones around that touch at edges and corners only.
TEST(SurfaceMesh, is_closed_around_any_voxels) {
    std::uint32_t random = 1;
    for (int round = 0; round < 30; ++round) {
        std::vector<std::array<std::int32_t, 3>> places;
        for (std::int32_t i = -4; i < 5; ++i)
            for (std::int32_t j = -3; j < 6; ++j)
                for (std::int32_t k = 0; k < 7; ++k) {
                    random = random * 1664525U + 1013904223U;
                    const bool hole = i == 1 && j == 2;
                    if ((!hole && k < 3) || (random >> 16) % 3 == 0) places.push_back({i, j, k});
                }
        SurfaceMesh mesh = mesh_of(cells_of(places), {});
        expect_closed(mesh);
        simplify(mesh, {}, {.tolerance_m = 0.01 * h}, pool);
        expect_closed(mesh);
        const ShadedMesh shade = shaded(mesh, {});
        for (const Vec3& n : shade.normal) ASSERT_NEAR(length(n), 1, 1e-9);
        for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
            for (std::size_t n = 0; n < 3; ++n)
                ASSERT_EQ(shade.from[shade.triangle[t][n]], mesh.triangle[t][n]);
    }
}

// The two touch along an edge, and hang together around it: all four faces there share both of its
// ends.
TEST(SurfaceMesh, is_closed_at_a_pinched_edge) {
    std::vector<std::array<std::int32_t, 3>> ring{{0, 0, 0}, {1, 1, 0}};
    for (const std::int32_t k : {-1, 1})
        for (const auto& at : {std::array{0, 0}, {1, 0}, {1, 1}}) ring.push_back({at[0], at[1], k});
    const SolidCells cells = cells_of(ring);
    const std::vector<std::int32_t> object{0};
    const BlockSurface surface = block_surface(object_voxels(cells, {}, object));
    EXPECT_EQ(
        std::ranges::count_if(surface.face, [](const VoxelFace& f) { return f.pinched != 0; }), 4);
    expect_closed(mesh_of(cells, {}));
}

TEST(SurfaceMesh, without_patches_is_smooth_and_about_as_large) {
    std::vector<std::array<std::int32_t, 3>> places;
    for (std::int32_t i = -12; i < 12; ++i)
        for (std::int32_t j = -12; j < 12; ++j)
            for (std::int32_t k = -12; k < 12; ++k)
                if (std::hypot(i + 0.5, j + 0.5, k + 0.5) < 11) places.push_back({i, j, k});
    const SurfaceMesh mesh = mesh_of(cells_of(places), {});
    expect_closed(mesh);
    const double ball = 4 * std::numbers::pi / 3 * std::pow(11 * h, 3);
    EXPECT_NEAR(volume_of(mesh.vertex, mesh.triangle) / ball, 1, 0.02);
    // Voxels' sides would have half as much again.
    double area = 0;
    for (std::size_t t = 0; t < mesh.triangle.size(); ++t) area += area_of(mesh, t);
    EXPECT_LT(area, 1.08 * 4 * std::numbers::pi * std::pow(11 * h, 2));
}

TEST(SurfaceMesh, of_nothing_is_empty) {
    EXPECT_TRUE(object_voxels({}, {}, {}).empty());
    SurfaceMesh mesh = mesh_of({}, {});
    EXPECT_TRUE(mesh.vertex.empty());
    simplify(mesh, {}, {.tolerance_m = h}, pool);
    EXPECT_TRUE(mesh.triangle.empty());
    EXPECT_TRUE(shaded(mesh, {}).vertex.empty());
}

TEST(SimplifyMesh, keeps_edges_as_short_as_it_is_told_to) {
    const Box box{{0.3, 0.1, 0.2}, {0.1, 0.15, 0.2}, turned(0.3, 0.2, 0.1)};
    const Scanned scanned = scan({box}, h);
    const BoundaryCells boundary = boundary_of(scanned);
    SurfaceMesh mesh = mesh_of(scanned.cells, boundary);
    const std::size_t before = mesh.triangle.size();
    simplify(mesh, boundary.patches, {.tolerance_m = 0.01 * h, .longest_m = 3 * h}, pool);
    EXPECT_LT(mesh.triangle.size(), before / 2);
    for (const auto& t : mesh.triangle)
        for (std::size_t n = 0; n < 3; ++n)
            EXPECT_LE(length(minus(mesh.vertex[t[n]], mesh.vertex[t[(n + 1) % 3]])), 3 * h);
}

TEST(SimplifyMesh, is_the_same_for_any_number_of_threads) {
    const Box box{{0.3, 0.1, 0.2}, {0.9, 0.9, 0.1}, turned(0.3, 0.2, 0.1)};
    const Scanned scanned = scan({box}, h);
    const BoundaryCells boundary = boundary_of(scanned);
    const SurfaceMesh whole = mesh_of(scanned.cells, boundary);
    SurfaceMesh first;
    for (const unsigned threads : {1u, 3u}) {
        ThreadPool some(threads);
        SurfaceMesh mesh = whole;
        simplify(mesh, boundary.patches, {.tolerance_m = 0.01 * h}, some);
        expect_closed(mesh);
        EXPECT_NEAR(volume_of(mesh.vertex, mesh.triangle) / box.volume(), 1, 0.01);
        EXPECT_LT(mesh.vertex.size(), 500u);
        if (first.vertex.empty()) first = mesh;
        EXPECT_EQ(mesh.vertex, first.vertex);
        EXPECT_EQ(mesh.triangle, first.triangle);
    }
}

// Of a wall that is two primitives, the upper and the lower half.
TEST(SimplifyMesh, keeps_borders_between_primitives) {
    const Box lower{{0, 0, 0.1}, {0.2, 0.05, 0.1}, Eigen::Matrix3d::Identity(), 0b011111},
        upper{{0, 0, 0.3}, {0.2, 0.05, 0.1}, Eigen::Matrix3d::Identity(), 0b101111};
    const Scanned scanned = scan({lower, upper}, h);
    const BoundaryCells boundary = boundary_of(scanned, 2);
    SurfaceMesh mesh = mesh_of(scanned.cells, boundary, 2);
    simplify(mesh, boundary.patches, {.tolerance_m = 0.01 * h}, pool);
    for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
        for (const std::uint32_t v : mesh.triangle[t]) {
            const double z = mesh.vertex[v][2];
            EXPECT_TRUE(mesh.facet[t].primitive == 0 ? z < 0.2 + h : z > 0.2 - h) << z;
        }
    }
}

}  // namespace
}  // namespace topple::solids

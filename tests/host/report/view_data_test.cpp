// SPDX-License-Identifier: MIT
#include "report/view_data.h"

#include "report/embedded.h"
#include "report/surface_packer.h"
#include "synthetic_scene.h"
#include "testing.h"

namespace topple::report {
namespace {

// RFC 4648, section 10.
TEST(Base64, the_standards_own_examples) {
    for (const auto& [text, encoded] :
         {std::pair("", ""), std::pair("f", "Zg=="), std::pair("fo", "Zm8="),
          std::pair("foo", "Zm9v"), std::pair("foob", "Zm9vYg=="), std::pair("fooba", "Zm9vYmE="),
          std::pair("foobar", "Zm9vYmFy")}) {
        EXPECT_EQ(base64(text, std::strlen(text)), encoded);
    }
    EXPECT_EQ(base64("\xff\xef\xbe", 3), "/+++");
}

Scene cube_of(int n, double voxel_m) {
    Scene scene;
    scene.voxel_size_m = voxel_m;
    for (int i = 0; i < n * n * n; ++i) {
        test::add(scene.solid, (i % n + 0.5) * voxel_m - 3, (i / n % n + 0.5) * voxel_m,
                  (i / n / n + 0.5) * voxel_m + 1);
        scene.solid.primitive.push_back(3);
        scene.solid.object.push_back(2);
        scene.solid.state.push_back(i % 2 == 0);
    }
    return scene;
}

Vec3 place(const PackedView& view, const std::array<std::uint16_t, 4>& cell) {
    Vec3 p;
    for (std::size_t axis = 0; axis < 3; ++axis)
        p[axis] = view.origin_m[axis] + view.step_m[axis] * cell[axis];
    return p;
}

TEST(ViewData, only_voxels_with_an_exposed_face) {
    const auto view = pack_view(cube_of(5, 0.02));
    EXPECT_EQ(view.voxels.total, 125u);
    ASSERT_EQ(view.voxels.cell.size(), 125u - 27u);
    EXPECT_EQ(view.cube_m, 0.02);
    int faces = 0;
    for (std::size_t i = 0; i < view.voxels.cell.size(); ++i) {
        const auto p = place(view, view.voxels.cell[i]);
        const auto flags = view.voxels.aux[i][3];
        // A face is exposed exactly on the cube's side.
        EXPECT_EQ((flags & 1) != 0, p[0] < -3 + 0.02) << i;
        EXPECT_EQ((flags & 2) != 0, p[0] > -3 + 0.08) << i;
        EXPECT_EQ((flags & 16) != 0, p[2] < 1.02) << i;
        EXPECT_EQ((flags & 32) != 0, p[2] > 1.08) << i;
        for (int face = 0; face < 6; ++face) faces += flags >> face & 1;
        EXPECT_EQ(view.groups[view.voxels.cell[i][3]],
                  (std::pair<std::int32_t, std::int32_t>(3, 2)));
    }
    EXPECT_EQ(faces, 6 * 25);
}

TEST(ViewData, strays_leave_the_rest_its_steps) {
    Scene scene = cube_of(12, 0.02);
    for (const float far : {1e4f, -2e4f}) {
        test::add(scene.solid, far, 1, far);
        scene.solid.primitive.push_back(-1);
        scene.solid.object.push_back(-1);
        scene.solid.state.push_back(0);
    }
    const auto view = pack_view(scene);
    EXPECT_EQ(view.voxels.total, 12u * 12 * 12 + 2);
    EXPECT_EQ(view.voxels.cell.size(), 12u * 12 * 12 - 10 * 10 * 10);
    for (const double step : view.step_m) EXPECT_LT(step, 2e-3);
}

TEST(ViewData, places_are_right_to_a_sixty_thousandth) {
    const auto scene = test::SyntheticScene(0.05).make();
    const auto view = pack_view(scene);
    ASSERT_EQ(view.points.cell.size(), scene.points.x.size());
    const auto& r = view.view_from_input;
    for (std::size_t i = 0; i < scene.points.x.size(); i += 97) {
        const auto p = place(view, view.points.cell[i]);
        const Vec3 in{scene.points.x[i], scene.points.y[i], scene.points.z[i]};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double turned = r[axis][0] * in[0] + r[axis][1] * in[1] + r[axis][2] * in[2];
            EXPECT_NEAR(p[axis], turned, view.step_m[axis] * 0.51 + 1e-6);
        }
    }
    EXPECT_NEAR(r[0][0], std::cos(0.4), 1e-12) << "the scene's own frame is the view's";
}

TEST(ViewData, up_becomes_z_where_the_scene_has_no_frame) {
    for (const Vec3& up :
         {Vec3{0, 0, 1}, Vec3{0, -1, 0}, Vec3{0.6, 0, -0.8}, Vec3{0, 0, 0}, Vec3{NAN, 0, 0}}) {
        Scene scene = cube_of(2, 0.1);
        scene.up = up;
        const auto r = pack_view(scene).view_from_input;
        const bool given = up[0] * up[0] + up[1] * up[1] + up[2] * up[2] > 0.5;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(r[2][axis], given ? up[axis] : (axis == 2), 1e-12);
            EXPECT_NEAR(r[axis][0] * r[axis][0] + r[axis][1] * r[axis][1] + r[axis][2] * r[axis][2],
                        1, 1e-12);
        }
        EXPECT_NEAR(r[0][0] * r[1][0] + r[0][1] * r[1][1] + r[0][2] * r[1][2], 0, 1e-12);
    }
}

TEST(ViewData, large_scenes_are_thinned_to_the_limits) {
    auto scene = test::SyntheticScene(0.05).make();
    const ViewLimits limits{.voxels = 4000, .points = 3000, .arrows = 100};
    const auto view = pack_view(scene, limits);
    EXPECT_LE(view.voxels.cell.size(), limits.voxels);
    EXPECT_GT(view.voxels.cell.size(), limits.voxels / 8);
    EXPECT_GT(view.cube_m, scene.voxel_size_m);
    EXPECT_NEAR(double(view.points.cell.size()), 3000, 300);
    for (const auto& [name, arrows] : view.fields) {
        EXPECT_LE(arrows.arrow.size(), limits.arrows) << name;
        EXPECT_GT(arrows.arrow.size(), limits.arrows / 8) << name;
    }
    // Every object is still there.
    std::set<std::int32_t> objects;
    for (const auto& cell : view.voxels.cell) objects.insert(view.groups[cell[3]].second);
    EXPECT_EQ(objects.size(), 6u);
}

// Merged cubes cover what they stand for: each voxel lies in one.
TEST(ViewData, merged_cubes_lie_where_their_voxels_are) {
    const auto scene = cube_of(8, 0.02);
    const auto view = pack_view(scene, {.voxels = 60, .points = 1, .arrows = 1});
    EXPECT_EQ(view.cube_m, 0.04);
    ASSERT_EQ(view.voxels.cell.size(), 56u) << "4^3 less its 2^3 inside";
    for (const auto& cell : view.voxels.cell) {
        const double x = (place(view, cell)[0] + 3) / 0.04 - 0.5;
        EXPECT_NEAR(x, std::round(x), view.step_m[0] / 0.04) << "cubes of 4 cm from the edge on";
    }
}

TEST(ViewData, what_is_not_finite_or_out_of_range_is_harmless) {
    auto scene = cube_of(3, 0.02);
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                inf = std::numeric_limits<float>::infinity();
    scene.solid.x[4] = nan;
    scene.solid.z[5] = inf;
    scene.solid.object[6] = -7;
    scene.solid.primitive[7] = std::numeric_limits<std::int32_t>::min();
    scene.points = {{nan, 1, 1e30f}, {0, 0, 0}, {0, 0, 0}, {0, nan, 0},
                    {0, 0, 0},       {1, 1, 1}, {0, 0, 0}, {0, 0, 0}};
    scene.fields["wind"] = {{0, nan}, {0, 0}, {0, 0}, {inf, 1}, {0, 0}, {0, 0}, {nan, 1}};
    const auto view = pack_view(scene);
    EXPECT_LE(view.voxels.cell.size(), 25u);
    EXPECT_EQ(view.points.cell.size(), 2u);
    EXPECT_TRUE(view.fields.at("wind").arrow.empty());
}

TEST(ViewData, nothing_at_all) {
    const auto view = pack_view(Scene{});
    EXPECT_TRUE(view.voxels.cell.empty());
    EXPECT_TRUE(view.points.cell.empty());
}

constexpr std::array<Vec3, 3> quarter_turn{{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}};

TEST(Walks, keep_their_place_floor_and_visits) {
    const Walks walks{.corner_m = {1, 2, 0.5},
                      .along_x_m = {0.1, 0, 0},
                      .along_y_m = {0, 0.2, 0},
                      .nx = 3,
                      .ny = 2,
                      .floor_m = {0, 0.01f, 0, 0, 0, -0.02f},
                      .visits = {-1, 0, 0.25f, 1, -1, 0.01f},
                      .paths = {{{1, 2, 0.5}, {1.2, 2.3, 0.5}}, {{1, 2, 0.5}}}};
    const PackedWalks packed = pack_walks(walks, quarter_turn, 6);
    EXPECT_EQ(packed.nx, 3);
    EXPECT_EQ(packed.ny, 2);
    EXPECT_EQ(packed.corner_m, (Vec3{2, -1, 0.5}));
    EXPECT_EQ(packed.along_x_m, (Vec3{0, -0.1, 0}));
    EXPECT_EQ(packed.along_y_m, (Vec3{0.2, 0, 0}));
    EXPECT_EQ(packed.floor_mm, (std::vector<std::int16_t>{0, 10, 0, 0, 0, -20}));
    // The busiest of so few is the middle one of the three that are not 0.
    EXPECT_EQ(packed.most, 0.25);
    EXPECT_EQ(packed.shade, (std::vector<std::uint8_t>{0, 1, 255, 255, 0, 52}));
    ASSERT_EQ(packed.paths.size(), 1u) << "one place is no way";
    EXPECT_EQ(packed.paths[0][1][0], 2.3f);
    EXPECT_EQ(packed.paths[0][1][1], -1.2f);
}

// Cells of 0.1 m without floor and visits.
Walks five_by_three() {
    Walks walks;
    walks.along_x_m = {0.1, 0, 0};
    walks.along_y_m = {0, 0.1, 0};
    walks.nx = 5;
    walks.ny = 3;
    return walks;
}

TEST(Walks, of_many_cells_are_merged) {
    Walks walks = five_by_three();
    walks.floor_m.assign(15, 0.25f);
    walks.visits = {1, 3, -1, -1, 0,  //
                    2, 2, -1, -1, 0,  //
                    8, 8, 0,  0,  -1};
    const PackedWalks packed = pack_walks(walks, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 6);
    EXPECT_EQ(packed.nx, 3);
    EXPECT_EQ(packed.ny, 2);
    EXPECT_EQ(packed.along_x_m, (Vec3{0.2, 0, 0}));
    EXPECT_EQ(packed.most, 2) << "8 is above 99 of 100 of the two";
    EXPECT_EQ(packed.shade, (std::vector<std::uint8_t>{255, 0, 1, 255, 1, 0}));
    EXPECT_EQ(packed.floor_mm[0], 250);
}

TEST(Walks, that_do_not_fit_together_are_left_out) {
    Walks walks = five_by_three();
    const std::array<Vec3, 3> as_is{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    EXPECT_EQ(pack_walks(walks, as_is, 100).nx, 0) << "no floor, no visits";
    walks.floor_m.assign(15, 0);
    walks.visits.assign(15, std::numeric_limits<float>::infinity());
    const PackedWalks packed = pack_walks(walks, as_is, 100);
    EXPECT_EQ(packed.shade, std::vector<std::uint8_t>(15, 0));
    walks.nx = walks.ny = std::int64_t{1} << 40;
    EXPECT_EQ(pack_walks(walks, as_is, 100).nx, 0);
}

// Light and the look through walls go by normals: those of the points, for the ground spread to
// voxels that have none.
TEST(ViewData, voxels_know_which_side_was_seen) {
    const auto scene = test::SyntheticScene(0.05, 0).make();
    const auto view = pack_view(scene);
    int checked = 0;
    for (std::size_t i = 0; i < view.voxels.cell.size(); ++i) {
        const auto p = place(view, view.voxels.cell[i]);
        const auto& aux = view.voxels.aux[i];
        if (view.groups[view.voxels.cell[i][3]].second != 0) {
            EXPECT_EQ(std::hypot(aux[0], aux[1], aux[2]), 127) << "each of these has a point";
        } else if (p[2] > 2.5 && p[0] > 0.2 && p[0] < 3.8 && p[1] > 0.2 && p[1] < 4.8) {
            EXPECT_LT(aux[2], -100) << "the ceiling was seen from below";
            ++checked;
        }
    }
    EXPECT_GT(checked, 1000);
}

// Red from the left of a block, blue from the right; in the middle nothing was seen. A block beside
// it has no known colour.
TEST(ViewData, colours_of_the_scan_spread_over_what_it_did_not_see) {
    Scene scene = cube_of(9, 0.02);
    for (std::size_t i = 0; i < scene.solid.x.size(); ++i)
        if (scene.solid.y[i] > 0.13f) scene.solid.object[i] = 5;
    EXPECT_TRUE(pack_view(scene).voxels.photo.empty());
    auto& p = scene.points;
    for (std::size_t i = 0; i < scene.solid.x.size(); ++i) {
        const float x = scene.solid.x[i] + 3;
        if (x > 0.03f && x < 0.15f) continue;
        test::add(p, scene.solid.x[i], scene.solid.y[i], scene.solid.z[i]);
        p.primitive.push_back(3);
        p.object.push_back(scene.solid.object[i]);
        const bool known = p.object.back() == 2;
        p.red.push_back(known && x < 0.1f ? 200 : 0);
        p.green.push_back(0);
        p.blue.push_back(known && x > 0.1f ? 200 : 0);
    }
    const auto view = pack_view(scene);
    EXPECT_TRUE(view.coloured);
    ASSERT_EQ(view.voxels.photo.size(), view.voxels.cell.size());
    ASSERT_EQ(view.points.photo.size(), view.points.cell.size());
    for (std::size_t i = 0; i < view.voxels.cell.size(); ++i) {
        const auto& photo = view.voxels.photo[i];
        if (view.groups[view.voxels.cell[i][3]].second == 5) {
            EXPECT_EQ(photo[3], 0) << "another object's colours are not its own";
            continue;
        }
        ASSERT_EQ(photo[3], 255);
        const double x = place(view, view.voxels.cell[i])[0] + 3;
        if (std::abs(x - 0.09) < 0.005) continue;  // half way
        EXPECT_EQ(photo[x < 0.09 ? 0 : 2], 200) << x;
        EXPECT_EQ(photo[x < 0.09 ? 2 : 0], 0) << x;
    }
    for (std::size_t i = 0; i < view.points.cell.size(); ++i) {
        const auto& photo = view.points.photo[i];
        EXPECT_EQ(photo[3], photo[0] + photo[2] > 0 ? 255 : 0);
    }
}

// A cube of n voxels as one surface of 12 triangles, its upper half another primitive's.
ObjectSurface surface_of(const Scene& scene, int n) {
    ObjectSurface out;
    out.object = scene.solid.object[0];
    const double size = n * scene.voxel_size_m;
    for (int axis = 0; axis < 3; ++axis) {
        for (const int side : {0, 1}) {
            const auto first = static_cast<std::uint32_t>(out.vertex.size());
            for (const auto& [u, v] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
                Vec3 at{}, normal{};
                at[std::size_t(axis)] = side * size;
                at[std::size_t(axis + 1) % 3] = u * size;
                at[std::size_t(axis + 2) % 3] = v * size;
                normal[std::size_t(axis)] = 2 * side - 1;
                out.vertex.push_back({at[0] - 3, at[1], at[2] + 1});
                out.normal.push_back(normal);
            }
            const std::uint32_t b = side ? 1 : 3, d = side ? 3 : 1;
            out.triangle.push_back({first, first + b, first + 2});
            out.triangle.push_back({first, first + 2, first + d});
            out.primitive.push_back(3);
            out.primitive.push_back(axis == 2 && side ? 4 : 3);
        }
    }
    return out;
}

// As the page reads them.
std::vector<std::size_t> numbers_of(const PackedSurface& surface) {
    std::vector<std::size_t> out;
    std::size_t next = 0;
    for (const auto& triangle : surface.index)
        for (const std::uint16_t back : triangle) out.push_back(back ? next - back : next++);
    EXPECT_EQ(next, surface.cell.size());
    return out;
}

TEST(ViewData, surfaces_go_in_place_of_voxels) {
    auto scene = cube_of(5, 0.02);
    const std::vector surfaces{surface_of(scene, 5)};
    const auto view = pack_view(scene, {}, surfaces);
    EXPECT_TRUE(view.voxels.cell.empty());
    EXPECT_EQ(view.voxels.total, 125u);
    ASSERT_EQ(view.surface.index.size(), 12u);
    EXPECT_EQ(view.surface.cell.size(), 24u + 2) << "one triangle is of another group";
    EXPECT_EQ(view.surface.aux.size(), view.surface.cell.size());
    EXPECT_TRUE(view.surface.photo.empty());
    const auto number = numbers_of(view.surface);
    std::map<std::int32_t, int> triangles;  // of each primitive
    double six_volumes = 0;
    for (std::size_t t = 0; t < 12; ++t) {
        std::array<Vec3, 3> p;
        for (std::size_t n = 0; n < 3; ++n) {
            const auto& cell = view.surface.cell[number[3 * t + n]];
            p[n] = place(view, cell);
            EXPECT_EQ(view.groups[cell[3]].second, 2);
        }
        ++triangles[view.groups[view.surface.cell[number[3 * t]][3]].first];
        for (std::size_t a = 0; a < 3; ++a)
            six_volumes += p[0][a] * (p[1][(a + 1) % 3] * p[2][(a + 2) % 3] -
                                      p[1][(a + 2) % 3] * p[2][(a + 1) % 3]);
    }
    EXPECT_EQ(triangles, (std::map<std::int32_t, int>{{3, 11}, {4, 1}}));
    EXPECT_NEAR(six_volumes / 6, 1e-3, 1e-6) << "also on the border of what is drawn";
    for (const auto& aux : view.surface.aux) {
        EXPECT_EQ(std::abs(aux[0]) + std::abs(aux[1]) + std::abs(aux[2]), 127);
        EXPECT_EQ(aux[3] & 31, no_direction) << "a thing is never looked through";
    }
}

TEST(ViewData, surfaces_of_the_ground_know_which_side_was_seen) {
    auto scene = cube_of(5, 0.02);
    scene.objects.resize(3);
    scene.objects[2].id = 2;
    scene.objects[2].grounded = true;
    // Seen from above only.
    scene.points = {{-2.95f}, {0.05f}, {1.099f}, {0}, {0}, {1}, {3}, {2}};
    const std::vector surfaces{surface_of(scene, 5)};
    const auto view = pack_view(scene, {}, surfaces);
    for (std::size_t v = 0; v < view.surface.aux.size(); ++v) {
        const auto& aux = view.surface.aux[v];
        if (aux[2] != 0) {
            EXPECT_EQ(aux[3] & 31, 13 + 9) << "up, also from below";
        }
    }
}

TEST(ViewData, surfaces_have_the_scans_colours) {
    auto scene = cube_of(5, 0.02);
    scene.points = {{-2.95f}, {0.05f}, {1.099f}, {0}, {0}, {1}, {3}, {2}};
    scene.points.red = scene.points.green = scene.points.blue = {7};
    std::vector surfaces{surface_of(scene, 5)};
    surfaces[0].colour.assign(24, Rgb8{10, 20, 30});
    surfaces[0].colour[0].reset();
    const auto view = pack_view(scene, {}, surfaces);
    ASSERT_EQ(view.surface.photo.size(), view.surface.cell.size());
    EXPECT_EQ(view.surface.photo[0], (std::array<std::uint8_t, 4>{0, 0, 0, 0}));
    EXPECT_EQ(view.surface.photo[1], (std::array<std::uint8_t, 4>{10, 20, 30, 255}));
}

TEST(ViewData, surfaces_that_are_too_large_are_left_out) {
    auto scene = cube_of(5, 0.02);
    const std::vector surfaces{surface_of(scene, 5)};
    const auto view = pack_view(scene, {.surface_bytes = 300}, surfaces);
    EXPECT_TRUE(view.surface.cell.empty());
    EXPECT_FALSE(view.voxels.cell.empty());
}

// Vertices whose numbers don't fit into 16 bits any more come again.
TEST(ViewData, surfaces_may_have_many_vertices) {
    ObjectSurface fan;
    for (std::uint32_t n = 0; n < 80000; ++n) {
        fan.vertex.push_back({n * 1e-5, n % 2 * 1e-3, 1});
        fan.normal.push_back({0, 0, 1});
        if (n < 2) continue;
        fan.triangle.push_back({0, n - 1, n});
        fan.primitive.push_back(0);
    }
    const auto group = [](const ObjectSurface&, std::int32_t) { return std::uint16_t{1}; };
    const auto vertex = [](const ObjectSurface&, std::size_t v, std::uint16_t g) {
        Record out;
        out.cell = {static_cast<std::uint16_t>(v & 65535), static_cast<std::uint16_t>(v >> 16), 0,
                    g};
        return out;
    };
    ThreadPool pool(3);
    const PackedSurface packed = pack_surfaces({&fan, 1}, {false, group, vertex}, SIZE_MAX, pool);
    EXPECT_EQ(packed.cell.size(), 80001u);
    const auto number = numbers_of(packed);
    for (std::size_t i = 0; i < number.size(); ++i) {
        const auto& cell = packed.cell.at(number[i]);
        ASSERT_EQ(cell[0] + (std::uint32_t{cell[1]} << 16), fan.triangle[i / 3][i % 3]);
    }
}

TEST(ViewData, directions_have_codes) {
    for (int code = 0; code < 27; ++code) {
        const std::array<float, 3> d{float(code % 3 - 1), float(code / 3 % 3 - 1),
                                     float(code / 9 - 1)};
        EXPECT_EQ(direction_code(d), code);
    }
    EXPECT_EQ(direction_code({0.95f, 0.1f, -0.2f}), 14);
}

}  // namespace
}  // namespace topple::report

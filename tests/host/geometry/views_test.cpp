// SPDX-License-Identifier: MIT
#include "device/devices.h"
#include "geometry/free_space.h"
#include "geometry/sight_lines.h"
#include "host/geometry/sampled_faces.h"
#include "host/geometry/split_scenes.h"
#include "points/single_scan.h"
#include "points/virtual_views.h"
#include "testing.h"
#include "topple/kernel_testing/random.h"

namespace topple::geometry {
namespace {

using test::add;

// What a camera at the origin sees: a wall two metres ahead and a ball before it, z ahead.
PointCloud scan() {
    PointCloud cloud;
    for (int v = -100; v < 100; ++v) {
        for (int u = -140; u < 140; ++u) {
            const double x = u / 250.0, y = v / 250.0;
            const double a = x * x + y * y + 1, b = 1.2, c = 1.2 * 1.2 - 0.2 * 0.2;
            const double inside = b * b - a * c;
            const double z = inside > 0 ? (b - std::sqrt(inside)) / a : 2;
            add(cloud, {x * z, y * z, z});
        }
    }
    return cloud;
}

TEST(SingleScan, IsFoundByWhatItHides) {
    const PointCloud cloud = scan();
    const auto found = find_single_scan(cloud, {0, 0, 0}, 0.008);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->spacing, 1 / 250.0, 0.001);
    ASSERT_TRUE(found->up);
    EXPECT_EQ(*found->up, (Vec3{0, -1, 0}));
    EXPECT_FALSE(
        find_single_scan(cloud, {0.6, 0, 0}, 0.008));  // the ball hides the wall it did not
    PointCloud away = cloud;                           // normals that face away from the origin
    away.nx.assign(cloud.size(), 0);
    away.ny.assign(cloud.size(), 0);
    away.nz.assign(cloud.size(), 1);
    EXPECT_FALSE(find_single_scan(away, {0, 0, 0}, 0.008));
    EXPECT_FALSE(find_single_scan({}, {0, 0, 0}, 0.008));
}

// A plane through the origin is seen edge-on from there: it hides nothing, and nobody took it so.
TEST(SingleScan, IsNotTakenFromWithinASurface) {
    PointCloud corner;
    for (int i = 1; i < 100; ++i) {
        for (int j = 1; j < 100; ++j) {
            add(corner, {i * 0.02, j * 0.02, 0});
            add(corner, {i * 0.02, 0, j * 0.02});
            add(corner, {0, i * 0.02, j * 0.02});
        }
    }
    EXPECT_FALSE(find_single_scan(corner, {0, 0, 0}, 0.02));
    EXPECT_TRUE(find_single_scan(corner, {1, 1, 1}, 0.02));
    PointCloud dust = scan();
    add(dust, {0.001, 0, 0.002});
    EXPECT_TRUE(find_single_scan(dust, {0, 0, 0}, 0.008));
}

// The floor goes through the origin, on which a box stands: seen edge-on the one hides nothing, and
// from within the other nothing else is seen.
TEST(SingleScan, IsNotTakenFromAFloorWithinABox) {
    PointCloud cloud;
    for (int i = -100; i < 100; ++i) {
        for (int j = -100; j < 100; ++j)
            if (std::abs(i) > 20 || std::abs(j) > 20) add(cloud, {i * 0.02, j * 0.02, 0});
    }
    for (int i = -20; i <= 20; ++i) {
        for (int j = 1; j < 40; ++j) {
            for (const double side : {-0.4, 0.4}) {
                add(cloud, {i * 0.02, side, j * 0.02});
                add(cloud, {side, i * 0.02, j * 0.02});
            }
        }
    }
    EXPECT_FALSE(find_single_scan(cloud, {0, 0, 0}, 0.02));
}

// Points at random on the part of the plane across an axis that lies between two corners.
void scatter(PointCloud& cloud, test::Random& random, double per_m2, std::size_t axis, double at,
             const Vec3& low, const Vec3& high) {
    const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
    const double area = (high[a] - low[a]) * (high[b] - low[b]);
    for (int n = 0; n < static_cast<int>(area * per_m2); ++n) {
        Vec3 p{};
        p[a] = low[a] + random.uniform() * (high[a] - low[a]);
        p[b] = low[b] + random.uniform() * (high[b] - low[b]);
        p[axis] = at;
        add(cloud, p);
    }
}

class Views : public ::testing::Test {
  protected:
    // A closed box on a bare floor of 4 x 4 m, the floor also beneath it.
    Surfels box_on_floor() {
        PointCloud cloud;
        for (double x = -2; x < 2; x += 0.02)
            for (double y = -2; y < 2; y += 0.02) add(cloud, {x, y, 0});
        const auto slab = [&](double t, double u, const Vec3& p) {
            for (double a = 0; a <= t; a += 0.02)
                for (double b = 0; b <= u; b += 0.02)
                    add(cloud, {p[0] == 9 ? bare_low[0] + a : p[0],
                                p[1] == 9 ? bare_low[1] + (p[0] == 9 ? b : a) : p[1],
                                p[2] == 9 ? b : p[2]});
        };
        slab(1, 0.5, {9, 9, 1});
        for (const double y : {bare_low[1], bare_low[1] + 0.5}) slab(1, 1, {9, y, 9});
        for (const double x : {bare_low[0], bare_low[0] + 1}) slab(0.5, 1, {x, 9, 9});
        return make_surfels(*device, cloud, 0.05, {}, {});
    }
    static constexpr Vec3 bare_low{-0.2, -0.05, 0};
    // A closed room of 4 x 3 x 2.5 m; with_box: in it the top and four sides of a box on the floor
    // whose inside nobody can have seen.
    Surfels room(bool with_box) {
        PointCloud cloud;
        add_room(cloud, with_box);
        return make_surfels(*device, cloud, 0.05, {}, {});
    }
    void add_room(PointCloud& cloud, bool with_box) {
        test::Random random(1);
        const auto face = [&](const Vec3& low, const Vec3& high, std::size_t axis, double at) {
            scatter(cloud, random, 4000, axis, at, low, high);
        };
        const Vec3 size{4, 3, 2.5};
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const double at : {0.0, size[axis]}) face({0, 0, 0}, size, axis, at);
        if (!with_box) return;
        face(box_low, box_high, 2, box_high[2]);
        for (const double at : {box_low[0], box_high[0]}) face(box_low, box_high, 0, at);
        face(box_low, box_high, 1, box_low[1]);
    }
    static constexpr Vec3 box_low{1.5, 2.1, 0}, box_high{2.5, 3, 0.8};
    std::unique_ptr<device::Device> device = device::open_native();
    ThreadPool pool{2};
};

// Its views are closed, and every ray ends on a wall.
TEST_F(Views, NoRayLeaksFromARoom) {
    const VirtualViews views =
        virtual_views(room(false), {.known_eyes = {}, .seen_from = {}, .eyes = 3}, pool);
    ASSERT_EQ(views.frames.size(), 18u);
    const Intrinsics& k = views.intrinsics;
    std::size_t pixels = 0, leaks = 0, wrong = 0;
    for (const DepthFrame& frame : views.frames) {
        const Mat4& m = frame.camera_to_world;
        for (std::uint32_t v = 0; v < k.height; ++v) {
            for (std::uint32_t u = 0; u < k.width; ++u) {
                ++pixels;
                const double z = frame.depth[v * k.width + u] / k.depth_scale;
                leaks += z == 0;
                if (z == 0) continue;
                double off = 1;
                const Vec3 size{4, 3, 2.5};
                for (std::size_t a = 0; a < 3; ++a) {
                    const double p = (m[4 * a] * (u - k.cx) / k.fx +
                                      m[4 * a + 1] * (v - k.cy) / k.fy + m[4 * a + 2]) *
                                         z +
                                     m[4 * a + 3];
                    off = std::min({off, std::abs(p), std::abs(p - size[a])});
                }
                wrong += off > 0.06;
            }
        }
    }
    EXPECT_LT(static_cast<double>(leaks), 0.01 * static_cast<double>(pixels));
    EXPECT_LT(static_cast<double>(wrong), 0.01 * static_cast<double>(pixels));
}

TEST_F(Views, EyesStayInFreeSpaceAndFaceWhatTheySee) {
    const Surfels s = room(true);
    const VirtualViews views = virtual_views(s, {}, pool);
    EXPECT_EQ(views.eyes.size(), 12u);
    for (const Vec3& eye : views.eyes) {
        const bool in_box = eye[0] > box_low[0] && eye[0] < box_high[0] && eye[1] > box_low[1] &&
                            eye[2] < box_high[2];
        EXPECT_FALSE(in_box);
        EXPECT_TRUE(eye[0] > 0 && eye[0] < 4 && eye[1] > 0 && eye[1] < 3 && eye[2] > 0 &&
                    eye[2] < 2.5);
    }
    ASSERT_EQ(views.viewpoint_of_surfel.size(), s.size());
    EXPECT_TRUE(virtual_views({}, {}, pool).frames.empty());
}

// Its inside is as much of a room as could be, but shows little of the scene; and it is looked at
// from above, where no other surface encloses the place.
TEST_F(Views, ABoxOnABareFloorIsLookedAtFromOutside) {
    const VirtualViews views = virtual_views(box_on_floor(), {}, pool);
    ASSERT_GE(views.eyes.size(), 12u);
    double highest = 0;
    for (const Vec3& eye : views.eyes) {
        EXPECT_GT(eye[2], 0);
        const bool in_box = eye[0] > bare_low[0] && eye[0] < bare_low[0] + 1 &&
                            eye[1] > bare_low[1] && eye[1] < bare_low[1] + 0.5 && eye[2] < 1;
        EXPECT_FALSE(in_box) << eye[0] << ' ' << eye[1] << ' ' << eye[2];
        highest = std::max(highest, eye[2]);
    }
    EXPECT_GT(highest, 1.1);
}

// Points that lie as they fall leave gaps in a box's faces, through which sight meets the insides
// of others: those are still seen more from without.
TEST_F(Views, GapsDoNotTurnTheFacesOfABox) {
    test::Random random(3);
    PointCloud cloud;
    const Vec3 low{-0.15, -0.15, 0}, high{0.15, 0.15, 0.5};
    const auto face = [&](std::size_t axis, double at, const Vec3& from, const Vec3& to) {
        scatter(cloud, random, 1 / (0.02 * 0.02), axis, at, from, to);
    };
    face(2, 0, {-1.5, -1.5, 0}, {1.5, 1.5, 0});
    face(2, high[2], low, high);
    for (std::size_t axis = 0; axis < 2; ++axis) {
        face(axis, -1.5, {-1.5, -1.5, 0}, {1.5, 1.5, 2});
        for (const Vec3& side : {low, high}) face(axis, side[axis], low, high);
    }
    const Surfels s = make_surfels(*device, cloud, surfels_for(point_spacing(cloud), 0.04), {}, {});
    const VirtualViews views = virtual_views(s, {}, pool);
    std::size_t sides = 0, turned = 0;
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec3 p{s.x[i], s.y[i], s.z[i]};
        if (p[2] < 0.1 || p[2] > 0.4) continue;
        for (std::size_t a = 0; a < 2; ++a) {
            for (const double side : {low[a], high[a]}) {
                if (std::abs(p[a] - side) > 0.005 || std::abs(p[1 - a]) > 0.1) continue;
                ++sides;
                const Vec3& eye = views.viewpoints[views.viewpoint_of_surfel[i]];
                const double front = s.nx[i] * (eye[0] - p[0]) + s.ny[i] * (eye[1] - p[1]) +
                                     s.nz[i] * (eye[2] - p[2]);
                turned += front * (a == 0 ? s.nx[i] : s.ny[i]) * side < 0;
            }
        }
    }
    EXPECT_GT(sides, 300u);
    EXPECT_LT(turned, sides / 50);
}

// A table top of 4 cm, whose faces are both seen, on a closed box whose back no eye gets in front
// of, and within which floor and top go on. Points are 1 cm apart, give or take.
TEST_F(Views, EveryFaceOfAThingFacesOutwards) {
    test::Random random(7);
    PointCloud cloud;
    const auto face = [&](std::size_t axis, double at, const Vec3& from, const Vec3& to) {
        const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
        for (double u = from[a]; u < to[a]; u += 0.01) {
            for (double v = from[b]; v < to[b]; v += 0.01) {
                Vec3 p{};
                p[a] = u + 0.003 * random.uniform();
                p[b] = v + 0.003 * random.uniform();
                p[axis] = at + 0.001 * random.normal();
                add(cloud, p);
            }
        }
    };
    const Vec3 low{0.15, 0.6, 0}, high{0.55, 1.1, 0.4};
    const Vec3 top_low{0.15, 0.2, 0.4}, top_high{0.55, 1.5, 0.44};
    face(2, 0, {0, 0, 0}, {2, 2, 0});
    face(0, 0, {0, 0, 0}, {0, 2, 1});
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const Vec3& at : {low, high})
            if (axis < 2) face(axis, at[axis], low, high);
        for (const Vec3& at : {top_low, top_high}) face(axis, at[axis], top_low, top_high);
    }
    const Surfels s = make_surfels(*device, cloud, 0.02, {}, {});
    const VirtualViews views = virtual_views(s, {}, pool);
    const auto turned = [&](std::size_t axis, double at, const Vec3& from, const Vec3& to) {
        int faces = 0, wrong = 0;
        for (std::size_t i = 0; i < s.size(); ++i) {
            const Vec3 p{s.x[i], s.y[i], s.z[i]}, n{s.nx[i], s.ny[i], s.nz[i]};
            bool inside = std::abs(p[axis] - at) < 0.005 && std::abs(n[axis]) > 0.9;
            for (std::size_t a = 0; a < 3; ++a)
                inside = inside && (a == axis || (p[a] > from[a] + 0.05 && p[a] < to[a] - 0.05));
            if (!inside) continue;
            const Vec3& eye = views.viewpoints[views.viewpoint_of_surfel[i]];
            const double outwards = at > (from[axis] + to[axis]) / 2 ? 1 : -1;
            double front = 0;
            for (std::size_t a = 0; a < 3; ++a) front += n[a] * (eye[a] - p[a]);
            ++faces;
            wrong += front * n[axis] * outwards < 0;
        }
        EXPECT_GT(faces, 100);
        return static_cast<double>(wrong) / faces;
    };
    EXPECT_LT(turned(0, low[0], low, high), 0.02);  // 15 cm before the wall
    EXPECT_LT(turned(0, high[0], low, high), 0.02);
    EXPECT_LT(turned(2, top_high[2], top_low, top_high), 0.02);
    EXPECT_LT(turned(2, top_low[2], top_low, {top_high[0], low[1], top_high[2]}), 0.05);
}

// Nothing leads from the one to the other.
TEST_F(Views, EachOfTwoClosedRoomsIsLookedInto) {
    PointCloud cloud;
    add_room(cloud, false);
    for (const std::size_t n = cloud.size(); cloud.size() < 2 * n;) {
        const std::size_t i = cloud.size() - n;
        add(cloud, {cloud.x[i], cloud.y[i], cloud.z[i] + 2.8});
    }
    const VirtualViews views = virtual_views(make_surfels(*device, cloud, 0.05, {}, {}), {}, pool);
    const auto above = std::ranges::count_if(views.eyes, [](const Vec3& e) { return e[2] > 2.8; });
    EXPECT_GE(above, 3);
    EXPECT_GE(static_cast<std::ptrdiff_t>(views.eyes.size()) - above, 3);
    for (const Vec3& eye : views.eyes) EXPECT_FALSE(eye[2] > 2.5 && eye[2] < 2.8);  // the slab
}

// A plane with normals, looked at from both sides: only what it faces is taken for free.
TEST_F(Views, WhatIsSeenFromBehindEndsNoRay) {
    PointCloud cloud;
    for (int i = 0; i < 100; ++i) {
        for (int j = 0; j < 100; ++j) {
            add(cloud, {i * 0.02, j * 0.02, 0});
            test::add_normal(cloud, Vec3{0, 0, 1});
        }
    }
    const Surfels s = make_surfels(*device, cloud, 0.05, {}, {});
    const VirtualViews above = virtual_views(
        s, {.known_eyes = {{1, 1, 1}}, .seen_from = {}, .eyes = 1, .sides_known = true}, pool);
    EXPECT_FALSE(above.frames.empty());
    const VirtualViews below = virtual_views(
        s, {.known_eyes = {{1, 1, -1}}, .seen_from = {}, .eyes = 1, .sides_known = true}, pool);
    EXPECT_TRUE(below.frames.empty());
}

using Eigen::Vector3d;
using scenes::Builder;

FreeSpace seen_from(std::span<const Vec3> eyes, const Builder& scene,
                    std::span<const std::uint32_t> eye_of_point = {}) {
    ThreadPool threads(2);
    return {scene.surfels(), test::cloud_of(scene.points), eyes, eye_of_point, threads};
}

TEST(FreeSpace, WithoutViewpointsNothingIsKnown) {
    Builder scene;
    scene.face({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    const FreeSpace free = seen_from({}, scene);
    EXPECT_FALSE(free.known());
    EXPECT_FALSE(free.at({0.5, 0.5, 0.5}));
    EXPECT_FALSE(FreeSpace().between({0, 0, 1}, {1, 1, 1}));
}

TEST(FreeSpace, ReachesFromTheSensorToTheSurfaceAndNoFurther) {
    Builder scene;
    scene.face({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0);
    scene.box({-0.2, -0.2, 0.0}, {0.4, 0.4, 0.6}, 1);
    scene.face({1, -1, 0}, {0, 0, 1.5}, {0, 2, 0}, 2);
    const Vec3 eye{0, 0, 2};
    const FreeSpace free = seen_from({&eye, 1}, scene);
    EXPECT_TRUE(free.known());
    EXPECT_TRUE(free.at({0, 0, 0.9}));
    EXPECT_TRUE(free.at({0.7, 0, 0.3}));
    EXPECT_FALSE(free.at({0, 0, 0.3})) << "in the box";
    EXPECT_FALSE(free.at({0.7, 0, 0.0})) << "at the floor";
    EXPECT_FALSE(free.at({9, 9, 9})) << "outside of the grid";
    EXPECT_TRUE(free.between({-0.9, 0, 0}, {-0.2, 0, 0.6}));
    EXPECT_FALSE(free.between({-0.2, 0, 0.1}, {0.2, 0, 0.5})) << "through the box";
}

// Viewpoints may be guesses: what no sensor can have seen from there is no evidence.
TEST(FreeSpace, LinesThroughASurfaceTellNothing) {
    Builder scene;
    scene.face({-0.5, -0.5, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    scene.face({-0.6, -0.6, 1}, {1.2, 0, 0}, {0, 1.2, 0}, 1);
    scene.face({0.7, -1, 0}, {0, 0, 1.8}, {0, 2, 0}, 2);
    const Vec3 eye{0, 0, 2};
    const FreeSpace free = seen_from({&eye, 1}, scene);
    EXPECT_TRUE(free.at({0, 0, 1.4}));
    EXPECT_FALSE(free.at({0, 0, 0.5}));
}

TEST(FreeSpace, AStrayFarAwayDoesNotCoarsenIt) {
    Builder scene;
    scene.face({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0);
    scene.face({1, -1, 0}, {0, 0, 1.5}, {0, 2, 0}, 1);
    const Vec3 eye{0, 0, 2};
    const FreeSpace before = seen_from({&eye, 1}, scene);
    for (const double side : {-1, 1}) scene.point({side * 6000, 7000, side * 5000}, {0, 0, 1}, 2);
    const FreeSpace free = seen_from({&eye, 1}, scene);
    EXPECT_EQ(free.cell_m(), before.cell_m());
    EXPECT_TRUE(free.at({0, 0, 0.9}));
    EXPECT_FALSE(free.at({0, 0, 0}));
}

TEST(FreeSpace, TheOrderOfPointsAndTheirViewpointsDoesNotMatter) {
    Builder scene;
    scene.face({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0);
    const std::vector<Vec3> eyes{{0, 0, 2}, {0.5, 0, 1}};
    std::vector<std::uint32_t> eye_of_point;
    for (std::size_t i = 0; i < scene.points.size(); ++i)
        eye_of_point.push_back(static_cast<std::uint32_t>(i % 2));
    const FreeSpace free = seen_from(eyes, scene, eye_of_point);
    std::reverse(scene.points.begin(), scene.points.end());
    std::reverse(eye_of_point.begin(), eye_of_point.end());
    const FreeSpace turned = seen_from(eyes, scene, eye_of_point);
    for (double x = -1; x < 1; x += 0.07)
        for (double z = 0; z < 2; z += 0.07)
            EXPECT_EQ(free.at({x, 0.01, z}), turned.at({x, 0.01, z})) << x << ' ' << z;
}

// A floor of 3 m and a wall at x = 3.
test::SampledFaces floor_and_wall(double spacing_m) {
    test::SampledFaces faces(spacing_m);
    faces.face(0, {0, 0, 0}, {3, 0, 0}, {0, 3, 0});
    faces.face(1, {3, 0, 0}, {0, 0, 2}, {0, 3, 0});
    return faces;
}

TEST(SightLines, MeetWhatIsInTheWayWithinACell) {
    const SightLines lines(floor_and_wall(0.02).samples);
    EXPECT_DOUBLE_EQ(lines.cell_m(), 0.08);
    const double start = 1.5 * lines.cell_m();
    EXPECT_NEAR(lines.met_m({1, 1.5, 1}, {1, 0, 0}, start, 4), 2, 0.1);
    EXPECT_NEAR(lines.met_m({1, 1.5, 1}, {0, 0, -1}, start, 4), 1, 0.1);
    const double slope = std::sqrt(0.5);
    EXPECT_NEAR(lines.met_m({1, 1.5, 1.5}, {slope, 0, -slope}, start, 4), 1.5 / slope, 0.15);
    EXPECT_TRUE(std::isinf(lines.met_m({1, 1.5, 1}, {0, 0, 1}, start, 4))) << "no ceiling";
    EXPECT_TRUE(std::isinf(lines.met_m({1, 1.5, 1}, {-1, 0, 0}, start, 4))) << "no wall there";
}

TEST(SightLines, BeginAndEndWhereTheyAreTold) {
    const SightLines lines(floor_and_wall(0.02).samples);
    EXPECT_TRUE(std::isinf(lines.met_m({1, 1.5, 1}, {1, 0, 0}, 0.12, 1.8))) << "too short";
    // From the floor upwards: itself is not met, nor, from the wall outwards, is that.
    EXPECT_TRUE(std::isinf(lines.met_m({1, 1.5, 0}, {0, 0, 1}, 0.12, 4)));
    EXPECT_TRUE(std::isinf(lines.met_m({3, 1.5, 1}, {1, 0, 0}, 0.12, 4)));
    EXPECT_EQ(lines.met_m({1, 1.5, 0.02}, {0, 0, 1}, 0, 4), 0) << "it is, without a start";
}

// Coarser cells where samples are sparse, so that a ray does not pass between them.
TEST(SightLines, DoNotPassBetweenSparseSamples) {
    const SightLines lines(floor_and_wall(0.2).samples);
    EXPECT_NEAR(lines.cell_m(), 0.3, 1e-9);
    for (double y = 0.3; y < 2.7; y += 0.05)
        EXPECT_NEAR(lines.met_m({1, y, 1}, {1, 0, 0}, 0.45, 4), 2, 0.4) << y;
}

TEST(SightLines, MeetNothingInAnEmptyScene) {
    const SightLines lines{SurfaceSamples()};
    EXPECT_TRUE(std::isinf(lines.met_m({0, 0, 0}, {1, 0, 0}, 0.1, 1)));
}

}  // namespace
}  // namespace topple::geometry

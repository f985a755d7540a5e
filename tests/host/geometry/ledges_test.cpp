// SPDX-License-Identifier: MIT
#include "geometry/ledges.h"

#include <Eigen/Geometry>

#include "geometry/upright_box.h"
#include "host/geometry/sampled_faces.h"
#include "host/geometry/split_scenes.h"
#include "testing.h"

namespace topple::geometry {
namespace {

using Eigen::Vector3d;
using scenes::Builder;
using scenes::majority;

std::optional<double> ledge_of(const Builder& solid) {
    const Surfels surfels = solid.surfels();
    std::vector<std::uint32_t> all(surfels.size());
    std::iota(all.begin(), all.end(), 0u);
    return find_ledge(surfels, all, Vector3d::UnitZ());
}

// The upright sides of a box, turned about its middle.
void sides(Builder& scene, const Vector3d& foot, const Vector3d& size, double turn, int of,
           double lean = 0) {
    const Vector3d x(std::cos(turn), std::sin(turn), 0), y(-x.y(), x.x(), 0);
    for (int k = 0; k < 4; ++k) {
        const Vector3d out = k == 0 ? x : k == 1 ? y : k == 2 ? Vector3d(-x) : Vector3d(-y);
        const Vector3d along = Vector3d::UnitZ().cross(out);
        const double deep = k % 2 ? size.y() : size.x(), wide = k % 2 ? size.x() : size.y();
        scene.face(foot + deep / 2 * out - wide / 2 * along, wide * along,
                   size.z() * (Vector3d::UnitZ() - lean * out), of);
    }
}

Builder stack(double step, double noise, double turn = 0.4) {
    Builder scene;
    scene.noise_m = noise;
    sides(scene, {0.01, 0.02, 0.7}, {0.26, 0.19, 0.08}, turn, 0);
    sides(scene, {0.01, 0.02, 0.78}, {0.26 - 2 * step, 0.19 - 2 * step, 0.08}, turn, 1);
    return scene;
}

TEST(Ledges, AStackOfBooksHasOne) {
    for (const double turn : {0.0, 0.4, 1.1}) {
        for (const double noise : {0.001, 0.005}) {
            const std::optional<double> ledge = ledge_of(stack(0.01, noise, turn));
            ASSERT_TRUE(ledge) << turn << " " << noise;
            EXPECT_NEAR(*ledge, 0.78, 0.01);
        }
    }
}

TEST(Ledges, BooksOfOneSizeThatAreTurnedHaveOne) {
    Builder scene;
    scene.noise_m = 0.003;
    sides(scene, {0, 0, 0}, {0.26, 0.19, 0.08}, 0.3, 0);
    sides(scene, {0, 0, 0.08}, {0.26, 0.19, 0.08}, 0.42, 1);
    const std::optional<double> ledge = ledge_of(scene);
    ASSERT_TRUE(ledge);
    EXPECT_NEAR(*ledge, 0.08, 0.01);
}

TEST(Ledges, OneBoxHasNone) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Builder scene;
        scene.state = seed;
        scene.noise_m = 0.002 * static_cast<double>(1 + seed % 4);
        sides(scene, {0.013, 0.007, 0.005}, {0.3, 0.2, 0.25}, 0.1 * static_cast<double>(seed), 0);
        EXPECT_FALSE(ledge_of(scene)) << "seed " << seed;
    }
}

TEST(Ledges, SidesThatLeanHaveNone) {
    Builder scene;
    scene.noise_m = 0.003;
    sides(scene, {0, 0, 0}, {0.4, 0.4, 0.3}, 0.2, 0, 0.12);
    EXPECT_FALSE(ledge_of(scene));
}

TEST(Ledges, AStepOfOneSideIsNone) {
    Builder scene;
    scene.noise_m = 0.002;
    scene.face({0, 0, 0}, {0.5, 0, 0}, {0, 0, 0.2}, 0);
    scene.face({0, 0.01, 0.2}, {0.5, 0, 0}, {0, 0, 0.2}, 0);
    scene.face({0.5, 0, 0}, {0, 0.3, 0}, {0, 0, 0.4}, 0);
    EXPECT_FALSE(ledge_of(scene));
}

TEST(Ledges, RoundThingsHaveNone) {
    Builder scene;
    scene.tube({0, 0, 0}, 0.1, 0.1, false, 0);
    scene.tube({0, 0, 0.1}, 0.09, 0.1, true, 0);
    EXPECT_FALSE(ledge_of(scene));
}

TEST(Ledges, LegsUnderATablesEdgeHaveNone) {
    Builder scene;
    scene.noise_m = 0.002;
    for (const double x : {-0.5, 0.43})
        for (const double y : {-0.3, 0.23})
            sides(scene, {x + 0.035, y + 0.035, 0}, {0.07, 0.07, 0.6}, 0, 0);
    sides(scene, {0, 0, 0.6}, {1.01, 0.61, 0.06}, 0, 0);
    EXPECT_FALSE(ledge_of(scene));
}

TEST(Ledges, MergingPartsAStack) {
    Builder scene;
    scene.noise_m = 0.002;
    scene.face({-0.6, -0.5, 0}, {1.2, 0, 0}, {0, 1, 0}, 0);
    sides(scene, {0, 0, 0}, {0.26, 0.19, 0.08}, 0.3, 1);
    sides(scene, {0, 0, 0.08}, {0.24, 0.17, 0.08}, 0.3, 2);
    sides(scene, {0, 0, 0.16}, {0.22, 0.15, 0.08}, 0.3, 3);
    const Vector3d x(std::cos(0.3), std::sin(0.3), 0), y(-x.y(), x.x(), 0);
    scene.face(0.24 * Vector3d::UnitZ() - 0.11 * x - 0.075 * y, 0.22 * x, 0.15 * y, 3);
    const Surfels surfels = scene.surfels();
    ThreadPool threads(2);
    const PrimitiveSet primitives =
        merge_convex(surfels, split(surfels, threads), {0, 0, 1}, {}, threads);
    std::array<std::int32_t, 4> label;
    for (int body = 0; body < 4; ++body) {
        const auto most = majority(scene, surfels, primitives.label, body);
        label[body] = most.label;
        EXPECT_GT(most.share, 0.7) << "body " << body;
    }
    EXPECT_EQ(std::set(label.begin(), label.end()).size(), 4u);
    const std::vector<Ledge> ledges = ledges_between(surfels, primitives, {0, 0, 1});
    ASSERT_EQ(ledges.size(), 2u);
    for (const Ledge& l : ledges) {
        const bool upper = l.above == label[3];
        EXPECT_EQ(l.above, label[upper ? 3 : 2]);
        EXPECT_EQ(l.below, label[upper ? 2 : 1]);
        EXPECT_NEAR(l.height_m, upper ? 0.16 : 0.08, 0.005);
    }
}

// A box on a floor at 0, turned by 20 degrees, of which some sides were seen, and perhaps its top.
struct Seen {
    const char* what;
    Vector3d size;
    std::size_t sides;
    bool top;
    double from_m;  // how high it begins
    bool box;       // whether it is an upright box that stands by itself
};

bool is_box(const Seen& s) {
    test::SampledFaces faces(0.03);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.35, Vector3d::UnitZ()).toRotationMatrix();
    const Vector3d x = turn * Vector3d(s.size[0], 0, 0), y = turn * Vector3d(0, s.size[1], 0),
                   z(0, 0, s.size[2]), low(1, 1, s.from_m);
    if (s.top) faces.face(0, low + z, x, y);
    const std::vector<std::array<Vector3d, 2>> sides{
        {low, x}, {low + x, y}, {low + x + y, -x}, {low + y, -y}};
    for (std::size_t n = 0; n < s.sides; ++n) faces.face(0, sides[n][0], sides[n][1], z);
    const PrimitiveShapes shapes = primitive_shapes(faces.samples, 1);
    return is_upright_box(faces.samples, shapes.of[0], 0);
}

TEST(UprightBox, StandsByItself) {
    for (const Seen& s : {
             Seen{"a cupboard in a room", {0.8, 0.35, 1.8}, 4, true, 0, true},
             Seen{"a cupboard at a wall", {0.5, 0.4, 0.8}, 3, true, 0, true},
             Seen{"a cabinet on feet", {0.4, 0.3, 1.9}, 4, true, 0.1, true},
             Seen{"a corner of a room from outside", {0.8, 0.4, 1.8}, 2, true, 0, false},
             Seen{"a pillar up to the ceiling", {0.5, 0.5, 2.5}, 4, false, 0, false},
             Seen{"a step", {0.8, 0.8, 0.18}, 4, true, 0, false},
             Seen{"a partition", {1.2, 0.08, 1.2}, 4, true, 0, false},
             Seen{"a counter", {2.6, 0.6, 0.9}, 4, true, 0, false},
             Seen{"a cabinet on a wall", {0.8, 0.35, 0.6}, 4, true, 1.4, false},
         })
        EXPECT_EQ(is_box(s), s.box) << s.what;
}

// A sofa's seat lies within its box.
TEST(UprightBox, IsNoOtherShape) {
    test::SampledFaces faces(0.03);
    faces.box(0, {0, 0, 0}, {1.2, 0.8, 0.4});
    faces.box(0, {0, 0.6, 0.4}, {1.2, 0.8, 0.8});
    EXPECT_FALSE(is_upright_box(faces.samples, primitive_shapes(faces.samples, 1).of[0], 0));
}

}  // namespace
}  // namespace topple::geometry

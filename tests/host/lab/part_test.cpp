// SPDX-License-Identifier: MIT
#include "core/vectors.h"
#include "lab/random.h"
#include "lab/solids/part_surface.h"
#include "lab/solids/scene.h"
#include "testing.h"

namespace topple::scenes {
namespace {

// A bowl: its wall is 2 cm thick on a floor of 3 cm.
const solids::Profile bowl{{0, -0.1},   {0.1, -0.1},   {0.2, 0.1},
                           {0.18, 0.1}, {0.08, -0.07}, {0, -0.07}};
// A bottle.
const solids::Profile bottle{{0, -0.2},    {0.1, -0.2}, {0.1, 0.05},
                             {0.03, 0.12}, {0.03, 0.2}, {0, 0.2}};

std::vector<Part> all_shapes() {
    return {
        {Shape::box, {0.3, -0.2, 1.1}, {0.4, 0.25, 0.6}, 0.7, 0, 0, "box"},
        {Shape::cylinder, {-0.1, 0.2, 0.4}, {0.3, 0.3, 0.5}, 0.2, 0, 0, "cylinder"},
        {Shape::lying_cylinder, {0.1, 0.1, 0.2}, {0.7, 0.24, 0.24}, -1.2, 0, 0, "lying"},
        {Shape::sphere, {0, 0.5, 0.3}, {0.4, 0.4, 0.4}, 0, 0, 0, "sphere"},
        {Shape::cone, {0.2, 0.2, 0.3}, {0.3, 0.3, 0.4}, 0, 0, 0, "pointed"},
        {Shape::cone, {0.2, 0.2, 0.3}, {0.3, 0.3, 0.4}, 0, 0.5, 0, "frustum"},
        {Shape::cone, {0.2, 0.2, 0.3}, {0.2, 0.2, 0.4}, 0, 1.6, 0, "pot"},
        {Shape::box, {0.3, -0.2, 1.1}, {0.4, 0.15, 0.6}, 0.7, 0, 0, "leaning", 0.5},
        {Shape::cylinder, {0, 0.2, 0.4}, {0.2, 0.2, 0.6}, 2.5, 0, 0, "splayed", -0.4},
        {Shape::cone, {0.2, 0.2, 0.3}, {0.3, 0.3, 0.4}, -1.1, 0.4, 0, "shade", 2.2},
        {Shape::rounded_box, {0.1, 0, 0.3}, {0.5, 0.3, 0.2}, 0.4, 0, 0, "cushion", 0.3, 0.07},
        {Shape::rounded_box, {0.1, 0, 0.3}, {0.5, 0.2, 0.2}, 0, 0, 0, "capsule", 0, 0.1},
        {Shape::revolved, {0.1, 0.3, 0.2}, {0.4, 0.4, 0.2}, 0, 0, 0, "bowl", 0, 0, bowl},
        {Shape::revolved, {0.1, 0.3, 0.2}, {0.2, 0.2, 0.4}, 0.8, 0, 0, "bottle", 1.2, 0, bottle},
    };
}

Vec3 in_box(Random& random, const std::array<Vec3, 2>& box, double grow) {
    Vec3 p{};
    for (std::size_t k = 0; k < 3; ++k) p[k] = random(box[0][k] - grow, box[1][k] + grow);
    return p;
}

// Volume and centre of mass of {distance <= 0} from 400,000 samples in the bounds. With share q of
// them inside, the volume's standard deviation is sqrt((1 - q) / (q n)) of itself; five of them
// mean one false alarm in 10^6 runs, and the seed is fixed.
TEST(Part, VolumeAndCentreAgreeWithTheDistance) {
    for (const Part& part : all_shapes()) {
        Random random(11);
        const auto box = part.bounds();
        const double all =
            (box[1][0] - box[0][0]) * (box[1][1] - box[0][1]) * (box[1][2] - box[0][2]);
        constexpr int samples = 400000;
        int hits = 0;
        Vec3 sum{};
        for (int n = 0; n < samples; ++n) {
            const Vec3 p = in_box(random, box, 0);
            if (!part.inside(p)) continue;
            ++hits;
            for (std::size_t k = 0; k < 3; ++k) sum[k] += p[k];
        }
        const double share = part.volume() / all;
        EXPECT_NEAR(all * hits / samples, part.volume(),
                    5 * std::sqrt((1 - share) / (share * samples)) * part.volume())
            << part.name;
        const Vec3 com = part.center_of_mass();
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(sum[k] / hits, com[k], 0.003) << part.name;
    }
}

TEST(Part, NothingIsInsideBeyondTheBounds) {
    for (const Part& part : all_shapes()) {
        Random random(12);
        const auto box = part.bounds();
        for (int n = 0; n < 20000; ++n) {
            const Vec3 p = in_box(random, box, 0.3);
            EXPECT_TRUE(overlap(box, Bounds{p, p}) || part.distance(p) > 0) << part.name;
        }
    }
}

// The bounds touch the part on all six sides.
TEST(Part, BoundsAreTight) {
    for (const Part& part : all_shapes()) {
        const auto box = part.bounds();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const std::size_t side : {0u, 1u}) {
                Part slab{Shape::box, part.center, {3, 3, 3}, 0, 0, 0, "slab"};
                slab.size[axis] = 0.1;
                slab.center[axis] = box[side][axis] + (side == 0 ? -0.05 : 0.05);
                EXPECT_NEAR(gap(part, slab), 0, 1e-3) << part.name << " axis " << axis;
            }
        }
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_LE(box[1][k] - part.center[k], part.bounding_radius() + 1e-12);
            EXPECT_LE(part.center[k] - box[0][k], part.bounding_radius() + 1e-12);
        }
    }
}

// A bowl is empty inside; its hull is not, and is what keeps its distance from others.
TEST(Part, ABowlIsHollowAndItsHullIsNot) {
    const Part part{Shape::revolved, {0, 0, 0.1}, {0.4, 0.4, 0.2}, 0, 0, 0, "bowl", 0, 0, bowl};
    const Part hull = part.hull();
    EXPECT_NEAR(part.distance({0, 0, 0.15}), std::min(0.12, part.distance({0, 0, 0.15})), 1e-12);
    EXPECT_GT(part.distance({0, 0, 0.15}), 0.1);
    EXPECT_LT(hull.distance({0, 0, 0.15}), -0.04);
    EXPECT_LT(part.distance({0, 0, 0.015}), 0);
    EXPECT_GT(hull.volume(), 2 * part.volume());
    // pi h / 3 (r^2 + r R + R^2)
    EXPECT_NEAR(hull.volume(), std::numbers::pi * 0.2 / 3 * (0.01 + 0.02 + 0.04), 1e-12);
    Random random(3);
    for (int n = 0; n < 20000; ++n) {
        const Vec3 p = in_box(random, part.bounds(), 0.1);
        EXPECT_LE(hull.distance(p), part.distance(p) + 1e-12);
    }
    const Part ball{Shape::sphere, {0, 0, 0.35}, {0.2, 0.2, 0.2}, 0, 0, 0, "ball"};
    EXPECT_NEAR(gap(part, ball), 0.05, 1e-3);  // to the plane of the rim
}

// A true distance: never more than the way to any surface point, and attained by walking along its
// gradient.
TEST(Part, DistanceIsTheDistance) {
    for (const Part& part : all_shapes()) {
        Random random(13);
        for (int n = 0; n < 5000; ++n) {
            const Vec3 p = in_box(random, part.bounds(), 0.4);
            const double d = part.distance(p);
            if (d < 0.01) continue;
            EXPECT_NEAR(part.distance(along(p, -d, part.normal(p))), 0, 1e-4) << part.name;
            const Vec3 q = in_box(random, part.bounds(), 0.4);
            EXPECT_LE(std::abs(d - part.distance(q)), length(minus(p, q)) + 1e-12) << part.name;
        }
    }
}

// Rays end on the surface, and pass through nothing before that.
TEST(Part, RaysEndOnTheSurface) {
    for (const Part& part : all_shapes()) {
        Random random(14);
        int hits = 0;
        for (int n = 0; n < 20000; ++n) {
            const Vec3 o = in_box(random, part.bounds(), 0.5),
                       to = in_box(random, part.bounds(), 0.1);
            const Vec3 d = unit(minus(to, o));
            const double t = part.hit(o, d);
            const double end = std::min(t, 3.0);
            const bool started_inside = part.distance(o) < 0;
            for (int k = 1; k < 20; ++k) {
                const double at = part.distance(along(o, end * k / 20, d));
                EXPECT_GT(started_inside ? -at : at, -1e-9) << part.name;
            }
            if (t == std::numeric_limits<double>::infinity()) continue;
            ++hits;
            EXPECT_NEAR(part.distance(along(o, t, d)), 0, 1e-9) << part.name;
        }
        EXPECT_GT(hits, 5000) << part.name;
    }
}

TEST(Gap, OfKnownPairs) {
    const auto box = [](double x, double y, double z, double yaw) {
        return Part{Shape::box, {x, y, z}, {0.4, 0.4, 0.4}, yaw, 0, 0, "box"};
    };
    const Part ball{Shape::sphere, {0.5, 0, 0}, {0.4, 0.4, 0.4}, 0, 0, 0, "ball"};
    EXPECT_NEAR(gap(box(0, 0, 0, 0), box(0.5, 0, 0, 0)), 0.1, 1e-3);
    EXPECT_NEAR(gap(box(0, 0, 0, 0), box(0.4, 0, 0, 0)), 0, 1e-3);
    EXPECT_NEAR(gap(box(0, 0, 0, 0), box(0.38, 0.1, 0, 0)), -0.02, 1e-3);
    EXPECT_NEAR(gap(box(0, 0, 0, 0), ball), 0.1, 1e-3);
    // Edge against face: half a diagonal from the turned box's middle.
    EXPECT_NEAR(gap(box(0, 0, 0, 0), box(0.5, 0, 0, std::numbers::pi / 4)),
                0.3 - 0.2 * std::sqrt(2.0), 1e-3);
    // Corner against corner, along the diagonal.
    EXPECT_NEAR(gap(box(0, 0, 0, 0), box(0.5, 0.5, 0.5, 0)), 0.1 * std::sqrt(3.0), 1e-3);
    // A long thin leg under a wide thin top, touching.
    const Part top{Shape::box, {0, 0, 0.74}, {1.6, 0.8, 0.04}, 0.3, 0, 0, "top"};
    const Part leg{Shape::cylinder, {0.5, 0.2, 0.36}, {0.04, 0.04, 0.72}, 0, 0, 0, "leg"};
    EXPECT_NEAR(gap(top, leg), 0, 1e-3);
}

// Mean 0, variance 1, and the share beyond two standard deviations of the normal law, each within
// five standard errors of 10^6 samples (and 0.1 % for the sum of twelve not being quite normal).
TEST(Random, IsNormal) {
    Random random(5);
    double sum = 0, squares = 0;
    int beyond = 0;
    constexpr int n = 1000000;
    for (int k = 0; k < n; ++k) {
        const double v = random.normal();
        sum += v;
        squares += v * v;
        beyond += std::abs(v) > 2;
    }
    EXPECT_NEAR(sum / n, 0, 0.005);
    EXPECT_NEAR(squares / n, 1, 0.007);
    EXPECT_NEAR(static_cast<double>(beyond) / n, 0.0455, 0.002);
}

TEST(Random, IsTheSameEverywhere) {
    Random random(1);
    EXPECT_EQ(random.bits(), Random(1).bits());
    EXPECT_NE(Random(1).bits(), Random(2).bits());
    EXPECT_NE(Random(1, 0).bits(), Random(1, 1).bits());
    std::array<int, 6> seen{};
    for (int k = 0; k < 6000; ++k) seen[random.integer(2, 7) - 2]++;
    for (const int count : seen) EXPECT_NEAR(count, 1000, 150);  // five standard deviations
}

using std::numbers::pi;

struct Solid {
    const char* name;
    Part part;
    double area;  // closed form
};

Part turned(Part part) {
    part.yaw = 0.7;
    if (part.shape != Shape::lying_cylinder) part.lean = 0.4;
    return part;
}

// One solid of each shape, turned and away from the origin.
std::vector<Solid> solids_of_all_shapes() {
    const Vec3 at{1, -2, 0.5};
    Part rounded{Shape::rounded_box, at, {0.5, 0.3, 0.2}, 0, 0, 0, ""};
    rounded.rounding = 0.05;
    const double core = 0.4 * 0.2 + 0.2 * 0.1 + 0.1 * 0.4;
    Part bowl{Shape::revolved, at, {0.4, 0.4, 0.2}, 0, 0, 0, ""};
    bowl.profile = {{0, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {0.15, 0.1}, {0.15, 0}, {0, 0}};
    const double slant = std::hypot(0.1, 0.4);
    return {
        {"box", turned({Shape::box, at, {0.5, 0.3, 0.2}, 0, 0, 0, ""}),
         2 * (0.5 * 0.3 + 0.3 * 0.2 + 0.2 * 0.5)},
        {"rounded", turned(rounded),
         2 * core + 2 * pi * 0.05 * (0.4 + 0.2 + 0.1) + 4 * pi * 0.05 * 0.05},
        {"cylinder", turned({Shape::cylinder, at, {0.2, 0.2, 0.6}, 0, 0, 0, ""}),
         pi * 0.2 * 0.6 + 2 * pi * 0.01},
        {"lying", turned({Shape::lying_cylinder, at, {0.6, 0.2, 0.2}, 0, 0, 0, ""}),
         pi * 0.2 * 0.6 + 2 * pi * 0.01},
        {"sphere", turned({Shape::sphere, at, {0.3, 0.3, 0.3}, 0, 0, 0, ""}), pi * 0.09},
        {"cone", turned({Shape::cone, at, {0.4, 0.4, 0.4}, 0, 0.5, 0, ""}),
         pi * (0.04 + 0.01 + 0.3 * slant)},
        {"revolved", turned(bowl), 2 * pi * (0.2 * 0.2 + 0.15 * 0.1) + pi * (2 * 0.04)},
    };
}

struct Surface {
    std::vector<Sheet> sheets;
    std::vector<Patch> patches;
};
Surface surface_of(const Solid& solid) {
    Surface out;
    add_sheets(solid.part, 0, out.sheets);
    for (std::size_t k = 0; k < out.sheets.size(); ++k)
        add_patches(out.sheets[k], static_cast<std::uint32_t>(k), 0.025, out.patches);
    return out;
}

TEST(PartSurface, PatchesMakeUpTheSurface) {
    for (const Solid& solid : solids_of_all_shapes()) {
        const auto [sheets, patches] = surface_of(solid);
        double sum = 0, quarters = 0;
        for (const Patch& patch : patches) {
            sum += patch.area(sheets[patch.sheet]);
            for (const Patch& quarter : patch.quarters())
                quarters += quarter.area(sheets[patch.sheet]);
        }
        EXPECT_NEAR(sum, solid.area, 1e-9) << solid.name;
        EXPECT_NEAR(quarters, solid.area, 1e-9) << solid.name;
    }
}

TEST(PartSurface, PointsLieOnTheSolidWithItsNormal) {
    Random random(1);
    for (const Solid& solid : solids_of_all_shapes()) {
        const auto [sheets, patches] = surface_of(solid);
        for (const Patch& patch : patches) {
            const Sheet& sheet = sheets[patch.sheet];
            const auto [p, n] = patch.spread(sheet, random(0.01, 0.99), random(0.01, 0.99));
            ASSERT_NEAR(solid.part.distance(p), 0, 1e-9) << solid.name;
            ASSERT_NEAR(solid.part.distance(along(p, 1e-4, n)), 1e-4, 1e-7) << solid.name;
            ASSERT_LT(length(minus(p, sheet.at(patch.u[0], patch.v[0]).point)), 0.036)
                << solid.name;
        }
    }
}

// Half of the points of a disc's patches are beyond the radius that halves their area.
TEST(PartSurface, PointsAreSpreadEvenlyOverADisc) {
    std::vector<Sheet> sheets;
    add_sheets({Shape::cone, {}, {2, 2, 0.5}, 0, 0, 0, ""}, 0, sheets);
    const Patch whole{0, sheets[0].u, sheets[0].v};
    Random random(2);
    int beyond = 0;
    constexpr int count = 40000;
    for (int k = 0; k < count; ++k) {
        const Vec3 p = whole.spread(sheets[0], random.uniform(), random.uniform()).point;
        if (std::hypot(p[0], p[1]) > std::sqrt(0.5)) ++beyond;
    }
    EXPECT_NEAR(beyond, count / 2, 500);  // five standard deviations
}

}  // namespace
}  // namespace topple::scenes

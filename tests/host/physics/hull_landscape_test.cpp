// SPDX-License-Identifier: MIT
#include "physics/hull_landscape.h"

#include "errors.h"
#include "host/physics/hulls.h"
#include "topple/error.h"

namespace topple::physics {
namespace {

using std::numbers::pi;
using test::Hull;

constexpr double exact = 1e-9;  // relative; the arithmetic is good for 1e-13

void expect_close(double value, double truth, double relative = exact) {
    EXPECT_NEAR(value, truth, relative * truth);
}
// The value printed to so many decimals.
void expect_prints(double value, double printed, double last_digit) {
    EXPECT_NEAR(value, printed, 0.501 * last_digit);
}

// The pose that rests with the given direction up.
const HullPose& pose_with(const HullLandscape& landscape, const Vec3& up) {
    return *std::max_element(
        landscape.poses.begin(), landscape.poses.end(),
        [&](const HullPose& a, const HullPose& b) { return dot(a.up, up) < dot(b.up, up); });
}

double climb(double height, double margin) {
    return std::hypot(height, margin) - height;
}

// What holds of every landscape.
void expect_sound(const HullLandscape& landscape) {
    double chance = 0;
    for (std::size_t n = 0; n < landscape.poses.size(); ++n) {
        const HullPose& pose = landscape.poses[n];
        chance += pose.probability;
        EXPECT_GE(pose.probability, 0);
        EXPECT_GT(pose.margin_m, 0);
        EXPECT_GE(pose.contacts.size(), 3U);
        EXPECT_GT(pose.barrier_m, 0);
        EXPECT_NEAR(dot(pose.up, pose.up), 1, 1e-12);
        if (n > 0) {
            EXPECT_GE(pose.height_m, landscape.poses[n - 1].height_m);
            EXPECT_GE(pose.joins, 0);
            EXPECT_LT(pose.joins, static_cast<std::int32_t>(n));
        }
        // The lowest way out by the merge tree is the lowest of the passes at its border.
        double lowest = std::numeric_limits<double>::infinity();
        for (const HullPass& pass : landscape.passes) {
            const auto here = static_cast<std::int32_t>(n);
            if (pass.poses[0] == pass.poses[1]) continue;
            if (pass.poses[0] != here && pass.poses[1] != here) continue;
            lowest = std::min(lowest, pass.height_m - pose.height_m);
        }
        if (std::isfinite(pose.barrier_m)) {
            EXPECT_NEAR(pose.barrier_m, lowest, 1e-12 * landscape.highest_m) << "pose " << n;
        } else {
            EXPECT_EQ(lowest, pose.barrier_m);
        }
    }
    EXPECT_NEAR(chance, 1, 1e-9);
    EXPECT_EQ(landscape.poses.at(0).joins, -1);
    EXPECT_EQ(landscape.poses[0].joins_at_m, std::numeric_limits<double>::infinity());
}

TEST(HullLandscape, Box) {
    const HullLandscape box = hull_landscape(test::box_hull(0.3, 0.2, 0.5).points, {0, 0, 0});
    const double weight = 21 * gravity;
    ASSERT_EQ(box.poses.size(), 6U);
    ASSERT_EQ(box.passes.size(), 12U);
    EXPECT_EQ(box.maxima, 8U);
    expect_sound(box);
    const HullPose& upright = pose_with(box, {0, 0, 1});
    expect_close(upright.height_m, 0.25);
    expect_close(upright.margin_m, 0.1);
    expect_close(upright.barrier_m, climb(0.25, 0.1));
    expect_prints(weight * upright.barrier_m, 3.96604, 1e-5);
    expect_prints(weight * (box.highest_m - 0.25), 11.98995, 1e-5);
    EXPECT_EQ(upright.contacts.size(), 4U);
    int over_the_long_side = 0;
    for (const HullPass& pass : box.passes) {
        if (std::abs(weight * (pass.height_m - 0.25) - 8.55630) < 0.501e-5) ++over_the_long_side;
    }
    EXPECT_EQ(over_the_long_side, 4);  // two to either side, and the same two upside down
    // Lying on the 0.5 x 0.2 face, it goes on over the 0.5 edge; on the largest, over that too.
    expect_close(pose_with(box, {1, 0, 0}).barrier_m, climb(0.15, 0.1));
    expect_close(pose_with(box, {0, 1, 0}).barrier_m, climb(0.1, 0.15));
    // Solid angles of the faces.
    const auto chance = [](double a, double b, double distance) {
        return std::atan(a * b / (distance * std::sqrt(a * a + b * b + distance * distance))) / pi;
    };
    expect_close(pose_with(box, {0, 1, 0}).probability, chance(0.15, 0.25, 0.1));
    expect_close(pose_with(box, {1, 0, 0}).probability, chance(0.1, 0.25, 0.15));
    expect_close(upright.probability, chance(0.15, 0.1, 0.25));
    const HullLandscape brick = hull_landscape(test::box_hull(1, 2, 3).points, {0, 0, 0});
    expect_prints(pose_with(brick, {1, 0, 0}).probability, 0.322511, 1e-6);
    expect_prints(pose_with(brick, {0, 1, 0}).probability, 0.121364, 1e-6);
    expect_prints(pose_with(brick, {0, 0, 1}).probability, 0.056126, 1e-6);
    // The deepest two join over their 0.5 edges by way of the middle ones.
    EXPECT_EQ(box.poses[1].joins, 0);
    expect_close(box.poses[1].joins_at_m, std::hypot(0.1, 0.15));
    expect_close(box.poses[5].joins_at_m, std::hypot(0.25, 0.1));
}

// On its side: the pose that it is in, and borders that lead over each edge from corner to corner.
TEST(HullLandscape, BordersOfABox) {
    const Hull hull = test::box_hull(0.3, 0.2, 0.5);
    const HullLandscape box =
        hull_landscape(hull.points, {0, 0, 0}, {.up = {1, 0, 0}, .borders = true});
    EXPECT_GT(box.poses[box.now].up[0], 0.999);
    expect_close(box.now_m, 0.15);
    EXPECT_EQ(box.corners.size(), 8U);
    const auto height = [&](const Vec3& up) {
        double lowest = 0;
        for (const Vec3& v : hull.points) lowest = std::min(lowest, dot(v, up));
        return -lowest;
    };
    for (const HullPass& pass : box.passes) {
        ASSERT_EQ(pass.border.size(), 3U);
        expect_close(height(pass.border[0]), box.highest_m);
        expect_close(height(pass.border[1]), pass.height_m);
        expect_close(height(pass.border[2]), box.highest_m);
    }
    for (const HullPass& pass : hull_landscape(hull.points, {0, 0, 0}).passes)
        EXPECT_TRUE(pass.border.empty());
}

TEST(HullLandscape, CylinderStandingAndLying) {
    for (const unsigned n : {8U, 64U, 512U}) {
        SCOPED_TRACE(n);
        // Sides that touch the round cylinder: the base's edges are as far away as the rim is.
        const auto points = test::prism_points(0.04 / std::cos(pi / n), 0.12, n);
        const HullLandscape raw = hull_landscape(points, {0, 0, 0.06});
        ASSERT_EQ(raw.poses.size(), n + 2U);
        EXPECT_EQ(raw.maxima, 2U * n);
        EXPECT_EQ(raw.passes.size(), 3U * n);
        expect_sound(raw);
        const HullPose& upright = pose_with(raw, {0, 0, 1});
        expect_close(upright.barrier_m, climb(0.06, 0.04));
        expect_prints(700 * pi * 0.0016 * 0.12 * gravity * upright.barrier_m, 0.050148, 1e-6);
        // Lying, it rolls from side to side.
        const double to_the_next = 0.04 / std::cos(pi / n) - 0.04;
        expect_close(raw.poses[0].barrier_m, to_the_next, 1e-6);
        const HullLandscape rolling =
            hull_landscape(points, {0, 0, 0.06}, {.resolution_m = 1.01 * to_the_next});
        ASSERT_EQ(rolling.poses.size(), 3U);
        expect_sound(rolling);
        expect_close(rolling.poses[0].height_m, 0.04);
        expect_close(rolling.poses[0].barrier_m, climb(0.04, 0.06));
        expect_close(rolling.poses[2].barrier_m, climb(0.06, 0.04));
    }
}

TEST(HullLandscape, ConeOnItsBaseAndLying) {
    const unsigned n = 256;
    std::vector<Vec3> points{{0, 0, 0.3}};
    for (const auto& p : test::ring(0.1 / std::cos(pi / n), n)) points.push_back({p[0], p[1], 0});
    const HullLandscape raw = hull_landscape(points, {0, 0, 0.075});
    ASSERT_EQ(raw.poses.size(), n + 1U);
    expect_sound(raw);
    expect_close(pose_with(raw, {0, 0, 1}).barrier_m, climb(0.075, 0.1));
    expect_prints(700 * pi * 0.001 * gravity * pose_with(raw, {0, 0, 1}).barrier_m, 1.078297, 1e-6);
    expect_close(raw.poses[0].height_m, 0.225 * 0.1 / std::hypot(0.1, 0.3));
    expect_prints(raw.poses[0].height_m, 0.071151, 1e-6);
    const HullLandscape rolling = hull_landscape(points, {0, 0, 0.075}, {.resolution_m = 1e-5});
    ASSERT_EQ(rolling.poses.size(), 2U);
    expect_sound(rolling);
    expect_close(rolling.poses[0].barrier_m, std::hypot(0.075, 0.1) - rolling.poses[0].height_m);
}

TEST(HullLandscape, HemisphereOnItsFlatAndOnItsDome) {
    const double r = 0.1, weight = 700 * 2.0 / 3 * pi * r * r * r * gravity;
    const auto points = test::dome_points(r, 32, 96);
    // Facets of the dome are minima of their own, shallower than r (pi / 2 / 32)^2 / 80.
    const HullLandscape dome =
        hull_landscape(points, {0, 0, 3 * r / 8}, {.resolution_m = 4e-5 * r});
    ASSERT_EQ(dome.poses.size(), 2U);
    expect_sound(dome);
    const HullPose &flat = pose_with(dome, {0, 0, 1}), &round = pose_with(dome, {0, 0, -1});
    expect_close(flat.barrier_m, climb(3 * r / 8, r));
    expect_prints(weight * flat.barrier_m, 0.996348, 1e-6);
    expect_close(round.height_m, 5 * r / 8);
    expect_close(round.barrier_m, std::hypot(3 * r / 8, r) - 5 * r / 8);
    expect_prints(weight * round.barrier_m, 0.636915, 1e-6);
}

TEST(HullLandscape, BallsAreOneBasin) {
    // An icosahedron rolls from face to face, over edges: inradius and midradius are known.
    const HullLandscape faces = hull_landscape(test::ball_points(1, 1), {0, 0, 0});
    ASSERT_EQ(faces.poses.size(), 20U);
    EXPECT_EQ(faces.passes.size(), 30U);
    EXPECT_EQ(faces.maxima, 12U);
    expect_sound(faces);
    const double edge = 1 / std::sin(2 * pi / 5);
    const double middle = edge * std::cos(pi / 5),
                 inner = edge * (3 + std::sqrt(5.0)) / 4 / std::sqrt(3.0);
    for (const HullPose& pose : faces.poses) {
        // The mesh's directions are floats.
        EXPECT_NEAR(pose.height_m, inner, 1e-6);
        EXPECT_NEAR(pose.barrier_m, middle - inner, 1e-6);
        EXPECT_NEAR(pose.probability, 0.05, 1e-6);
    }
    const HullLandscape one =
        hull_landscape(test::ball_points(0.1, 24), {0, 0, 0}, {.resolution_m = 1e-3 * 0.1});
    ASSERT_EQ(one.poses.size(), 1U);
    EXPECT_EQ(one.poses[0].barrier_m, std::numeric_limits<double>::infinity());
    EXPECT_NEAR(one.poses[0].probability, 1, 1e-9);
}

TEST(HullLandscape, CoplanarCollinearAndInnerPointsChangeNothing) {
    const Hull box = test::box_hull(0.3, 0.2, 0.5);
    const HullLandscape plain = hull_landscape(box.points, {0, 0, 0});
    std::vector<Vec3> more = box.points;
    scenes::Random random(4);
    for (int n = 0; n < 400; ++n) {
        Vec3 p{random(-0.15, 0.15), random(-0.1, 0.1), random(-0.25, 0.25)};
        if (n % 4 > 0) p[0] = p[0] < 0 ? -0.15 : 0.15;
        if (n % 4 > 1) p[1] = p[1] < 0 ? -0.1 : 0.1;
        if (n % 4 > 2) p[2] = p[2] < 0 ? -0.25 : 0.25;
        more.push_back(p);
    }
    const HullLandscape full = hull_landscape(more, {0, 0, 0});
    ASSERT_EQ(full.poses.size(), 6U);
    expect_sound(full);
    for (std::size_t n = 0; n < 6; ++n) {
        expect_close(full.poses[n].height_m, plain.poses[n].height_m);
        expect_close(full.poses[n].barrier_m, plain.poses[n].barrier_m);
        expect_close(pose_with(full, plain.poses[n].up).probability, plain.poses[n].probability);
    }
    // Faces flat to a micrometre, as models with six decimals have them, are one face.
    for (Vec3& p : more) {
        for (double& x : p) x += random(-5e-7, 5e-7);
    }
    const HullLandscape rough = hull_landscape(more, {0, 0, 0}, {.resolution_m = 2e-6});
    ASSERT_EQ(rough.poses.size(), 6U);
    for (const HullPose& pose : plain.poses) {
        const HullPose& same = pose_with(rough, pose.up);
        expect_close(same.height_m, pose.height_m, 1e-5);
        expect_close(same.barrier_m, pose.barrier_m, 1e-4);
        EXPECT_NEAR(same.probability, pose.probability, 1e-4);
        EXPECT_GT(same.contacts.size(), 20U);
        EXPECT_NEAR(same.margin_m, pose.margin_m, 1e-5);
    }
}

// Turned boxes: Qhull finds some faces flat and splits others into triangles, one plane to within
// rounding.
TEST(HullLandscape, FacesSplitByRoundingAreOne) {
    const Hull box = test::box_hull(0.3, 0.2, 0.5);
    const HullLandscape plain = hull_landscape(box.points, {0, 0, 0});
    std::size_t split = 0;
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        SCOPED_TRACE(seed);
        scenes::Random random(seed);
        std::vector<Vec3> points = test::turned(box.points, random);
        if (seed % 2) {
            for (Vec3& p : points) {
                for (double& x : p) x = static_cast<float>(x);
            }
        }
        split += convex_hull(points).value().faces.size() > 6;
        const HullLandscape turned =
            hull_landscape(points, {0, 0, 0}, {.resolution_m = seed % 2 ? 1e-7 : 0});
        ASSERT_EQ(turned.poses.size(), 6U);
        expect_sound(turned);
        for (std::size_t n = 0; n < 6; ++n) {
            expect_close(turned.poses[n].height_m, plain.poses[n].height_m, 1e-6);
            expect_close(turned.poses[n].barrier_m, plain.poses[n].barrier_m, 1e-5);
            EXPECT_NEAR(turned.poses[n].probability, plain.poses[n].probability, 1e-6);
            EXPECT_EQ(turned.poses[n].contacts.size(), 4U);
        }
    }
    EXPECT_GT(split, 100U);
}

// Every minimum and pass of a few points in general position, by trying all triples and pairs.
TEST(HullLandscape, AllTriplesAndPairsAgree) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE(seed);
        const Hull hull = test::random_hull(seed, 24);
        const HullLandscape landscape = hull_landscape(hull.points, hull.center);
        expect_sound(landscape);
        EXPECT_EQ(landscape.poses.size() + landscape.maxima, landscape.passes.size() + 2);
        const test::Criticals truth = test::critical_poses(hull);
        ASSERT_EQ(landscape.poses.size(), truth.minima.size());
        ASSERT_EQ(landscape.passes.size(), truth.passes.size());
        for (std::size_t n = 0; n < truth.minima.size(); ++n)
            expect_close(landscape.poses[n].height_m, truth.minima[n]);
        for (std::size_t n = 0; n < truth.passes.size(); ++n)
            expect_close(landscape.passes[n].height_m, truth.passes[n]);
    }
}

// Tosses: each turns down by small steps of the (sub)gradient until it rests.
TEST(HullLandscape, ChancesAreThoseOfTosses) {
    constexpr int tosses = 2000;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE(seed);
        const Hull hull = test::random_hull(seed, 10 + 3 * static_cast<unsigned>(seed));
        const HullLandscape landscape = hull_landscape(hull.points, hull.center);
        scenes::Random random(seed + 99);
        std::vector<Vec3> ups;
        for (const HullPose& pose : landscape.poses) ups.push_back(pose.up);
        std::vector<int> rests(ups.size());
        for (int toss = 0; toss < tosses; ++toss) {
            const std::size_t n = test::roll_down(hull, test::random_direction(random), ups);
            ASSERT_LT(n, ups.size());
            ++rests[n];
        }
        for (std::size_t n = 0; n < rests.size(); ++n) {
            const double p = landscape.poses[n].probability;
            // Five standard deviations: about 60 such checks, so a false alarm in 30,000 runs,
            // beside what the steps' length makes of it.
            EXPECT_NEAR(rests[n], p * tosses, 5 * std::sqrt(tosses * p * (1 - p)) + 0.002 * tosses)
                << "pose " << n;
        }
    }
}

TEST(HullLandscape, TurningMovingAndScalingChangeNothing) {
    const Hull hull = test::random_hull(5, 30);
    const HullLandscape plain = hull_landscape(hull.points, hull.center);
    scenes::Random random(12);
    for (const double size : {1e-3, 1.0, 1e5}) {
        const Vec3 shift{3 * size, -7 * size, 2 * size};
        std::vector<Vec3> points = hull.points;
        points.push_back(hull.center);
        points = test::turned(std::move(points), random);
        for (Vec3& p : points) p = along(shift, size, p);
        const Vec3 center = points.back();
        points.pop_back();
        const HullLandscape other = hull_landscape(points, center);
        ASSERT_EQ(other.poses.size(), plain.poses.size());
        for (std::size_t n = 0; n < plain.poses.size(); ++n) {
            expect_close(other.poses[n].height_m, size * plain.poses[n].height_m);
            expect_close(other.poses[n].barrier_m, size * plain.poses[n].barrier_m);
            expect_close(other.poses[n].probability, plain.poses[n].probability, 1e-8);
            EXPECT_EQ(other.poses[n].contacts, plain.poses[n].contacts);
        }
    }
}

std::string refusal(const std::vector<Vec3>& points, const Vec3& center = {0.1, 0.1, 0.1},
                    const HullOptions& options = {}) {
    return test::message_of([&] { hull_landscape(points, center, options); }, ErrorKind::input);
}

TEST(HullLandscape, RefusesWhatIsNoSolid) {
    using ::testing::HasSubstr;
    const double nan = std::nan(""), huge = std::numeric_limits<double>::max();
    const std::vector<Vec3> corner{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    EXPECT_EQ(refusal(corner), "nothing was thrown");
    EXPECT_THAT(refusal({}), HasSubstr("0 points"));
    EXPECT_THAT(refusal({corner[0], corner[1], corner[2]}), HasSubstr("takes four"));
    EXPECT_THAT(refusal(std::vector<Vec3>(9, Vec3{1, 2, 3})), HasSubstr("are one point"));
    EXPECT_THAT(refusal(std::vector<Vec3>(9, Vec3{1, 2, 3}), {1, 2, 3}), HasSubstr("one point"));
    std::vector<Vec3> line, plane;
    scenes::Random random(8);
    for (int n = 0; n < 20; ++n) {
        const double t = random(-1, 1), u = random(-1, 1);
        line.push_back({t, 2 * t + 1, -t / 3});
        plane.push_back({t, u, 0.3 * t - 0.7 * u + 0.2});
    }
    EXPECT_THAT(refusal(line), HasSubstr("on one line"));
    EXPECT_THAT(refusal(plane, plane[3]), HasSubstr("in one plane"));
    auto wrong = corner;
    wrong[2][1] = nan;
    EXPECT_THAT(refusal(wrong), HasSubstr("point 2 is not finite"));
    wrong[2][1] = std::numeric_limits<double>::infinity();
    EXPECT_THAT(refusal(wrong), HasSubstr("point 2 is not finite"));
    wrong[2][1] = huge;
    wrong[1][1] = -huge;
    EXPECT_THAT(refusal(wrong, {0, huge, 0}), HasSubstr("too far apart"));
    EXPECT_THAT(refusal(corner, {0.1, nan, 0.1}), HasSubstr("centre of mass is not finite"));
    EXPECT_THAT(refusal(corner, {1, 1, 1}), HasSubstr("not inside of the hull"));
    EXPECT_THAT(refusal(corner, {0.2, 0.2, 0}), HasSubstr("not inside of the hull"));
    EXPECT_THAT(refusal(corner, {0.1, 0.1, 0.1}, {.resolution_m = -1}), HasSubstr("resolution"));
    EXPECT_THAT(refusal(corner, {0.1, 0.1, 0.1}, {.resolution_m = nan}), HasSubstr("resolution"));
}

}  // namespace
}  // namespace topple::physics

// SPDX-License-Identifier: MIT
// Barriers that have closed forms, from exact vertices and from voxels.
#include "device/devices.h"
#include "host/physics/hulls.h"
#include "physics/hull_landscape.h"
#include "testing.h"

namespace topple::physics {
namespace {

using std::numbers::pi;
using test::body;
using test::ring;

class ClosedForms : public ::testing::Test {
  protected:
    std::unique_ptr<device::Device> device = device::open_native(2);

    // Of an exact vertex set.
    Stability exact(const std::vector<Vec3>& vertices, const MassProperties& mass,
                    std::vector<std::array<double, 2>> polygon) {
        return test::stability({vertices}, {{0}, mass, std::move(polygon)});
    }
    void expect_share(double value, double truth, double share) {
        EXPECT_NEAR(value, truth, share * truth) << "off by " << (value / truth - 1) * 100 << " %";
        double& most = worst_[share];
        most = std::max(most, std::abs(value / truth - 1));
    }
    void TearDown() override {
        for (const auto& [share, most] : worst_)
            std::printf("worst error %.2g of at most %g\n", most, share);
    }
    Stability voxels(const SolidCells& cells) {
        return test::stability(cells, test::standing(*device, cells));
    }

  private:
    std::map<double, double> worst_;  // by what is allowed
};

// Wide enough that tipping over its edges always costs more than the hull's own passes.
const std::vector<std::array<double, 2>> everywhere{{-9, -9}, {9, -9}, {9, 9}, {-9, 9}};

std::vector<Vec3> box_vertices(double a, double b, double c) {
    std::vector<Vec3> v;
    for (const double x : {-a / 2, a / 2}) {
        for (const double y : {-b / 2, b / 2}) {
            for (const double z : {0.0, c}) v.push_back({x, y, z});
        }
    }
    return v;
}

constexpr double box_short = 3.96604, box_long = 8.55630, box_corner = 11.98995;

TEST_F(ClosedForms, BoxOnTheLandscapeAlone) {
    const Stability s = exact(box_vertices(0.3, 0.2, 0.5), body(0.03, {0, 0, 0.25}), everywhere);
    expect_share(s.barrier_J, box_short, 1e-5);
    // Across its narrow side, which is y.
    EXPECT_NEAR(std::abs(s.easiest.direction[1]), 1, 1e-9);
    // From the pass to lying on the 0.5 x 0.3 face, centre 0.1 m up.
    const double weight = 21 * gravity;
    expect_share(s.release_J, box_short + weight * (0.25 - 0.1), 1e-5);
}

// Rings whose facets touch the round body: tipping over a facet is tipping over its rim.
TEST_F(ClosedForms, OfExactHulls) {
    const auto barrier = [&](const std::vector<Vec3>& vertices, const MassProperties& mass) {
        return exact(vertices, mass, everywhere).barrier_J;
    };
    const auto over = [](const MassProperties& mass, double rim) {
        const double h = mass.center[2];
        return mass.mass_kg * gravity * (std::hypot(h, rim) - h);
    };
    const MassProperties box = body(0.03, {0, 0, 0.25});
    EXPECT_NEAR(over(box, 0.1), box_short, 1e-5);
    expect_share(barrier(box_vertices(0.3, 0.2, 0.5), box), over(box, 0.1), 1e-6);
    const double touching = 1 / std::cos(pi / 256);
    std::vector<Vec3> can, hat{{0, 0, 0.3}}, dome;
    for (const auto& [x, y] : ring(0.04 * touching, 256)) {
        can.push_back({x, y, 0});
        can.push_back({x, y, 0.12});
    }
    for (const auto& [x, y] : ring(0.1 * touching, 256)) hat.push_back({x, y, 0});
    for (unsigned band = 0; band < 24; ++band) {
        const double angle = pi / 2 * band / 24;
        for (const auto& [x, y] : ring(0.1 * touching * std::cos(angle), 256))
            dome.push_back({x, y, 0.1 * std::sin(angle)});
    }
    const MassProperties cylinder = body(pi * 0.04 * 0.04 * 0.12, {0, 0, 0.06}),
                         cone = body(pi * 0.01 * 0.3 / 3, {0, 0, 0.075}),
                         hemisphere = body(2.0 / 3 * pi * 0.001, {0, 0, 0.0375});
    EXPECT_NEAR(over(cylinder, 0.04), 0.050148, 1e-6);
    EXPECT_NEAR(over(cone, 0.1), 1.078297, 1e-6);
    EXPECT_NEAR(over(hemisphere, 0.1), 0.996348, 1e-6);
    expect_share(barrier(can, cylinder), over(cylinder, 0.04), 1e-6);
    expect_share(barrier(hat, cone), over(cone, 0.1), 1e-6);
    expect_share(barrier(dome, hemisphere), over(hemisphere, 0.1), 1e-6);
}

TEST_F(ClosedForms, BoxTippingTheLongWay) {
    // From the pose with the 0.5 x 0.2 face down the long way is over the 0.2 edge.
    const Stability s = exact(box_vertices(0.3, 0.2, 0.5), body(0.03, {0, 0, 0.25}),
                              {{-0.15, -9}, {0.15, -9}, {0.15, 9}, {-0.15, 9}});
    expect_share(s.barrier_J, box_short, 0.01);  // the hull's own pass across y is still the lowest
    // A cuboid cannot pass 0.2 wide if y is made long: then x is the weak way.
    const Stability wide = exact(box_vertices(0.3, 2.0, 0.5), body(0.3, {0, 0, 0.25}), everywhere);
    expect_share(wide.barrier_J, 10 * box_long, 0.01);
    EXPECT_GT(std::abs(wide.easiest.direction[0]), 0.99);
}

TEST_F(ClosedForms, BoxCornerIsTheTopOfTheLandscape) {
    const HullLandscape l = hull_landscape(box_vertices(0.3, 0.2, 0.5), {0, 0, 0.25});
    expect_share(21 * gravity * (l.highest_m - 0.25), box_corner, 1e-5);
}

TEST_F(ClosedForms, BoxHeldOnItsBase) {
    const Stability s = exact(box_vertices(0.3, 0.2, 0.5), body(0.03, {0, 0, 0.25}),
                              {{-0.15, -0.1}, {0.15, -0.1}, {0.15, 0.1}, {-0.15, 0.1}});
    expect_share(s.barrier_J, box_short, 1e-5);
    EXPECT_NEAR(s.margin_m, 0.1, 1e-9);
    ASSERT_FALSE(s.curve.empty());
    EXPECT_NEAR(s.curve[0].W_J, s.barrier_J, 1e-6);
    for (std::size_t n = 1; n < s.curve.size(); ++n) {
        EXPECT_GT(s.curve[n].W_J, s.curve[n - 1].W_J);
        EXPECT_GT(s.curve[n].S_J, s.curve[n - 1].S_J);
    }
}

TEST_F(ClosedForms, CylinderOverItsRim) {
    std::vector<Vec3> v;
    for (const auto& p : ring(0.04, 256)) {
        v.push_back({p[0], p[1], 0});
        v.push_back({p[0], p[1], 0.12});
    }
    const double volume = pi * 0.04 * 0.04 * 0.12;
    expect_share(exact(v, body(volume, {0, 0, 0.06}), everywhere).barrier_J, 0.050148, 0.01);
    expect_share(exact(v, body(volume, {0, 0, 0.06}), ring(0.04, 256)).barrier_J, 0.050148, 0.01);
}

TEST_F(ClosedForms, ConeOnItsBase) {
    std::vector<Vec3> v{{0, 0, 0.3}};
    for (const auto& p : ring(0.1, 256)) v.push_back({p[0], p[1], 0});
    const MassProperties mass = body(pi * 0.01 * 0.3 / 3, {0, 0, 0.075});
    const Stability s = exact(v, mass, everywhere);
    expect_share(s.barrier_J, 1.078297, 0.01);
    // Lying, its centre is at 0.071151 m: 4 mm deeper than upright.
    expect_share(s.release_J, s.barrier_J + mass.mass_kg * gravity * (0.075 - 0.071151), 0.01);
}

TEST_F(ClosedForms, Hemisphere) {
    const double r = 0.1;
    std::vector<Vec3> v{{0, 0, r}};
    for (unsigned band = 0; band < 48; ++band) {
        const double angle = pi / 2 * band / 48;
        for (const auto& p : ring(r * std::cos(angle), 96))
            v.push_back({p[0], p[1], r * std::sin(angle)});
    }
    const MassProperties mass = body(2.0 / 3 * pi * r * r * r, {0, 0, 3 * r / 8});
    expect_share(exact(v, mass, everywhere).barrier_J, 0.996348, 0.01);
}

TEST_F(ClosedForms, VoxelisedSolids) {
    const double voxel = 0.005;
    const auto cylinder = [](double x, double y, double) { return x * x + y * y < 0.04 * 0.04; };
    const auto cone = [](double x, double y, double z) {
        const double r = 0.1 * (1 - z / 0.3);
        return r > 0 && x * x + y * y < r * r;
    };
    const auto ball = [](double x, double y, double z) { return x * x + y * y + z * z < 0.01; };
    const SolidCells box = test::voxelise({{0, test::box({0, 0, 0}, {0.3, 0.2, 0.5})}}, {0, 0, 0},
                                          {0.3, 0.2, 0.5}, voxel),
                     can = test::voxelise({{0, cylinder}}, {-0.04, -0.04, 0}, {0.04, 0.04, 0.12},
                                          voxel),
                     hat = test::voxelise({{0, cone}}, {-0.1, -0.1, 0}, {0.1, 0.1, 0.3}, voxel),
                     dome = test::voxelise({{0, ball}}, {-0.1, -0.1, 0}, {0.1, 0.1, 0.1}, voxel),
                     bowl = test::voxelise({{0, ball}}, {-0.1, -0.1, -0.1}, {0.1, 0.1, 0}, voxel);
    {
        expect_share(voxels(box).barrier_J, box_short, 0.001);
        expect_share(voxels(can).barrier_J, 0.050148, 0.05);
        expect_share(voxels(hat).barrier_J, 1.078297, 0.05);
        expect_share(voxels(dome).barrier_J, 0.996348, 0.05);
    }
    // On a dome of voxels it stands on the few of the lowest layer: only the hull tells.
    Candidate rocking = test::standing(*device, bowl);
    rocking.support_polygon = everywhere;
    expect_share(test::stability(bowl, rocking).barrier_J, 0.636915, 0.05);
}

TEST_F(ClosedForms, VoxelisedRollersAreFree) {
    const double voxel = 0.005;
    const auto ball = [](double x, double y, double z) {
        return x * x + y * y + (z - 0.1) * (z - 0.1) < 0.01;
    };
    const auto roll = [](double, double y, double z) {
        return y * y + (z - 0.04) * (z - 0.04) < 0.0016;
    };
    const SolidCells round = test::voxelise({{0, ball}}, {-0.1, -0.1, 0}, {0.1, 0.1, 0.2}, voxel),
                     lying =
                         test::voxelise({{0, roll}}, {-0.06, -0.04, 0}, {0.06, 0.04, 0.08}, voxel);
    {
        for (const SolidCells& cells : {round, lying}) {
            const Stability s = voxels(cells);
            EXPECT_EQ(s.barrier_J, 0);
            EXPECT_EQ(s.release_J, 0);
        }
    }
}

// The landscape sampled over a mesh, and barriers from it, against the exact one of the same hull.

using test::Hull;

double radius_of(const Hull& hull) {
    double radius = 0;
    for (const Vec3& p : hull.points) {
        const Vec3 v = minus(p, hull.center);
        radius = std::max(radius, std::sqrt(dot(v, v)));
    }
    return radius;
}

// Barriers of every pose of a hull, each put upright on a plane.
class Barriers : public ::testing::Test {
  protected:
    static double barrier_m(const Hull& hull, const HullPose& pose, double resolution_m) {
        const Vec3& z = pose.up;
        const Vec3 x = unit(cross(z, std::abs(z[0]) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})),
                   y = cross(z, x);
        std::vector<Vec3> points;
        for (const Vec3& p : hull.points) {
            const Vec3 v = minus(p, hull.center);
            points.push_back({dot(v, x), dot(v, y), dot(v, z)});
        }
        const Candidate candidate{
            {0}, test::body(1.0 / 700, {0, 0, 0}), everywhere, -pose.height_m};
        return test::stability({points}, candidate, resolution_m).barrier_J / gravity;
    }

    // Every pose of the hull that is deeper than 1e-4 of its radius.
    void check(const Hull& hull) {
        const double resolution = 1e-4 * radius_of(hull);
        const HullLandscape exact =
            hull_landscape(hull.points, hull.center, {.resolution_m = resolution});
        for (const HullPose& pose : exact.poses) {
            const double found = barrier_m(hull, pose, resolution);
            if (!std::isfinite(pose.barrier_m)) {
                EXPECT_EQ(found, 0);  // the only pose: nothing is behind any pass
                continue;
            }
            EXPECT_NEAR(found, pose.barrier_m, 0.002 * pose.barrier_m);
            ++poses_;
        }
    }
    std::size_t poses_ = 0;
};

TEST_F(Barriers, OfRandomHulls) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const auto count = static_cast<unsigned>(20 + 4 * seed);
        for (const Hull& hull :
             {test::random_hull(seed, count), test::random_hull(seed + 100, count, 3),
              test::cut_box_hull(seed)}) {
            SCOPED_TRACE(seed);
            check(hull);
        }
    }
    EXPECT_GT(poses_, 600U);
}

// Convex parts as an .obj file lists them, of one density.
Hull read_parts(const std::filesystem::path& path) {
    std::ifstream in(path);
    std::vector<Vec3> all;
    std::vector<std::size_t> first;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string word;
        words >> word;
        if (word == "o") first.push_back(all.size());
        Vec3 p{};
        if (word == "v" && words >> p[0] >> p[1] >> p[2]) all.push_back(p);
    }
    first.push_back(all.size());
    Hull whole{all, {}, 0};
    Vec3 moment{};
    for (std::size_t n = 0; n + 1 < first.size(); ++n) {
        const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first[n]),
                   end = all.begin() + static_cast<std::ptrdiff_t>(first[n + 1]);
        if (begin == end) continue;
        const Hull part = test::uniform_hull({begin, end});
        whole.volume_m3 += part.volume_m3;
        moment = along(moment, part.volume_m3, part.center);
    }
    if (!(whole.volume_m3 > 0)) return test::uniform_hull(all);
    whole.center = along({0, 0, 0}, 1 / whole.volume_m3, moment);
    return whole;
}

TEST_F(Barriers, OfHouseholdObjects) {
    const char* set = std::getenv("TOPPLE_SHARED");
    const std::filesystem::path shared = set ? set : std::string(TOPPLE_SOURCE_DIR) + "/../shared";
    const auto folder = shared / "data" / "ycb";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder << ": set TOPPLE_SHARED";
    std::size_t models = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        SCOPED_TRACE(entry.path());
        check(read_parts(entry.path() / "collision_vhacd.obj"));
        ++models;
    }
    EXPECT_EQ(models, 16U);
}

}  // namespace
}  // namespace topple::physics

// SPDX-License-Identifier: MIT
// Barriers that have closed forms, from exact vertices and from voxels.
#include "device/devices.h"
#include "host/physics/hulls.h"
#include "physics/hull_landscape.h"
#include "physics/hull_polytope.h"
#include "physics/pose_passes.h"
#include "testing.h"

namespace topple::physics {
namespace {

using std::numbers::pi;
using test::body;
using test::ring;

class ClosedForms : public ::testing::Test {
  protected:
    std::unique_ptr<device::Device> device = device::open_native(2);

    // Barrier of an exact vertex set. With `held` false it stands on the hull's landscape alone:
    // the polygon given is far wider than the body, so its edges are no way out.
    Stability exact(const std::vector<Vec3>& vertices, const MassProperties& mass,
                    std::vector<std::array<double, 2>> polygon, unsigned frequency,
                    double height = 0, Passes passes = Passes::sampled) {
        const std::vector<std::vector<Vec3>> sets{vertices};
        const SupportTable table(*device, sets, 0, geodesic_sphere(frequency));
        const Candidate candidate{{0}, mass, std::move(polygon), height};
        return evaluate(*device, table, std::span(&candidate, 1), passes)[0];
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
    Stability voxels(const SolidCells& cells, Passes passes) {
        const SupportTable table(*device, cells, 1, geodesic_sphere(16));
        const Candidate candidate = test::standing(*device, cells);
        return evaluate(*device, table, std::span(&candidate, 1), passes)[0];
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
    for (const unsigned frequency : {8U, 16U, 32U, 48U}) {
        SCOPED_TRACE(frequency);
        const Stability s =
            exact(box_vertices(0.3, 0.2, 0.5), body(0.03, {0, 0, 0.25}), everywhere, frequency);
        expect_share(s.barrier_J, box_short, 0.01);
        // Across its narrow side, which is y.
        EXPECT_LT(std::abs(s.easiest.direction[0]), 0.1);
        EXPECT_GT(std::abs(s.easiest.direction[1]), 0.99);
        // From the pass to lying on the 0.5 x 0.3 face, centre 0.1 m up.
        const double weight = 21 * gravity;
        expect_share(s.release_J, box_short + weight * (0.25 - 0.1), 0.01);
    }
}

// Rings whose facets touch the round body: tipping over a facet is tipping over its rim.
TEST_F(ClosedForms, OfExactHulls) {
    const auto barrier = [&](const std::vector<Vec3>& vertices, const MassProperties& mass) {
        return exact(vertices, mass, everywhere, 16, 0, Passes::exact).barrier_J;
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
                              {{-0.15, -9}, {0.15, -9}, {0.15, 9}, {-0.15, 9}}, 16);
    expect_share(s.barrier_J, box_short, 0.01);  // the hull's own pass across y is still the lowest
    // A cuboid cannot pass 0.2 wide if y is made long: then x is the weak way.
    const Stability wide =
        exact(box_vertices(0.3, 2.0, 0.5), body(0.3, {0, 0, 0.25}), everywhere, 48);
    expect_share(wide.barrier_J, 10 * box_long, 0.01);
    EXPECT_GT(std::abs(wide.easiest.direction[0]), 0.99);
}

TEST_F(ClosedForms, BoxCornerIsTheTopOfTheLandscape) {
    const std::vector<std::vector<Vec3>> sets{box_vertices(0.3, 0.2, 0.5)};
    // Sampled upward maximum: the height of the centre over a corner, less the start's.
    const SphereMesh mesh = geodesic_sphere(48);
    double highest = 0;
    for (std::size_t v = 0; v < mesh.size(); ++v) {
        double low = 1e9;
        for (const Vec3& p : sets[0])
            low = std::min(low, p[0] * mesh.x[v] + p[1] * mesh.y[v] + (p[2] - 0.25) * mesh.z[v]);
        highest = std::max(highest, -low);
    }
    expect_share(21 * gravity * (highest - 0.25), box_corner, 0.01);
}

TEST_F(ClosedForms, BoxHeldOnItsBase) {
    const Stability s = exact(box_vertices(0.3, 0.2, 0.5), body(0.03, {0, 0, 0.25}),
                              {{-0.15, -0.1}, {0.15, -0.1}, {0.15, 0.1}, {-0.15, 0.1}}, 16);
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
    expect_share(exact(v, body(volume, {0, 0, 0.06}), everywhere, 48).barrier_J, 0.050148, 0.01);
    expect_share(exact(v, body(volume, {0, 0, 0.06}), ring(0.04, 256), 16).barrier_J, 0.050148,
                 0.01);
}

TEST_F(ClosedForms, ConeOnItsBase) {
    std::vector<Vec3> v{{0, 0, 0.3}};
    for (const auto& p : ring(0.1, 256)) v.push_back({p[0], p[1], 0});
    const MassProperties mass = body(pi * 0.01 * 0.3 / 3, {0, 0, 0.075});
    const Stability s = exact(v, mass, everywhere, 48);
    expect_share(s.barrier_J, 1.078297, 0.01);
    // Lying, its centre is at 0.071151 m: 4 mm deeper than upright.
    expect_share(s.release_J, s.barrier_J + mass.mass_kg * gravity * (0.075 - 0.071151), 0.01);
}

std::vector<Vec3> dome(double r, double sign) {
    std::vector<Vec3> v;
    for (unsigned band = 0; band < 48; ++band) {
        const double angle = pi / 2 * band / 48;
        for (const auto& p : ring(r * std::cos(angle), 96))
            v.push_back({p[0], p[1], sign * r * std::sin(angle)});
    }
    v.push_back({0, 0, sign * r});
    return v;
}

TEST_F(ClosedForms, Hemisphere) {
    const double r = 0.1, volume = 2.0 / 3 * pi * r * r * r;
    const Stability flat = exact(dome(r, 1), body(volume, {0, 0, 3 * r / 8}), everywhere, 48);
    expect_share(flat.barrier_J, 0.996348, 0.01);
    const Stability round =
        exact(dome(r, -1), body(volume, {0, 0, -3 * r / 8}), everywhere, 48, -r);
    expect_share(round.barrier_J, 0.636915, 0.01);
}

TEST_F(ClosedForms, BallAndLyingCylinderAreOneBasin) {
    std::vector<Vec3> ball = dome(0.1, 1);
    for (const Vec3& v : dome(0.1, -1)) ball.push_back(v);
    const double weight = 700 * 4.0 / 3 * pi * 0.001 * gravity;
    const Stability s = exact(ball, body(4.0 / 3 * pi * 0.001, {0, 0, 0}), everywhere, 32, -0.1);
    EXPECT_LT(s.barrier_J, 0.01 * weight * 0.1);
    EXPECT_EQ(s.release_J, 0);

    // Lying along x.
    std::vector<Vec3> roll;
    for (const auto& p : ring(0.04, 128)) {
        roll.push_back({-0.06, p[0], p[1]});
        roll.push_back({0.06, p[0], p[1]});
    }
    const double volume = pi * 0.04 * 0.04 * 0.12;
    const Stability lying = exact(roll, body(volume, {0, 0, 0}), everywhere, 48, -0.04);
    EXPECT_LT(lying.barrier_J, 0.02 * 700 * volume * gravity * 0.04);
    EXPECT_EQ(lying.release_J, 0);
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
    for (const Passes passes : {Passes::sampled, Passes::exact}) {
        SCOPED_TRACE(passes == Passes::exact ? "exact" : "sampled");
        expect_share(voxels(box, passes).barrier_J, box_short, 0.001);
        expect_share(voxels(can, passes).barrier_J, 0.050148, 0.05);
        expect_share(voxels(hat, passes).barrier_J, 1.078297, 0.05);
        expect_share(voxels(dome, passes).barrier_J, 0.996348, 0.05);
    }
    // On a dome of voxels it stands on the few of the lowest layer: only the hull tells.
    SupportTable table(*device, bowl, 1, geodesic_sphere(16));
    Candidate rocking = test::standing(*device, bowl);
    rocking.support_polygon = everywhere;
    expect_share(evaluate(*device, table, std::span(&rocking, 1), Passes::exact)[0].barrier_J,
                 0.636915, 0.05);
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
    for (const Passes passes : {Passes::sampled, Passes::exact}) {
        SCOPED_TRACE(passes == Passes::exact ? "exact" : "sampled");
        for (const SolidCells& cells : {round, lying}) {
            const Stability s = voxels(cells, passes);
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

// Poses whose barrier is at least a share of the radius, and for how many the mesh's
// disconnectivity graph has a basin: one from whose minimum the steepest way down leads there.
struct Found {
    std::size_t poses = 0, found = 0;
};
Found basins_on(const SphereMesh& mesh, const Hull& hull, const HullLandscape& exact,
                double resolution, double share) {
    std::vector<float> height(mesh.size());
    for (std::size_t v = 0; v < mesh.size(); ++v) {
        double highest = 0;
        for (const Vec3& p : hull.points)
            highest = std::max(highest, dot(minus(hull.center, p), direction_of(mesh, v)));
        height[v] = static_cast<float>(highest);
    }
    const HullPolytope polytope = hull_polytope(hull.points, hull.center);
    const MergeTree nodes = merge_tree(polytope, resolution / polytope.radius);
    std::vector<bool> seen(exact.poses.size(), false);
    for (const MergeTree::Basin& basin : disconnectivity_graph(height, mesh, 0).basins) {
        const std::uint32_t face = descend(polytope, opposite(direction_of(mesh, basin.minimum)));
        seen.at(static_cast<std::size_t>(nodes.basin_of[face])) = true;
    }
    Found count;
    for (std::size_t n = 0; n < seen.size(); ++n) {
        if (exact.poses[n].barrier_m < share * exact.highest_m) continue;
        ++count.poses;
        count.found += seen[n];
    }
    return count;
}

// Barriers of every pose of a hull, each put upright on a plane, by evaluate().
class Barriers : public ::testing::Test {
  protected:
    std::unique_ptr<device::Device> device = device::open_native(2);
    const SphereMesh mesh = geodesic_sphere(16);

    std::vector<double> barriers(const Hull& hull, const HullLandscape& exact, double resolution,
                                 Passes passes) {
        std::vector<std::vector<Vec3>> sets;
        std::vector<Candidate> candidates;
        for (const HullPose& pose : exact.poses) {
            const Vec3& z = pose.up;
            const Vec3 x = unit(cross(z, std::abs(z[0]) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})),
                       y = cross(z, x);
            std::vector<Vec3> points;
            for (const Vec3& p : hull.points) {
                const Vec3 v = minus(p, hull.center);
                points.push_back({dot(v, x), dot(v, y), dot(v, z)});
            }
            // A polygon so wide that only the hull's own passes lead anywhere.
            candidates.push_back({{static_cast<std::int32_t>(sets.size())},
                                  test::body(1.0 / 700, {0, 0, 0}),
                                  {{-9, -9}, {9, -9}, {9, 9}, {-9, 9}},
                                  -pose.height_m});
            sets.push_back(std::move(points));
        }
        const SupportTable table(*device, sets, resolution, mesh);
        std::vector<double> result;
        for (const Stability& s : evaluate(*device, table, candidates, passes))
            result.push_back(s.barrier_J / gravity);
        return result;
    }

    // Every pose of the hull that is deeper than 1e-4 of its radius.
    void check(const Hull& hull) {
        const double resolution = 1e-4 * radius_of(hull);
        const HullLandscape exact =
            hull_landscape(hull.points, hull.center, {.resolution_m = resolution});
        const std::vector<double> by_hull = barriers(hull, exact, resolution, Passes::exact),
                                  by_mesh = barriers(hull, exact, resolution, Passes::sampled);
        for (std::size_t n = 0; n < exact.poses.size(); ++n) {
            const double truth = exact.poses[n].barrier_m;
            if (!std::isfinite(truth)) {
                EXPECT_EQ(by_hull[n], 0);  // the only pose: nothing is behind any pass
                continue;
            }
            EXPECT_NEAR(by_hull[n], truth, 0.002 * truth) << "pose " << n;
            ++poses_;
            if (truth < 0.1 * exact.highest_m) continue;
            ++deep_;
            deep_near_ += std::abs(by_mesh[n] / truth - 1) <= 0.02;
        }
        const Found coarse = basins_on(mesh, hull, exact, resolution, 0.04);
        const Found fine = basins_on(fine_, hull, exact, resolution, 0.01);
        EXPECT_EQ(coarse.found, coarse.poses);
        EXPECT_EQ(fine.found, fine.poses);
        coarse_ += coarse.poses;
        fine_found_ += fine.poses;
    }
    void TearDown() override {
        std::cout << poses_ << " poses with exact barriers; of " << deep_
                  << " deeper than a tenth of the radius, the mesh has " << deep_near_
                  << " within 2 %; basins on the mesh: all " << coarse_
                  << " deeper than 4 % of the radius at frequency 16, all " << fine_found_
                  << " deeper than 1 % at 48\n";
    }
    const SphereMesh fine_ = geodesic_sphere(48);
    std::size_t poses_ = 0, deep_ = 0, deep_near_ = 0, coarse_ = 0, fine_found_ = 0;
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
    EXPECT_GE(deep_near_ * 4, deep_ * 3);
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

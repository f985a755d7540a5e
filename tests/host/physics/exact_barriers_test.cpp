// SPDX-License-Identifier: MIT
// The landscape sampled over a mesh, and barriers from it, against the exact one of the same hull.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "device/devices.h"
#include "host/physics/hulls.h"
#include "physics/hull_landscape.h"
#include "physics/hull_polytope.h"
#include "physics/pose_passes.h"

namespace topple::physics {
namespace {

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
        for (const Vec3& p : hull.points) {
            highest = std::max(highest, dot(minus(hull.center, p), direction_of(mesh, v)));
        }
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
        for (const Stability& s : evaluate(*device, table, candidates, passes)) {
            result.push_back(s.barrier_J / gravity);
        }
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

// SPDX-License-Identifier: MIT
#include <iostream>
// These need what comes before.
#include <gudhi/Persistent_cohomology.h>
#include <gudhi/Simplex_tree.h>

#include "device/devices.h"
#include "host/physics/hulls.h"
#include "oracle/flood_oracle.h"
#include "oracle/geodesic_sphere.h"
#include "physics/assess.h"
#include "physics/body_landscape.h"
#include "physics/hull_landscape.h"
#include "physics/sliding.h"
#include "testing.h"
#include "topple/error.h"
#include "topple/kernel_testing/compare.h"

namespace topple::physics {
namespace {

using test::geodesic_sphere;
using test::SphereMesh;

MergeTree tree_of(const std::vector<float>& energy, const SphereMesh& mesh, double tolerance) {
    std::vector<std::vector<std::uint32_t>> neighbours;
    for (std::size_t v = 0; v < mesh.size(); ++v)
        neighbours.emplace_back(mesh.neighbour.begin() + static_cast<std::ptrdiff_t>(6 * v),
                                mesh.neighbour.begin() + static_cast<std::ptrdiff_t>(6 * v + 6));
    return disconnectivity_graph(std::vector<double>(energy.begin(), energy.end()), neighbours,
                                 tolerance);
}

// The least, over all ways from a to b, of the highest energy on the way.
double minimax(const MergeTree& tree, const std::vector<float>& energy, std::uint32_t a,
               std::uint32_t b) {
    const double level = std::max(energy[a], energy[b]);
    const std::int32_t last = tree.last_join(a, b);
    return last < 0 ? level : std::max(level, tree.basins[last].pass);
}

// Whether b can be reached from a without rising above `level`: by plain search.
bool connected(const std::vector<float>& energy, const SphereMesh& mesh, std::uint32_t a,
               std::uint32_t b, float level) {
    if (energy[a] > level) return false;
    std::vector<bool> seen(energy.size(), false);
    std::vector<std::uint32_t> next{a};
    seen[a] = true;
    while (!next.empty()) {
        const std::uint32_t v = next.back();
        next.pop_back();
        if (v == b) return true;
        for (std::size_t k = 0; k < 6; ++k) {
            const std::uint32_t w = mesh.neighbour[v * 6 + k];
            if (seen[w] || energy[w] > level) continue;
            seen[w] = true;
            next.push_back(w);
        }
    }
    return false;
}

TEST(DisconnectivityGraph, EveryMinimumDiesAtItsLowestPass) {
    const SphereMesh mesh = geodesic_sphere(3);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        test::Random random(seed);
        std::vector<float> energy = random.floats(mesh.size(), 0, 1);
        if (seed % 2) {
            for (float& e : energy) e = std::floor(e * 6) / 6;
        }
        const MergeTree tree = tree_of(energy, mesh, 0);
        // By definition: a basin dies at the least energy that links its minimum to a deeper one
        // (or, where equal, to one of a lower id).
        ASSERT_FALSE(tree.basins.empty());
        EXPECT_EQ(tree.basins[0].parent, -1);
        EXPECT_EQ(tree.basins[0].pass, std::numeric_limits<double>::infinity());
        for (std::size_t b = 1; b < tree.basins.size(); ++b) {
            const MergeTree::Basin& basin = tree.basins[b];
            EXPECT_GE(basin.energy, tree.basins[b - 1].energy);
            EXPECT_GT(basin.pass, basin.energy);
            EXPECT_EQ(energy[basin.saddle], basin.pass);
            EXPECT_EQ(energy[basin.minimum], basin.energy);
            float lowest = 9;
            for (std::uint32_t v = 0; v < energy.size(); ++v) {
                const bool elder = energy[v] < energy[basin.minimum] ||
                                   (energy[v] == energy[basin.minimum] && v < basin.minimum);
                if (!elder) continue;
                for (const float level : energy) {
                    if (level < lowest && connected(energy, mesh, basin.minimum, v, level))
                        lowest = level;
                }
            }
            EXPECT_EQ(basin.pass, lowest);
        }
    }
}

TEST(DisconnectivityGraph, GivesTheFloodsLevels) {
    for (const unsigned f : {2U, 5U, 9U}) {
        const SphereMesh mesh = geodesic_sphere(f);
        for (std::uint64_t seed = 1; seed <= 6; ++seed) {
            test::Random random(seed * 100 + f);
            std::vector<float> energy = random.floats(mesh.size(), 0, 1);
            if (seed % 2) {
                for (float& e : energy) e = std::floor(e * 5) / 5;
            }
            const MergeTree tree = tree_of(energy, mesh, 0);
            const auto start = static_cast<std::uint32_t>(random.word() % mesh.size());
            const std::vector<float> flood = oracle::flood(energy, mesh.neighbour, 6, start);
            for (std::uint32_t v = 0; v < mesh.size(); ++v) {
                ASSERT_EQ(minimax(tree, energy, start, v), flood[v])
                    << "f " << f << " seed " << seed << " at " << v;
            }
        }
    }
}

TEST(DisconnectivityGraph, PlateausAreOneBasin) {
    const SphereMesh mesh = geodesic_sphere(8);
    const std::vector<float> flat(mesh.size(), 1.0F);
    EXPECT_EQ(tree_of(flat, mesh, 0).basins.size(), 1U);
    test::Random random(3);
    const std::vector<float> noise = random.floats(mesh.size(), 1.0F, 1.001F);
    EXPECT_GT(tree_of(noise, mesh, 0).basins.size(), 10U);
    EXPECT_EQ(tree_of(noise, mesh, 0.0011).basins.size(), 1U);
    EXPECT_THROW(disconnectivity_graph({}, std::vector<std::vector<std::uint32_t>>(1), 0), Error);
}

TEST(DisconnectivityGraph, ABoxHasSixBasins) {
    const SphereMesh mesh = geodesic_sphere(32);
    std::vector<float> height;
    for (std::size_t v = 0; v < mesh.size(); ++v) {
        height.push_back(0.15F * std::abs(mesh.x[v]) + 0.1F * std::abs(mesh.y[v]) +
                         0.25F * std::abs(mesh.z[v]));
    }
    const MergeTree tree = tree_of(height, mesh, 0.01);
    ASSERT_EQ(tree.basins.size(), 6U);
    // On each pair of faces: 0.1, 0.15 and 0.25 m up. The mesh overshoots where it misses a face.
    const double truth[6] = {0.1, 0.1, 0.15, 0.15, 0.25, 0.25};
    for (std::size_t b = 0; b < 6; ++b) EXPECT_NEAR(tree.basins[b].energy, truth[b], 0.008);
}

constexpr std::array<double, 3> size{0.3, 0.2, 0.5};

std::vector<std::array<double, 2>> rectangle(double x0, double x1, double y0, double y1) {
    return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

struct Standing {
    const char* name;
    std::vector<std::array<double, 2>> support;
    double support_height_m;
    bool stood = true;
    std::vector<Vec3> more = {};  // of its hull
};

// The least climb out of the pose that it is in, by the disconnectivity graph.
double barrier_from_now(const Landscape& l) {
    const Landscape::Pose& now = l.poses.at(static_cast<std::size_t>(l.now));
    double least = now.joins_at_J;
    for (const Landscape::Pose& pose : l.poses)
        if (pose.joins == l.now) least = std::min(least, pose.joins_at_J);
    return least - now.energy_J;
}

// One hull for both: whatever holds it, the landscape's pose "now" is the one that was scanned, and
// its barrier that of the object.
TEST(BodyLandscape, NowIsThePoseAsScannedBehindItsBarrier) {
    const Vec3 center{0, 0, size[2] / 2};
    const Standing ways[] = {
        {"on all of its foot", rectangle(-0.15, 0.15, -0.1, 0.1), 0},
        {"on a table's edge", rectangle(-0.15, 0.05, -0.1, 0.1), 0},
        {"on a narrow pedestal", rectangle(-0.002, 0.002, -0.1, 0.1), 0},
        {"something hangs down beside its support",
         rectangle(-0.15, 0.15, -0.1, 0.1),
         0,
         true,
         {{0.17, 0, -0.2}}},
        {"leans far over", rectangle(-0.15, 0.6, -0.1, 0.1), 0},
        {"stuck halfway in its support", rectangle(-0.15, 0.15, -0.1, 0.1), 0.1},
        {"hangs from its top", rectangle(-0.1, 0.1, -0.02, 0.02), 0.5},
        {"beside what it stands on", rectangle(0.05, 0.15, -0.1, 0.1), 0},
        {"nothing holds it", {}, 0, false}};
    for (const Standing& way : ways) {
        SCOPED_TRACE(way.name);
        std::vector<std::vector<Vec3>> vertices{test::box_hull(size[0], size[1], size[2]).points};
        for (Vec3& v : vertices[0]) v[2] += center[2];
        vertices[0].insert(vertices[0].end(), way.more.begin(), way.more.end());
        Candidate box;
        box.primitives = {0};
        box.body.mass_kg = 20;
        box.body.center = center;
        box.support_polygon = way.support;
        box.support_height_m = way.support_height_m;
        box.stood = way.stood;
        const StandingHull hull = standing_hull({vertices, 0.01}, box);
        const Stability tipping = assess(hull, box);
        const Landscape l = body_landscape(hull, box, tipping.ways);
        const Landscape::Pose& now = l.poses.at(static_cast<std::size_t>(l.now));
        EXPECT_EQ(now.up, (Vec3{0, 0, 1}));
        EXPECT_EQ(now.energy_J, 0);
        EXPECT_NEAR(barrier_from_now(l), combine_curves(tipping, {}).barrier_J,
                    1e-6 * box.body.mass_kg * gravity);
        EXPECT_TRUE(std::ranges::is_sorted(l.poses, {}, &Landscape::Pose::energy_J));
        EXPECT_TRUE(std::ranges::is_sorted(l.passes, {}, &Landscape::Pass::energy_J));
        std::size_t deepest = 0;
        for (const Landscape::Pose& pose : l.poses) {
            deepest += pose.joins < 0;
            EXPECT_GE(pose.joins_at_J, pose.energy_J);
            if (pose.joins < 0) continue;
            EXPECT_LE(l.poses.at(static_cast<std::size_t>(pose.joins)).energy_J, pose.energy_J);
        }
        EXPECT_EQ(deepest, 1U);
    }
}

TEST(BodyLandscape, AFlatSheetIsAsThickAsItsResolution) {
    Candidate sheet;
    sheet.primitives = {0};
    sheet.body.mass_kg = 1;
    sheet.body.center = {0.3, 0.3, 0};
    const StandingHull hull = standing_hull({{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, 0.01}, sheet);
    const Landscape l = body_landscape(hull, sheet, {});
    ASSERT_EQ(l.poses.size(), 2U);
    EXPECT_EQ(l.poses[l.now].up, (Vec3{0, 0, 1}));
    double highest = 0;
    for (const Vec3& v : l.hull_m) highest = std::max(highest, std::abs(v[2]));
    EXPECT_NEAR(highest, 0.005, 1e-12);
}

TEST(BodyLandscape, WhatHasNoCornersHasThePoseAsScannedAlone) {
    Candidate nothing;
    nothing.primitives = {0};
    const Landscape l = body_landscape(standing_hull({{{}}, 0.01}, nothing), nothing, {});
    EXPECT_TRUE(l.hull_m.empty());
    ASSERT_EQ(l.poses.size(), 1U);
    EXPECT_EQ(l.poses[0].up, (Vec3{0, 0, 1}));
}

// Disconnectivity graphs against GUDHI: the merge tree of a landscape is the persistent homology of
// dimension 0 of its sublevel sets.

using Pair = std::pair<double, double>;  // height of a minimum, and where it joins a deeper one
using Complex = Gudhi::Simplex_tree<Gudhi::Simplex_tree_options_full_featured>;

// Ascending; what never joins ends at infinity.
std::vector<Pair> persistence(Complex& complex) {
    using Homology =
        Gudhi::persistent_cohomology::Persistent_cohomology<Complex,
                                                            Gudhi::persistent_cohomology::Field_Zp>;
    Homology homology(complex);
    homology.init_coefficients(2);
    homology.compute_persistent_cohomology(0);
    std::vector<Pair> pairs;
    for (const auto& [birth, death] : homology.intervals_in_dimension(0)) {
        if (death > birth) pairs.emplace_back(birth, death);
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

std::vector<Pair> pairs_of(const MergeTree& tree) {
    std::vector<Pair> pairs;
    for (const MergeTree::Basin& basin : tree.basins) pairs.emplace_back(basin.energy, basin.pass);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

Complex complex_of(const std::vector<float>& energy, const SphereMesh& mesh) {
    Complex complex;
    for (int v = 0; v < static_cast<int>(energy.size()); ++v) {
        const auto at = static_cast<std::size_t>(v);
        complex.insert_simplex({v}, energy[at]);
        for (std::size_t k = 0; k < 6; ++k) {
            const std::uint32_t w = mesh.neighbour[at * 6 + k];
            complex.insert_simplex_and_subfaces({v, static_cast<int>(w)},
                                                std::max(energy[at], energy[w]));
            complex.assign_filtration(complex.find({static_cast<int>(w)}), energy[w]);
        }
    }
    complex.make_filtration_non_decreasing();
    return complex;
}

TEST(Persistence, RandomFieldsOnTheSphere) {
    std::size_t basins = 0;
    for (const unsigned f : {1U, 2U, 4U, 9U, 16U}) {
        const SphereMesh mesh = geodesic_sphere(f);
        for (std::uint64_t seed = 1; seed <= 12; ++seed) {
            SCOPED_TRACE(::testing::Message() << "frequency " << f << " seed " << seed);
            scenes::Random random(seed, f);
            std::vector<float> energy(mesh.size());
            for (float& e : energy) e = static_cast<float>(random.uniform());
            // Few levels: plateaus and ties.
            if (seed % 3 == 0) {
                for (float& e : energy) e = std::floor(e * 7) / 7;
            }
            // Smooth ones, as landscapes are.
            if (seed % 3 == 1) {
                const test::Hull hull = test::random_hull(seed, 40);
                for (std::size_t v = 0; v < mesh.size(); ++v) {
                    double height = 0;
                    for (const Vec3& p : hull.points) {
                        height = std::max(
                            height, dot(minus(hull.center, p), {mesh.x[v], mesh.y[v], mesh.z[v]}));
                    }
                    energy[v] = static_cast<float>(height);
                }
            }
            Complex complex = complex_of(energy, mesh);
            const std::vector<Pair> pairs = pairs_of(tree_of(energy, mesh, 0));
            ASSERT_EQ(pairs, persistence(complex));
            basins += pairs.size();
        }
    }
    EXPECT_GT(basins, 4000U);
}

// Faces and edges of a hull, each with the highest point of its arc, from its points alone.
Complex complex_of(const test::Hull& hull) {
    const auto shape = convex_hull(hull.points).value();
    std::vector<Vec3> normal;
    std::vector<double> height;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> left;
    for (const auto& face : shape.faces) {
        Vec3 sum{};
        for (std::size_t n = 1; n + 1 < face.size(); ++n) {
            const Vec3 &a = hull.points[face[0]], &b = hull.points[face[n]],
                       &c = hull.points[face[n + 1]];
            sum = along(sum, 1, cross(minus(b, a), minus(c, a)));
        }
        for (std::size_t n = 0; n < face.size(); ++n)
            left[{face[n], face[(n + 1) % face.size()]}] = static_cast<int>(normal.size());
        normal.push_back(unit(sum));
        height.push_back(dot(normal.back(), minus(hull.points[face[0]], hull.center)));
    }
    Complex complex;
    for (std::size_t f = 0; f < normal.size(); ++f)
        complex.insert_simplex({static_cast<int>(f)}, height[f]);
    for (const auto& [ends, f] : left) {
        const int g = left.at({ends.second, ends.first});
        const Vec3 &from = normal[f], &to = normal[g], axis = cross(from, to);
        const Vec3 a = minus(hull.points[ends.first], hull.center),
                   edge = minus(hull.points[ends.second], hull.points[ends.first]);
        const Vec3 foot = along(a, -dot(a, edge) / dot(edge, edge), edge);
        double top = std::max(height[f], height[g]);
        if (dot(cross(from, foot), axis) > 0 && dot(cross(foot, to), axis) > 0)
            top = std::sqrt(dot(foot, foot));
        complex.insert_simplex({f, g}, top);
    }
    return complex;
}

TEST(Persistence, LandscapesOfHulls) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE(seed);
        const test::Hull hull = seed % 3 == 0   ? test::cut_box_hull(seed)
                                : seed % 3 == 1 ? test::random_hull(seed, 20 + 5 * seed)
                                                : test::random_hull(seed, 300, 3);
        const HullLandscape landscape = hull_landscape(hull.points, hull.center);
        std::vector<Pair> pairs;
        for (const HullPose& pose : landscape.poses)
            pairs.emplace_back(pose.height_m, pose.joins_at_m);
        std::sort(pairs.begin(), pairs.end());
        Complex complex = complex_of(hull);
        const std::vector<Pair> truth = persistence(complex);
        ASSERT_EQ(pairs.size(), truth.size());
        for (std::size_t n = 0; n < pairs.size(); ++n) {
            EXPECT_NEAR(pairs[n].first, truth[n].first, 1e-12);
            if (std::isfinite(truth[n].second)) {
                EXPECT_NEAR(pairs[n].second, truth[n].second, 1e-12);
            } else {
                EXPECT_EQ(pairs[n].second, truth[n].second);
            }
        }
    }
}

}  // namespace
}  // namespace topple::physics

// SPDX-License-Identifier: MIT
// Disconnectivity graphs against GUDHI: the merge tree of a landscape is the persistent homology of
// dimension 0 of its sublevel sets.
#include <gtest/gtest.h>
#include <gudhi/Persistent_cohomology.h>
#include <gudhi/Simplex_tree.h>

#include <map>

#include "host/physics/hulls.h"
#include "physics/hull_landscape.h"
#include "physics/landscape.h"

namespace topple::physics {
namespace {

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
            const std::vector<Pair> pairs = pairs_of(disconnectivity_graph(energy, mesh, 0));
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
        for (std::size_t n = 0; n < face.size(); ++n) {
            left[{face[n], face[(n + 1) % face.size()]}] = static_cast<int>(normal.size());
        }
        normal.push_back(unit(sum));
        height.push_back(dot(normal.back(), minus(hull.points[face[0]], hull.center)));
    }
    Complex complex;
    for (std::size_t f = 0; f < normal.size(); ++f) {
        complex.insert_simplex({static_cast<int>(f)}, height[f]);
    }
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
        for (const HullPose& pose : landscape.poses) {
            pairs.emplace_back(pose.height_m, pose.joins_at_m);
        }
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

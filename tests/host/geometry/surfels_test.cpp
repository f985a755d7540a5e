// SPDX-License-Identifier: MIT
#include "geometry/surfels.h"

#include "clouds.h"
#include "core/random.h"
#include "device/devices.h"
#include "points/given_attributes.h"
#include "testing.h"
#include "topple/error.h"
#include "topple/kernel_testing/random.h"

namespace topple::geometry {
namespace {

using test::add;
using test::Random;

// A box of 1 x 0.8 x 0.6 m seen from inside, with noise along the faces' normals.
PointCloud room(double noise, std::uint64_t seed) {
    Random random(seed);
    PointCloud cloud;
    const std::array<double, 3> size{1, 0.8, 0.6};
    for (int i = 0; i < 60'000; ++i) {
        const std::size_t axis = random.word() % 3;
        std::array<double, 3> p{random.uniform() * size[0], random.uniform() * size[1],
                                random.uniform() * size[2]};
        p[axis] = (random.word() & 1) != 0 ? 0 : size[axis];
        p[axis] += noise * random.normal();
        add(cloud, p[0], p[1], p[2]);
    }
    return cloud;
}

class SurfelsTest : public ::testing::Test {
  protected:
    std::unique_ptr<device::Device> device = device::open_native();
};

TEST_F(SurfelsTest, NormalsOfARoomPointInside) {
    for (const double noise : {0.0, 0.003}) {
        const PointCloud cloud = room(noise, 1);
        const Vec3 eye{0.5, 0.4, 0.3};
        const Surfels s = make_surfels(*device, cloud, 0.02, {&eye, 1}, {});
        ASSERT_EQ(s.of_point.size(), cloud.size());
        std::size_t inner = 0, straight = 0;
        double worst = 0;
        for (std::size_t i = 0; i < s.size(); ++i) {
            const double length =
                std::sqrt(s.nx[i] * s.nx[i] + s.ny[i] * s.ny[i] + s.nz[i] * s.nz[i]);
            ASSERT_NEAR(length, 1, 1e-4);
            const Vec3 to_eye{eye[0] - s.x[i], eye[1] - s.y[i], eye[2] - s.z[i]};
            ASSERT_GE(s.nx[i] * to_eye[0] + s.ny[i] * to_eye[1] + s.nz[i] * to_eye[2], 0);
            // Away from the edges a face's normal is an axis.
            int near = 0;
            const std::array<double, 3> p{s.x[i], s.y[i], s.z[i]}, size{1, 0.8, 0.6};
            for (std::size_t a = 0; a < 3; ++a) near += std::min(p[a], size[a] - p[a]) < 0.06;
            if (near != 1) continue;
            ++inner;
            const double along =
                std::max({std::abs(s.nx[i]), std::abs(s.ny[i]), std::abs(s.nz[i])});
            straight += along > std::cos(6 * M_PI / 180);
            for (std::size_t a = 0; a < 3; ++a) {
                if (std::min(p[a], size[a] - p[a]) < 0.06)
                    worst = std::max(worst, std::min(std::abs(p[a]), std::abs(p[a] - size[a])));
            }
        }
        EXPECT_GT(inner, 3000u);
        EXPECT_GT(static_cast<double>(straight), 0.99 * static_cast<double>(inner));
        EXPECT_LE(worst, 2 * noise + 1e-5);
    }
}

TEST_F(SurfelsTest, NoiseThickerThanACellLeavesOneLayer) {
    Random random(3);
    PointCloud cloud;
    // Offset by half a cell, so that the plane does not lie on a border between cells.
    for (int i = 0; i < 40'000; ++i)
        add(cloud, random.uniform(), random.uniform(), 0.01 + 0.008 * random.normal());
    const Surfels s = make_surfels(*device, cloud, 0.02, {}, {});
    EXPECT_LT(s.size(), 2500u * 12 / 10);  // 50 x 50 cells
    double square = 0;
    for (std::size_t i = 0; i < s.size(); ++i)
        square += std::pow(s.z[i] - 0.01, 2) / static_cast<double>(s.size());
    EXPECT_LT(std::sqrt(square), 0.004);
}

TEST_F(SurfelsTest, ThinBoardKeepsItsTwoSides) {
    Random random(4);
    PointCloud cloud;
    std::vector<Vec3> eyes{{0.5, 0.5, 2}, {0.5, 0.5, -2}};
    std::vector<std::uint32_t> eye_of;
    for (int i = 0; i < 40'000; ++i) {
        const bool top = (i & 1) == 0;
        add(cloud, random.uniform(), random.uniform(), top ? 0.03 : -0.01);
        eye_of.push_back(top ? 0 : 1);
    }
    const Surfels s = make_surfels(*device, cloud, 0.02, eyes, eye_of);
    std::size_t right = 0;
    for (std::size_t i = 0; i < s.size(); ++i)
        right += s.z[i] > 0.01 ? s.nz[i] > 0.95 : s.nz[i] < -0.95;
    EXPECT_GT(static_cast<double>(right), 0.97 * static_cast<double>(s.size()));
}

// Both sides in one cell: by where they were seen from, or by the points' own normals.
TEST_F(SurfelsTest, WallThinnerThanACellHasTwoSides) {
    constexpr double thick = 0.005, noise = 2e-4;
    for (const bool stored : {false, true}) {
        SCOPED_TRACE(stored ? "normals" : "viewpoints");
        Random random(6);
        PointCloud cloud;
        std::vector<Vec3> eyes{{0.5, 0.5, 2}, {0.5, 0.5, -2}};
        std::vector<std::uint32_t> eye_of;
        for (int i = 0; i < 40'000; ++i) {
            const bool top = (i & 1) == 0;
            add(cloud, random.uniform(), random.uniform(),
                0.007 + (top ? thick : 0) + noise * random.normal());
            if (stored)
                test::add_normal(cloud, Vec3{0, 0, top ? 1.0 : -1.0});
            else
                eye_of.push_back(top ? 0 : 1);
        }
        if (stored) eyes.clear();
        const Surfels s = make_surfels(*device, cloud, 0.02, eyes, eye_of);
        std::size_t right = 0;
        for (std::size_t i = 0; i < s.size(); ++i) {
            const bool top = s.nz[i] > 0;
            right +=
                std::abs(s.nz[i]) > 0.99 && std::abs(s.z[i] - 0.007 - (top ? thick : 0)) < 1e-3;
        }
        EXPECT_EQ(s.size(), 2 * 2500u);
        EXPECT_EQ(right, s.size());
        for (std::size_t i = 0; i < cloud.size(); ++i)
            ASSERT_EQ(s.nz[s.of_point[i]] > 0, (i & 1) == 0);
    }
}

// Noise, also of normals that are turned at times, is no wall.
TEST_F(SurfelsTest, WhatIsNoWallHasOneSide) {
    Random random(7);
    PointCloud cloud;
    for (int i = 0; i < 40'000; ++i) {
        add(cloud, random.uniform(), random.uniform(), 0.01 + 0.002 * random.normal());
        test::add_normal(cloud, Vec3{0, 0, random.uniform() < 0.1 ? -1.0 : 1.0});
    }
    const Surfels s = make_surfels(*device, cloud, 0.02, {}, {});
    EXPECT_LT(s.size(), 2520u);
}

TEST_F(SurfelsTest, FieldsAreConsistentAndOrderFree) {
    PointCloud cloud = room(0.002, 5);
    Random random(6);
    for (auto* channel : {&cloud.red, &cloud.green, &cloud.blue}) {
        for (std::size_t i = 0; i < cloud.size(); ++i)
            channel->push_back(static_cast<std::uint8_t>(random.word()));
    }
    PointCloud reversed = cloud;
    for (auto* axis : {&reversed.x, &reversed.y, &reversed.z}) std::ranges::reverse(*axis);
    for (auto* channel : {&reversed.red, &reversed.green, &reversed.blue})
        std::ranges::reverse(*channel);
    const Vec3 eye{0.5, 0.4, 0.3};
    const Surfels a = make_surfels(*device, cloud, 0.02, {&eye, 1}, {});
    const Surfels b = make_surfels(*device, reversed, 0.02, {&eye, 1}, {});
    for (const auto cells : {&Surfels::cx, &Surfels::cy, &Surfels::cz})
        EXPECT_EQ(a.*cells, b.*cells);
    for (const auto values : {&Surfels::x, &Surfels::nx, &Surfels::roughness_m, &Surfels::lab_l,
                              &Surfels::lab_a, &Surfels::lab_b})
        EXPECT_EQ(a.*values, b.*values);
    EXPECT_EQ(point_spacing(cloud).nearest_m, point_spacing(reversed).nearest_m);
    double points = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        points += a.weight[i];
        EXPECT_NEAR(a.x[i], (a.cx[i] + 0.5) * 0.02, 0.0101);
        if (i > 0) {
            EXPECT_LT(std::tie(a.cx[i - 1], a.cy[i - 1], a.cz[i - 1]),
                      std::tie(a.cx[i], a.cy[i], a.cz[i]));
        }
        for (std::uint32_t k = a.neighbour_first[i]; k < a.neighbour_first[i + 1]; ++k) {
            const std::uint32_t j = a.neighbours[k];
            EXPECT_TRUE(j != i && std::abs(a.cx[i] - a.cx[j]) <= 1 &&
                        std::abs(a.cy[i] - a.cy[j]) <= 1 && std::abs(a.cz[i] - a.cz[j]) <= 1);
            if (k > a.neighbour_first[i]) {
                EXPECT_LT(a.neighbours[k - 1], j);
            }
        }
    }
    EXPECT_EQ(points, static_cast<double>(cloud.size()));
}

// Rows and columns a centimetre apart: that is the spacing, also where points repeat, where a
// corner has three quarters of the points, and where strays surround the plane.
TEST(PointSpacing, IsThatOfTheSurface) {
    PointCloud plane;
    for (int i = 0; i < 150; ++i)
        for (int j = 0; j < 150; ++j) add(plane, 0.01 * i, 0.01 * j, 1);
    EXPECT_NEAR(point_spacing(plane).nearest_m, 0.01, 1e-5);
    PointCloud repeated = plane, dense = plane, strays = plane;
    for (int n = 0; n < 10'000; ++n) add(repeated, 0.5, 0.5, 1);
    EXPECT_NEAR(point_spacing(repeated).nearest_m, 0.01, 1e-5);
    for (int i = 0; i < 250; ++i)
        for (int j = 0; j < 250; ++j) add(dense, -0.5 + 0.002 * i, 0.002 * j, 1);
    EXPECT_GT(point_spacing(dense).nearest_m,
              0.0035);  // most of a centimetre's cells then still hold a point
    EXPECT_LT(point_spacing(dense).nearest_m, 0.011);
    Random random(6);
    for (int n = 0; n < 200; ++n)
        add(strays, 20 * random.uniform(), 20 * random.uniform(), 20 * random.uniform());
    EXPECT_NEAR(point_spacing(strays).nearest_m, 0.01, 1e-5);
}

// A grid of points 4 cm apart in cells of 2 cm: no two cells touch, and all of the plane is one
// piece. Ten centimetres beside it, beyond reach, another plane stays apart.
TEST_F(SurfelsTest, NeighboursReachAcrossEmptyCells) {
    PointCloud cloud;
    constexpr int side = 20;
    for (int plane = 0; plane < 2; ++plane)
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j)
                add(cloud, 0.04 * i + 0.01, 0.04 * j + 0.01, 0.101 * plane + 0.01);
    const Surfels apart = make_surfels(*device, cloud, 0.02, {}, {});
    EXPECT_TRUE(apart.neighbours.empty());
    const Surfels s = make_surfels(*device, cloud, {0.02, 0.04, 0.09}, {}, {});
    ASSERT_EQ(s.size(), cloud.size());
    EXPECT_NEAR(s.area_m2, 0.04 * 0.04, 1e-9);
    for (std::uint32_t i = 0; i < s.size(); ++i) {
        const auto begin = s.neighbours.begin() + s.neighbour_first[i],
                   end = s.neighbours.begin() + s.neighbour_first[i + 1];
        EXPECT_GE(end - begin, 7);  // at a corner
        EXPECT_LE(end - begin, 26);
        EXPECT_TRUE(std::is_sorted(begin, end));
        for (auto at = begin; at != end; ++at) {
            EXPECT_EQ(s.z[i], s.z[*at]);
            EXPECT_NE(i, *at);
            const auto back = s.neighbours.begin() + s.neighbour_first[*at],
                       back_end = s.neighbours.begin() + s.neighbour_first[*at + 1];
            EXPECT_TRUE(std::binary_search(back, back_end, i));
        }
    }
}

// Fine surfels stay as they are, coarse ones become as fine as things are thick, or as the points.
TEST(SurfelScale, FollowsThePoints) {
    const auto cell = [](double spacing_m, double coarse_m) {
        return surfels_for({spacing_m, spacing_m, spacing_m}, coarse_m).cell_m;
    };
    EXPECT_EQ(cell(0.005, 0.011), 0.011);
    EXPECT_EQ(cell(0.012, 0.027), 0.02);
    EXPECT_NEAR(cell(0.05, 0.09), 0.0325, 1e-9);
}

TEST_F(SurfelsTest, OddInputs) {
    EXPECT_EQ(make_surfels(*device, {}, 0.02, {}, {}).size(), 0u);
    PointCloud one;
    add(one, 1, 2, 3);
    const Surfels s = make_surfels(*device, one, 0.02, {}, {});
    ASSERT_EQ(s.size(), 1u);
    EXPECT_EQ(s.nx[0], 0);
    for (int i = 0; i < 100; ++i) add(one, 1, 2, 3);  // duplicates
    EXPECT_EQ(make_surfels(*device, one, 0.02, {}, {}).weight[0], 101);
    EXPECT_EQ(point_spacing(one).nearest_m, 0);
    PointCloud line;
    for (int i = 0; i < 1000; ++i) add(line, 0.001 * i, 0, 0);
    for (const float n : make_surfels(*device, line, 0.02, {}, {}).nx) EXPECT_EQ(n, 0);
    EXPECT_NEAR(point_spacing(line).nearest_m, 0.001, 1e-5);
    PointCloud far = line;
    add(far, 1e9, 0, 0);
    EXPECT_THROW(make_surfels(*device, far, 0.02, {}, {}), Error);
    EXPECT_THROW(make_surfels(*device, line, 0, {}, {}), Error);
    EXPECT_THROW(make_surfels(*device, line, std::numeric_limits<double>::quiet_NaN(), {}, {}),
                 Error);
}

// The floor of a room red but for some points, its other sides of no known colour.
TEST_F(SurfelsTest, ColoursAreMeansOfWhatIsKnown) {
    PointCloud cloud = room(0, 3);
    EXPECT_TRUE(make_surfels(*device, cloud, 0.05, {}, {}).lab_l.empty());
    Random random(4);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const bool floor = cloud.z[i] == 0, known = floor && random.uniform() < 0.5;
        cloud.red.push_back(known ? static_cast<std::uint8_t>(random.uniform() < 0.5 ? 246 : 254)
                                  : std::uint8_t{0});
        cloud.green.push_back(0);
        cloud.blue.push_back(0);
    }
    const Surfels s = make_surfels(*device, cloud, 0.05, {}, {});
    ASSERT_EQ(s.lab_l.size(), s.size());
    ASSERT_EQ(s.lab_b.size(), s.size());
    std::size_t red = 0, unknown = 0;
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (std::isnan(s.lab_l[i])) {
            EXPECT_TRUE(std::isnan(s.lab_a[i]) && std::isnan(s.lab_b[i]));
            ++unknown;
            continue;
        }
        ++red;
        // sRGB (250, 0, 0) under D65, as tables have it.
        EXPECT_NEAR(s.lab_l[i], 52.3, 1);
        EXPECT_NEAR(s.lab_a[i], 78.9, 1.3);
        EXPECT_NEAR(s.lab_b[i], 66.2, 1.5);
        EXPECT_LT(s.z[i], 0.06);
    }
    EXPECT_GT(red, 250u);
    EXPECT_GT(unknown, 500u);
}

// A corner of three walls of 1 m at 1 cm, with 2 mm of noise and normals that are right.
PointCloud corner() {
    PointCloud out;
    topple::Random random(3);
    const auto noise = [&] { return static_cast<float>(0.004 * (random.uniform() - 0.5)); };
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < 10'000; ++i) {
            std::array<float, 3> p{}, n{};
            for (std::size_t a = 0; a < 3; ++a)
                p[a] = std::size_t(axis) == a ? noise() : static_cast<float>(random.uniform());
            n[axis] = 1;
            add(out, p);
            test::add_normal(out, n);
        }
    }
    return out;
}

TEST(GivenAttributes, normals_against_their_surface) {
    using Change = std::function<void(PointCloud&, std::size_t, topple::Random&)>;
    const struct {
        const char* what;
        bool contradict;
        Change change;
    } cases[] = {
        {"right", false, [](PointCloud&, std::size_t, topple::Random&) {}},
        {"noisy", false,
         [](PointCloud& c, std::size_t i, topple::Random& r) {
             for (auto* n : {&c.nx, &c.ny, &c.nz})
                 (*n)[i] += static_cast<float>(0.5 * (r.uniform() - 0.5));
         }},
        {"all turned, which only views tell", false,
         [](PointCloud& c, std::size_t i, topple::Random&) {
             for (auto* n : {&c.nx, &c.ny, &c.nz}) (*n)[i] *= -1;
         }},
        {"none known", false,
         [](PointCloud& c, std::size_t i, topple::Random&) { c.nx[i] = c.ny[i] = c.nz[i] = 0; }},
        {"at random", true,
         [](PointCloud& c, std::size_t i, topple::Random& r) {
             for (auto* n : {&c.nx, &c.ny, &c.nz}) (*n)[i] = static_cast<float>(r.uniform() - 0.5);
         }},
        {"all up", true,
         [](PointCloud& c, std::size_t i, topple::Random&) {
             c.nx[i] = c.ny[i] = 0;
             c.nz[i] = 1;
         }},
        {"axes swapped", true,
         [](PointCloud& c, std::size_t i, topple::Random&) { std::swap(c.nx[i], c.nz[i]); }},
        {"of either side", true,
         [](PointCloud& c, std::size_t i, topple::Random& r) {
             const float side = r.uniform() < 0.5 ? -1 : 1;
             for (auto* n : {&c.nx, &c.ny, &c.nz}) (*n)[i] *= side;
         }},
    };
    const PointCloud right = corner();
    for (const auto& c : cases) {
        SCOPED_TRACE(c.what);
        PointCloud cloud = right;
        topple::Random random(5);
        for (std::size_t i = 0; i < cloud.size(); ++i) c.change(cloud, i, random);
        const GivenAttributes given = look_at_attributes(cloud, 0.01);
        EXPECT_EQ(given.normals_contradict(), c.contradict) << given.askew << " " << given.opposed;
        EXPECT_TRUE(given.colours_tell());
    }
}

TEST(GivenAttributes, colours_that_tell_nothing) {
    using Colour = std::function<std::uint8_t(const PointCloud&, std::size_t, topple::Random&)>;
    const auto random_byte = [](topple::Random& r) {
        return static_cast<std::uint8_t>(1 + 254 * r.uniform());
    };
    const struct {
        const char* what;
        bool tell;
        Colour colour;
    } cases[] = {
        {"walls of one colour each, noisy", true,
         [](const PointCloud& c, std::size_t i, topple::Random& r) {
             return static_cast<std::uint8_t>(60 + 90 * (c.nx[i] > 0.5f) + 60 * r.uniform());
         }},
        {"a pattern", true,
         [](const PointCloud& c, std::size_t i, topple::Random&) {
             return static_cast<std::uint8_t>(128 +
                                              100 * std::sin(20 * (c.x[i] + c.y[i] + c.z[i])));
         }},
        {"at random", false,
         [&](const PointCloud&, std::size_t, topple::Random& r) { return random_byte(r); }},
        {"one", false,
         [](const PointCloud&, std::size_t, topple::Random&) { return std::uint8_t{200}; }},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.what);
        PointCloud cloud = corner();
        topple::Random random(7);
        for (std::size_t i = 0; i < cloud.size(); ++i)
            for (auto* channel : {&cloud.red, &cloud.green, &cloud.blue})
                channel->push_back(c.colour(cloud, i, random));
        const GivenAttributes given = look_at_attributes(cloud, 0.01);
        EXPECT_EQ(given.colours_tell(), c.tell) << given.colour_noise;
        EXPECT_FALSE(given.normals_contradict());
    }
}

}  // namespace
}  // namespace topple::geometry

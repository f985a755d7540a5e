// SPDX-License-Identifier: MIT
#include "points/given_attributes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/random.h"
#include "topple/input.h"

namespace topple::geometry {
namespace {

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
            out.x.push_back(p[0]);
            out.y.push_back(p[1]);
            out.z.push_back(p[2]);
            out.nx.push_back(n[0]);
            out.ny.push_back(n[1]);
            out.nz.push_back(n[2]);
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

// SPDX-License-Identifier: MIT
#include "points/view_coverage.h"

#include <gtest/gtest.h>

#include <cmath>

namespace topple {
namespace {

// A level camera, z up, at (x, y), that looks in a direction given by its angle.
Mat4 camera(double x, double y, double degrees) {
    const double a = degrees * 3.14159265358979 / 180, c = std::cos(a), s = std::sin(a);
    return {s, 0, c, x, -c, 0, s, y, 0, -1, 0, 1.5, 0, 0, 0, 1};
}

constexpr std::array<Vec3, 3> z_up{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

ViewCoverage walk(double way_m, std::initializer_list<double> degrees) {
    ViewCoverage coverage(z_up);
    double at = 0;
    for (const double d : degrees) {
        coverage.add(camera(at, 0.5 * at, d));
        at += way_m;
    }
    return coverage;
}

TEST(ViewCoverage, ManyDirectionsFromManyPlacesAreAround) {
    EXPECT_TRUE(walk(0.6, {170, -60, 50}).from_around());
    EXPECT_TRUE(walk(0.6, {0, 90, 185, 260}).from_around());
}

TEST(ViewCoverage, HalfACircleOrOnePlaceIsNotAround) {
    EXPECT_FALSE(ViewCoverage(z_up).from_around());
    EXPECT_FALSE(walk(5, {30}).from_around());
    EXPECT_FALSE(walk(0.6, {-80, 0, 90}).from_around());
    EXPECT_FALSE(walk(0.1, {0, 90, 185, 260}).from_around());  // turns on the spot
}

}  // namespace
}  // namespace topple

// SPDX-License-Identifier: MIT
#include "geometry/building.h"

#include "clouds.h"
#include "geometry/storeys.h"
#include "testing.h"

namespace topple::geometry {
namespace {

// Sheets of surfels, a region each.
class Sheets {
  public:
    Sheets() {
        surfels_.cell_m = 0.05;
        surfels_.area_m2 = 0.05 * 0.05;
    }

    // A rectangle from `corner` along two edges, seen from the side of `normal`.
    void sheet(const Vec3& corner, const Vec3& along, const Vec3& across, const Vec3& normal) {
        const auto length = [](const Vec3& v) { return std::hypot(v[0], v[1], v[2]); };
        const auto region = static_cast<std::int32_t>(primitives_.faces.regions.size());
        primitives_.faces.regions.emplace_back();
        const double a = length(along), b = length(across), cell = surfels_.cell_m;
        for (double u = 0.5 * cell; u < a; u += cell) {
            for (double v = 0.5 * cell; v < b; v += cell) {
                const auto at = [&](std::size_t axis) {
                    return static_cast<float>(corner[axis] + along[axis] * u / a +
                                              across[axis] * v / b);
                };
                test::add(surfels_, at(0), at(1), at(2));
                test::add_normal(surfels_, normal);
                primitives_.faces.label.push_back(region);
            }
        }
    }
    // Floor, four walls and, if asked, the ceiling, as seen from within.
    void room(double x, double z, bool ceiling = true) {
        constexpr double wide = 4, deep = 3, high = 2.5;
        sheet({x, 0, z}, {wide, 0, 0}, {0, deep, 0}, {0, 0, 1});
        if (ceiling) sheet({x, 0, z + high}, {wide, 0, 0}, {0, deep, 0}, {0, 0, -1});
        sheet({x, 0, z}, {wide, 0, 0}, {0, 0, high}, {0, 1, 0});
        sheet({x, deep, z}, {wide, 0, 0}, {0, 0, high}, {0, -1, 0});
        sheet({x, 0, z}, {0, deep, 0}, {0, 0, high}, {1, 0, 0});
        sheet({x + wide, 0, z}, {0, deep, 0}, {0, 0, high}, {-1, 0, 0});
    }
    // A slab that stands upright, at x, seen from both sides.
    void slab(double x, double long_m, double high_m, double thick_m) {
        sheet({x, 0.5, 0}, {0, long_m, 0}, {0, 0, high_m}, {-1, 0, 0});
        sheet({x + thick_m, 0.5, 0}, {0, long_m, 0}, {0, 0, high_m}, {1, 0, 0});
    }
    std::vector<StoreyHint> storeys() const {
        return find_building(surfels_, primitives_, {0, 0, 1});
    }

  private:
    Surfels surfels_;
    PrimitiveSet primitives_;
};

TEST(Building, OneRoomIsNone) {
    Sheets scan;
    scan.room(0, 0);
    EXPECT_TRUE(scan.storeys().empty());
    scan.slab(2, 1.8, 1.9, 0.35);  // a shelf in its middle
    EXPECT_TRUE(scan.storeys().empty());
}

TEST(Building, AShelfAsHighAsPeopleReachIsNoWallWhereNoCeilingIsSeen) {
    Sheets scan;
    scan.room(0, 0, false);
    scan.slab(2, 1.5, 2.2, 0.35);
    EXPECT_TRUE(scan.storeys().empty());
}

TEST(Building, TwoRoomsShareAWall) {
    for (const bool ceiling : {true, false}) {
        Sheets scan;
        scan.room(0, 0, ceiling);
        scan.room(4.12, 0, ceiling);
        const auto found = scan.storeys();
        ASSERT_EQ(found.size(), 1u) << ceiling;
        EXPECT_NEAR(found[0].floor_m, 0, 0.05);
    }
}

TEST(Building, StoreysHaveAFloorEach) {
    Sheets scan;
    scan.room(0, 0);
    scan.room(0, 2.8);
    const auto found = scan.storeys();
    ASSERT_EQ(found.size(), 2u);
    EXPECT_NEAR(found[1].floor_m, 2.8, 0.05);
    EXPECT_GT(found[1].below_m, 2.5);
    EXPECT_LT(found[1].below_m, 2.8);
    EXPECT_EQ(found[0].top_m, found[1].below_m);
    EXPECT_TRUE(std::isinf(found[1].top_m));
}

// The underside of what is above hangs in view, but nobody walks on it.
TEST(Building, ASuspendedCeilingEndsNoStorey) {
    Sheets scan;
    scan.room(0, 0);
    scan.sheet({0, 0, 2.8}, {4, 0, 0}, {0, 3, 0}, {0, 0, -1});
    EXPECT_TRUE(scan.storeys().empty());
}

TEST(Building, NothingIsNoBuilding) {
    EXPECT_TRUE(Sheets().storeys().empty());
}

constexpr double step_m = 0.025, low_m = -0.5;

// Surface by height: a little everywhere, and these levels (height, square metres).
std::vector<double> histogram(const std::vector<std::pair<double, double>>& levels) {
    std::vector<double> area(600, 0.4);
    for (const auto& [height, m2] : levels)
        area[static_cast<std::size_t>(std::floor((height - low_m) / step_m))] += m2;
    return area;
}

TEST(Storeys, AreCutInTheSlabs) {
    const auto storeys = find_storeys(
        histogram({{0.01, 90}, {2.71, 88}, {3.11, 90}, {5.81, 90}, {6.21, 60}, {8.9, 60}}), low_m,
        step_m);
    ASSERT_EQ(storeys.size(), 3u);
    EXPECT_NEAR(storeys[0].floor_m, 0.01, 0.05);
    EXPECT_TRUE(std::isinf(storeys[0].below_m));
    EXPECT_NEAR(storeys[1].floor_m, 3.11, 0.05);
    EXPECT_NEAR(storeys[1].below_m, 2.91, 0.05);
    EXPECT_NEAR(storeys[2].floor_m, 6.21, 0.05);
    EXPECT_NEAR(storeys[2].below_m, 6.01, 0.05);
}

TEST(Storeys, TablesAndLoweredCeilingsAreNone) {
    const auto storeys =
        find_storeys(histogram({{0, 80}, {0.75, 30}, {2.4, 30}, {2.7, 50}}), low_m, step_m);
    // The ceiling at two heights passes for a slab: what lies above it is empty.
    ASSERT_GE(storeys.size(), 1u);
    EXPECT_NEAR(storeys[0].floor_m, 0, 0.05);
    for (std::size_t s = 1; s < storeys.size(); ++s) EXPECT_GT(storeys[s].below_m, 2.3);
}

// One level of a scan without noise, wherever it lies in the histogram's steps, is one.
TEST(Storeys, ASharpCeilingIsNoSlab) {
    for (double offset = 0; offset < step_m; offset += 0.004) {
        const auto storeys =
            find_storeys(histogram({{0.01 + offset, 90}, {2.7 + offset, 88}, {2.72 + offset, 3}}),
                         low_m, step_m);
        EXPECT_EQ(storeys.size(), 1u) << offset;
    }
}

TEST(Storeys, AScanWithoutCeilingIsOne) {
    const auto storeys = find_storeys(histogram({{0.3, 50}}), low_m, step_m);
    ASSERT_EQ(storeys.size(), 1u);
    EXPECT_NEAR(storeys[0].floor_m, 0.3, 0.05);
}

TEST(Storeys, NothingIsOneStoreyWithoutFloor) {
    const auto storeys = find_storeys({}, 0, step_m);
    ASSERT_EQ(storeys.size(), 1u);
    EXPECT_TRUE(std::isnan(storeys[0].floor_m));
}

}  // namespace
}  // namespace topple::geometry

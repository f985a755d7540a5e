// SPDX-License-Identifier: MIT
#include "geometry/building.h"

#include <gtest/gtest.h>

#include "clouds.h"

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
                surfels_.x.push_back(at(0));
                surfels_.y.push_back(at(1));
                surfels_.z.push_back(at(2));
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

}  // namespace
}  // namespace topple::geometry

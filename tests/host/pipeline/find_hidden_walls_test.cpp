// SPDX-License-Identifier: MIT
#include "objects/find_hidden_walls.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

namespace topple {
namespace {

constexpr std::int32_t left = 0, right = 1, bookcase = 2;

// Two parts of the wall x = 0, and a bookcase between them that reaches from 0.1 to 0.4 m before
// it, of which its front and sides were seen.
class HiddenWall : public testing::Test {
  protected:
    // An upright face of constant x, or y, metres.
    void add_x(std::int32_t primitive, double x, double from_y, double to_y, float nx) {
        for (double y = from_y; y <= to_y; y += 0.05)
            for (double z = 0.05; z < 2; z += 0.05) add(primitive, x, y, z, nx, 0);
    }
    void add_y(std::int32_t primitive, double y, double from_x, double to_x, float ny) {
        for (double x = from_x; x <= to_x; x += 0.05)
            for (double z = 0.05; z < 2; z += 0.05) add(primitive, x, y, z, 0, ny);
    }
    physics::HiddenWalls walls() {
        geometry::sort_by_primitive(parts_.samples);
        SolidCells cells;
        cells.voxel_m = 0.02;
        parts_.solids = std::make_shared<const SolidScene>(
            std::move(cells), std::vector<Role>{Role::wall, Role::wall, Role::none});
        const std::vector<std::int32_t> object{0, 0, 1};
        return find_hidden_walls(parts_, object, {true, true, false});
    }
    void seen_scene() {
        add_x(left, 0, -2, -1.1, 1);
        add_x(right, 0.02, 1.1, 2, 1);
        add_bookcase();
    }
    void add_bookcase() {
        add_x(bookcase, 0.4, -1, 1, 1);
        add_y(bookcase, -1, 0.1, 0.4, -1);
        add_y(bookcase, 1, 0.1, 0.4, 1);
    }

    SolidParts parts_;

  private:
    void add(std::int32_t primitive, double x, double y, double z, float nx, float ny) {
        geometry::SurfaceSamples& s = parts_.samples;
        s.x.push_back(static_cast<float>(x));
        s.y.push_back(static_cast<float>(y));
        s.z.push_back(static_cast<float>(z));
        s.nx.push_back(nx);
        s.ny.push_back(ny);
        s.nz.push_back(0);
        s.primitive.push_back(primitive);
    }
};

TEST_F(HiddenWall, GoesOnBetweenItsSeenParts) {
    seen_scene();
    const physics::HiddenWalls found = walls();
    ASSERT_EQ(found.size(), 1u);
    for (const double y : {-0.95, 0.0, 0.95}) {
        const auto by = found.between({0.25, y, 1}, {-0.1, y, 1});
        ASSERT_TRUE(by) << y;
        EXPECT_TRUE(*by == left || *by == right);
    }
    EXPECT_FALSE(found.between({0.25, 0, 1}, {0.05, 0, 1}));      // before it
    EXPECT_FALSE(found.between({0.25, 0, 1}, {-0.1, 0, 2.6}));    // over it
    EXPECT_FALSE(found.between({0.25, 1.5, 1}, {-0.1, 1.5, 1}));  // nothing hides it there
    EXPECT_FALSE(found.between({-0.5, 0, 1}, {-0.1, 0, 1}));      // both behind it
    EXPECT_TRUE(found.between({0.25, -3, 1}, {-0.1, 1.2, 1}));    // where the way crosses it
}

TEST_F(HiddenWall, IsNotBehindWhatWasSeenFromThere) {
    seen_scene();
    add_x(bookcase, 0.1, -1, 1, -1);  // its back
    EXPECT_EQ(walls().size(), 0u);
}

TEST_F(HiddenWall, NeedsASeenPartBesideTheThing) {
    add_x(left, 0, -3, -2, 1);
    add_bookcase();
    EXPECT_EQ(walls().size(), 0u);
}

TEST_F(HiddenWall, DoesNotGoThroughAThing) {
    add_x(left, 0.25, -2, -1.1, 1);
    add_x(right, 0.25, 1.1, 2, 1);
    add_bookcase();
    EXPECT_EQ(walls().size(), 0u);
}

TEST_F(HiddenWall, IsNotFarBehindAThing) {
    add_x(left, -1, -2, -1.1, 1);
    add_x(right, -1, 1.1, 2, 1);
    add_bookcase();
    EXPECT_EQ(walls().size(), 0u);
}

}  // namespace
}  // namespace topple

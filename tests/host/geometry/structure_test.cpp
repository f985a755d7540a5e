// SPDX-License-Identifier: MIT
#include "geometry/structure.h"

#include <gtest/gtest.h>

namespace topple::geometry {
namespace {

// Level pieces, each a primitive of its own.
struct Scene {
    Surfels surfels;
    PrimitiveSet primitives;

    Scene() {
        surfels.cell_m = 0.02;
        surfels.neighbour_first = {0};
    }
    std::size_t level(double x0, double y0, double x1, double y1, double z, double slope = 0) {
        const auto label = static_cast<std::int32_t>(primitives.model.size());
        for (double x = x0; x < x1; x += surfels.cell_m) {
            for (double y = y0; y < y1; y += surfels.cell_m) {
                surfels.x.push_back(static_cast<float>(x));
                surfels.y.push_back(static_cast<float>(y));
                surfels.z.push_back(static_cast<float>(z + slope * (x - x0)));
                surfels.nx.push_back(0);
                surfels.ny.push_back(0);
                surfels.nz.push_back(1);
                primitives.label.push_back(label);
            }
        }
        primitives.model.push_back("plane");
        primitives.regions.push_back({label});
        return static_cast<std::size_t>(label);
    }
    std::vector<Structure> structure() const {
        return find_structure(surfels, primitives, {0, 0, 1});
    }
};

TEST(Structure, ABoardThatLiesOnTheFloorIsNoFloor) {
    Scene scene;
    const auto floor = scene.level(0, 0, 3, 3, 0);
    const auto board = scene.level(1, 1, 2, 1.4, 0.03);
    const auto found = scene.structure();
    EXPECT_EQ(found[floor], Structure::floor);
    EXPECT_EQ(found[board], Structure::none);
}

TEST(Structure, AFloorThatDriftsIsFloorAllOver) {
    Scene scene;
    const auto first = scene.level(0, 0, 3, 3, 0, 0.006);
    const auto second = scene.level(3, 0, 6, 3, 0.018, 0.006);
    const auto third = scene.level(6, 0, 7, 3, 0.036);
    const auto found = scene.structure();
    EXPECT_EQ(found[first], Structure::floor);
    EXPECT_EQ(found[second], Structure::floor);
    EXPECT_EQ(found[third], Structure::floor);
}

TEST(Structure, GalleriesAndPlatformsAreFloorsTablesAreNot) {
    Scene scene;
    const auto floor = scene.level(0, 0, 5, 5, 0);
    const auto gallery = scene.level(0, 0, 5, 1.5, 2.4);
    const auto platform = scene.level(3, 3, 5, 5.1, 0.3);
    const auto table = scene.level(0, 2, 2, 4.5, 0.75);
    const auto bed = scene.level(2, 0, 3.8, 2, 0.4);
    const auto cupboard = scene.level(4, 0, 4.6, 2, 2.0);
    const auto found = scene.structure();
    EXPECT_EQ(found[floor], Structure::floor);
    EXPECT_EQ(found[gallery], Structure::floor);
    EXPECT_EQ(found[platform], Structure::floor);
    EXPECT_EQ(found[table], Structure::none);
    EXPECT_EQ(found[bed], Structure::none);
    EXPECT_EQ(found[cupboard], Structure::none);
}

TEST(Structure, AFloorInTwoPartsThatNothingJoinsIsFloor) {
    Scene scene;
    const auto here = scene.level(0, 0, 3, 3, 0);
    const auto there = scene.level(5, 0, 7, 3, 0.02);
    const auto found = scene.structure();
    EXPECT_EQ(found[here], Structure::floor);
    EXPECT_EQ(found[there], Structure::floor);
}

}  // namespace
}  // namespace topple::geometry

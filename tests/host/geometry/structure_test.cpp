// SPDX-License-Identifier: MIT
#include "geometry/structure.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

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
        return piece([&](std::int32_t label) {
            sheet(x0, x1, y0, y1, label, {0, 0, 1}, [&](double x, double y) {
                return Vec3{x, y, z + slope * (x - x0)};
            });
        });
    }
    std::size_t ceiling(double x0, double y0, double x1, double y1, double z) {
        return piece([&](std::int32_t label) {
            sheet(x0, x1, y0, y1, label, {0, 0, -1}, [&](double x, double y) {
                return Vec3{x, y, z};
            });
        });
    }
    // Upright, at x, towards +x or -x. With a back, which faces the other way, one part with it.
    std::size_t upright(double x, double y0, double y1, double z0, double z1, double facing,
                        double thick = 0) {
        return piece([&](std::int32_t label) {
            sheet(y0, y1, z0, z1, label, {facing, 0, 0}, [&](double y, double z) {
                return Vec3{x, y, z};
            });
            if (thick > 0)
                sheet(y0, y1, z0, z1, label, {-facing, 0, 0}, [&](double y, double z) {
                    return Vec3{x - facing * thick, y, z};
                });
        });
    }
    // Turns every n-th surfel of a part round.
    void turn_round(std::size_t part, std::size_t nth) {
        for (std::size_t n = 0, k = 0; n < surfels.x.size(); ++n) {
            if (primitives.label[n] != static_cast<std::int32_t>(part) || k++ % nth) continue;
            for (auto* normal : {&surfels.nx, &surfels.ny, &surfels.nz})
                (*normal)[n] = -(*normal)[n];
        }
    }
    std::vector<Structure> structure(const std::vector<StoreyHint>& storeys = {}) {
        find_neighbours();
        return find_structure(surfels, primitives, {0, 0, 1}, storeys);
    }

  private:
    using Cell = std::array<std::int32_t, 3>;

    void find_neighbours() {
        std::map<Cell, std::vector<std::uint32_t>> cells;
        const auto cell = [&](std::size_t n) {
            const auto index = [&](float v) {
                return static_cast<std::int32_t>(std::floor(v / surfels.cell_m + 1e-3));
            };
            return Cell{index(surfels.x[n]), index(surfels.y[n]), index(surfels.z[n])};
        };
        for (std::size_t n = 0; n < surfels.x.size(); ++n)
            cells[cell(n)].push_back(static_cast<std::uint32_t>(n));
        surfels.neighbours.clear();
        surfels.neighbour_first = {0};
        for (std::size_t n = 0; n < surfels.x.size(); ++n) {
            const Cell at = cell(n);
            for (int step = 0; step < 27; ++step) {
                const auto found = cells.find(
                    {at[0] + step % 3 - 1, at[1] + step / 3 % 3 - 1, at[2] + step / 9 - 1});
                if (found == cells.end()) continue;
                for (const std::uint32_t m : found->second)
                    if (m != n) surfels.neighbours.push_back(m);
            }
            surfels.neighbour_first.push_back(
                static_cast<std::uint32_t>(surfels.neighbours.size()));
        }
    }
    template <class Fill>
    std::size_t piece(const Fill& fill) {
        const auto label = static_cast<std::int32_t>(primitives.model.size());
        primitives.regions.emplace_back();
        fill(label);
        primitives.model.push_back("plane");
        return static_cast<std::size_t>(label);
    }
    template <class Place>
    void sheet(double u0, double u1, double v0, double v1, std::int32_t label, const Vec3& normal,
               const Place& place) {
        const auto region = static_cast<std::int32_t>(primitives.faces.regions.size());
        primitives.faces.regions.emplace_back();
        primitives.regions.back().push_back(region);
        for (double u = u0; u < u1; u += surfels.cell_m) {
            for (double v = v0; v < v1; v += surfels.cell_m) {
                const Vec3 p = place(u, v);
                surfels.x.push_back(static_cast<float>(p[0]));
                surfels.y.push_back(static_cast<float>(p[1]));
                surfels.z.push_back(static_cast<float>(p[2]));
                surfels.nx.push_back(static_cast<float>(normal[0]));
                surfels.ny.push_back(static_cast<float>(normal[1]));
                surfels.nz.push_back(static_cast<float>(normal[2]));
                primitives.label.push_back(label);
                primitives.faces.label.push_back(region);
            }
        }
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

// In a map of cells some of a floor's look down, because the sensor erred and saw the space below
// them to be free.
TEST(Structure, AFloorOfWhichSomeCellsLookDownIsFloor) {
    Scene scene;
    const auto floor = scene.level(0, 0, 4, 4, 0);
    const auto table = scene.level(1, 1, 2, 2, 0.75);
    scene.turn_round(floor, 8);
    const auto found = scene.structure();
    EXPECT_EQ(found[floor], Structure::floor);
    EXPECT_EQ(found[table], Structure::none);
}

// A room whose walls were seen up to 1.6 m, with one at x = 4; the camera looked past the end of a
// plane at x = 1, which reaches as high.
struct OpenRoom : Scene {
    std::size_t floor = level(0, 0, 4, 4, 0);
    std::size_t outer = upright(0, 0, 1.2, 0, 1.6, 1);
    std::size_t other = upright(4, 0, 4, 0, 1.6, -1);
};

TEST(StructureOfARoom, AWallThatStepsIsWallOverAll) {
    OpenRoom room;
    const auto step = room.upright(0.14, 1.3, 4, 0, 1.55, 1);
    const auto found = room.structure();
    for (const std::size_t p : {room.outer, room.other, step})
        EXPECT_EQ(found[p], Structure::wall) << p;
}

TEST(StructureOfARoom, FrontsAreNoWalls) {
    OpenRoom room;
    const auto wardrobe = room.upright(0.4, 1.3, 4, 0, 1.55, 1);    // as deep as cupboards are
    const auto radiator = room.upright(3.88, 0, 2, 0.1, 0.9, -1);   // low
    const auto cabinet = room.upright(3.88, 2.2, 4, 0.7, 1.6, -1);  // hangs
    const auto narrow = room.upright(3.88, 2.2, 2.7, 0, 1.6, -1);   // a narrow one
    const auto found = room.structure();
    for (const std::size_t p : {wardrobe, radiator, cabinet, narrow})
        EXPECT_EQ(found[p], Structure::none) << p;
}

// Behind the wall at x = 0 much was seen through a door.
struct RoomWithADoor : Scene {
    std::size_t floor = level(-4, 0, 4, 4, 0);
    std::size_t roof = ceiling(0, 0, 4, 4, 2.6);
    std::size_t wall = upright(0, 0, 3, 0, 2.6, 1);
    std::size_t beyond = upright(-4, 0, 4, 0, 2.6, 1);
};

TEST(StructureOfARoom, UnderACeilingWallsEndThere) {
    RoomWithADoor room;
    const auto wardrobe = room.upright(0.6, 0, 2, 0, 2.2, 1);
    const auto jamb = room.upright(0, 3.9, 4.4, 0, 1.9, 1);  // on the other side of the door
    const auto found = room.structure();
    for (const std::size_t p : {room.wall, room.beyond, jamb})
        EXPECT_EQ(found[p], Structure::wall) << p;
    EXPECT_EQ(found[wardrobe], Structure::none);
    EXPECT_EQ(found[room.roof], Structure::ceiling);
}

TEST(StructureOfARoom, WhatLiesFarOffInAWallsPlaneIsNoWall) {
    RoomWithADoor room;
    const auto cupboard = room.upright(0.02, 4.8, 6, 0, 1.9, 1);
    EXPECT_EQ(room.structure()[cupboard], Structure::none);
}

// Thin walls of a coarse map are sheets of cells that face both sides, here under a duct.
TEST(StructureOfARoom, WallsUnderADuctAreWalls) {
    RoomWithADoor room;
    const auto duct = room.ceiling(2, 0, 2.5, 4, 2.3);
    const auto side = room.upright(2, 0, 4, 2.3, 2.6, -1);
    const auto wall = room.upright(2, 0, 4, 0, 2.3, -1);
    const auto screen = room.upright(3, 0, 4, 0, 2.1, -1);
    for (const std::size_t p : {wall, screen}) room.turn_round(p, 2);
    const auto found = room.structure();
    for (const std::size_t p : {side, wall}) EXPECT_EQ(found[p], Structure::wall) << p;
    for (const std::size_t p : {duct, screen}) EXPECT_EQ(found[p], Structure::none) << p;
}

// Two rooms of a storey, x below and above 3, with a wall of both faces between them.
struct TwoRooms : Scene {
    std::size_t floor = level(0, 0, 6, 4, 3.1);
    std::size_t roof = ceiling(0, 0, 6, 4, 5.8);
    std::size_t wall = upright(3, 0, 2.5, 3.1, 5.8, 1, 0.12);  // up to the door
};

TEST(StructureOfAStorey, WallsBetweenRoomsAreWalls) {
    TwoRooms rooms;
    const auto lintel = rooms.upright(3, 2.5, 3.4, 5.15, 5.8, 1, 0.12);
    const auto rest = rooms.upright(3, 3.4, 4, 3.1, 4.9, 1);  // in the wall's plane
    const auto outer = rooms.upright(0, 0, 4, 3.1, 5.8, 1);
    rooms.ceiling(4, 1, 5.5, 2, 6.6);  // under a bench of the next storey
    const auto found = rooms.structure({{.floor_m = 3.1, .top_m = 6.0}});
    EXPECT_EQ(found[rooms.floor], Structure::floor);
    EXPECT_EQ(found[rooms.roof], Structure::ceiling);
    const auto beside = rooms.upright(3, 3.4, 4, 3.1, 5.15, 1, 0.12);  // up to the lintel
    const auto again = rooms.structure({{.floor_m = 3.1, .top_m = 6.0}});
    EXPECT_EQ(again[beside], Structure::wall);
    for (const std::size_t p : {rooms.wall, lintel, rest, outer})
        EXPECT_EQ(found[p], Structure::wall) << p;
}

TEST(StructureOfAStorey, FurnitureIsNone) {
    TwoRooms rooms;
    const auto wardrobe = rooms.upright(0.6, 0, 2, 3.1, 5.3, 1, 0.6);
    const auto front = rooms.upright(2.5, 0, 2, 3.1, 5.3, -1);  // of another, 40 cm before the wall
    const auto table = rooms.level(4, 1, 5.5, 2, 3.85);
    const auto under = rooms.ceiling(4, 1, 5.5, 2, 3.82);
    const auto top = rooms.level(0, 0, 0.6, 2, 5.3);
    const auto found = rooms.structure({{.floor_m = 3.1, .top_m = 6.0}});
    for (const std::size_t p : {wardrobe, front, table, under, top})
        EXPECT_EQ(found[p], Structure::none) << p;
}

// A block that sees no floor of its storey must not take a table top for it.
TEST(StructureOfAStorey, TheFloorMayBeOutOfSight) {
    Scene scene;
    const auto table = scene.level(0, 0, 2, 1, 3.85);
    EXPECT_EQ(scene.structure({{.floor_m = 3.1, .top_m = 6.0}})[table], Structure::none);
    EXPECT_EQ(scene.structure()[table], Structure::floor);
}

TEST(StructureOfAStorey, WithoutACeilingHighPlanesAreWalls) {
    Scene scene;
    scene.level(0, 0, 6, 4, 0);
    const auto wall = scene.upright(3, 0, 4, 0, 2.3, 1);
    const auto desk = scene.upright(1, 0, 3, 0, 0.75, 1);
    const auto found = scene.structure({{.floor_m = 0, .top_m = 3.0}});
    EXPECT_EQ(found[wall], Structure::wall);
    EXPECT_EQ(found[desk], Structure::none);
}

// Each with its own floor, ceiling and walls.
TEST(StructureOfAStorey, OneAboveTheOther) {
    TwoRooms rooms;  // the upper one
    const auto below = rooms.level(0, 0, 6, 4, 0.1);
    const auto under = rooms.ceiling(0, 0, 6, 4, 2.8);
    const auto wall = rooms.upright(2, 0, 2.5, 0.1, 2.8, 1, 0.12);
    const auto table = rooms.level(4, 1, 5.5, 2, 0.85);
    const auto found =
        rooms.structure({{.floor_m = 0.1, .top_m = 2.95}, {.floor_m = 3.1, .below_m = 2.95}});
    for (const std::size_t p : {rooms.floor, below}) EXPECT_EQ(found[p], Structure::floor) << p;
    for (const std::size_t p : {rooms.roof, under}) EXPECT_EQ(found[p], Structure::ceiling) << p;
    for (const std::size_t p : {rooms.wall, wall}) EXPECT_EQ(found[p], Structure::wall) << p;
    EXPECT_EQ(found[table], Structure::none);
}

}  // namespace
}  // namespace topple::geometry

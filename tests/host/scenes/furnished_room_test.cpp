// SPDX-License-Identifier: MIT
#include "scenes/furnished_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace topple::scenes {
namespace {

constexpr std::uint64_t seeds = 50;

World room(std::uint64_t seed) {
    return furnished_room({.seed = seed});
}

std::string name(const World& world, std::int32_t part) {
    const Part& p = world.parts[static_cast<std::size_t>(part)];
    return world.objects[static_cast<std::size_t>(p.object)].name + "/" + p.name + " #" +
           std::to_string(part);
}

TEST(FurnishedRoom, SolidsNeverOverlap) {
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const World world = room(seed);
        for (std::size_t a = 0; a < world.parts.size(); ++a) {
            for (std::size_t b = a + 1; b < world.parts.size(); ++b) {
                const auto p = world.parts[a].bounds(), q = world.parts[b].bounds();
                bool near = true;
                for (std::size_t k = 0; k < 3; ++k)
                    near = near && p[0][k] < q[1][k] - 1e-9 && q[0][k] < p[1][k] - 1e-9;
                if (!near) continue;
                EXPECT_GT(gap(world.parts[a], world.parts[b]), -1e-6)
                    << "seed " << seed << ": " << name(world, static_cast<std::int32_t>(a))
                    << " and " << name(world, static_cast<std::int32_t>(b));
            }
        }
    }
}

TEST(FurnishedRoom, FixedPartsTouch) {
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const World world = room(seed);
        for (const auto& [a, b] : world.fixed) {
            const double g = gap(world.parts[static_cast<std::size_t>(a)],
                                 world.parts[static_cast<std::size_t>(b)]);
            EXPECT_LT(std::abs(g), 1e-3)
                << "seed " << seed << ": " << name(world, a) << " and " << name(world, b);
        }
    }
}

// What is carried touches its supporter's top with the middle of its underside, and is nowhere
// lower.
TEST(FurnishedRoom, SupportHolds) {
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const World world = room(seed);
        for (const auto& [supporter, supported] : world.support) {
            const Part& below = world.parts[static_cast<std::size_t>(supporter)];
            const Part& above = world.parts[static_cast<std::size_t>(supported)];
            const std::string pair = name(world, supporter) + " under " + name(world, supported);
            EXPECT_NEAR(above.bottom(), below.top(), 1e-9) << "seed " << seed << ": " << pair;
            EXPECT_NEAR(below.distance({above.center[0], above.center[1], above.bottom()}), 0, 1e-9)
                << "seed " << seed << ": " << pair;
            EXPECT_NE(below.object, above.object);
        }
    }
}

// Every object but the room is held: by a support, or by a joint with a wall.
TEST(FurnishedRoom, NothingFloats) {
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const World world = room(seed);
        std::set<std::int32_t> held{0};
        for (const auto& pair : world.support)
            held.insert(world.parts[static_cast<std::size_t>(pair.second)].object);
        for (const auto& [a, b] : world.fixed) {
            const auto p = world.parts[static_cast<std::size_t>(a)].object,
                       q = world.parts[static_cast<std::size_t>(b)].object;
            if (p == 0) held.insert(q);
            if (q == 0) held.insert(p);
        }
        EXPECT_EQ(held.size(), world.objects.size()) << "seed " << seed;
    }
}

TEST(FurnishedRoom, PartsOfAnObjectAreJoined) {
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const World world = room(seed);
        std::vector<std::size_t> group(world.parts.size());
        for (std::size_t k = 0; k < group.size(); ++k) group[k] = k;
        const auto root = [&](std::size_t k) {
            while (group[k] != k) k = group[k];
            return k;
        };
        for (const auto& [a, b] : world.fixed)
            group[root(static_cast<std::size_t>(a))] = root(static_cast<std::size_t>(b));
        for (std::size_t a = 0; a < group.size(); ++a) {
            for (std::size_t b = 0; b < a; ++b) {
                if (world.parts[a].object == world.parts[b].object) {
                    EXPECT_EQ(root(a), root(b))
                        << "seed " << seed << ": " << name(world, static_cast<std::int32_t>(a));
                }
            }
        }
    }
}

TEST(FurnishedRoom, MiddleStaysFree) {
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const World world = room(seed);
        const auto middle = free_middle(world);
        for (double u = -1; u <= 1; u += 0.1) {
            for (double v = -1; v <= 1; v += 0.1) {
                for (const double z : {0.1, 0.5, 1.0, 1.5, 1.9}) {
                    const Vec3 p{world.room[0] / 2 + u * middle[0],
                                 world.room[1] / 2 + v * middle[1], z};
                    EXPECT_GT(world.distance(p).first, 0) << "seed " << seed;
                }
            }
        }
    }
}

TEST(FurnishedRoom, IsRichAndVaried) {
    std::set<std::string> names;
    std::set<Shape> shapes;
    std::size_t fewest = 1000, most = 0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const World world = room(seed);
        for (const TrueObject& object : world.objects) names.insert(object.name);
        for (const Part& part : world.parts) shapes.insert(part.shape);
        fewest = std::min(fewest, world.objects.size());
        most = std::max(most, world.objects.size());
    }
    EXPECT_GE(names.size(), 25u);
    EXPECT_EQ(shapes.size(), 5u);
    EXPECT_GE(fewest, 10u);
    EXPECT_GE(most, 2 * fewest);
}

TEST(FurnishedRoom, SameSeedSameRoomOtherSeedAnother) {
    const World a = room(7), b = room(7), c = room(8);
    ASSERT_EQ(a.parts.size(), b.parts.size());
    for (std::size_t k = 0; k < a.parts.size(); ++k) {
        EXPECT_EQ(a.parts[k].center, b.parts[k].center);
        EXPECT_EQ(a.parts[k].size, b.parts[k].size);
    }
    EXPECT_NE(a.room, c.room);
}

TEST(FurnishedRoom, TiltIsARotationByTheAngle) {
    const World world = furnished_room({.seed = 3, .tilt_deg = 20});
    const auto& t = world.tilt;
    EXPECT_NEAR((t[0] + t[4] + t[8] - 1) / 2, std::cos(20 * 3.14159265358979 / 180), 1e-12);
    const Vec3 p{1, 2, 3}, q = world.to_room(world.to_input(p));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(p[k], q[k], 1e-12);
}

}  // namespace
}  // namespace topple::scenes

// SPDX-License-Identifier: MIT
#include "topple/ask.h"

#include <cmath>
#include <numbers>

#include "errors.h"
#include "standard.h"
#include "topple/error.h"

// What falls without an object, what has to go before it, and what holds it.
namespace topple::test {
namespace {

using Ids = std::vector<std::int32_t>;
using Steps = std::vector<Ids>;
using ::testing::ElementsAre, ::testing::HasSubstr, ::testing::IsEmpty;

// Boxes as a parse would tell them: solid voxels of 2 cm, centres of mass, supports. Metres, z up.
struct AskedScene {
    Scene scene;

    AskedScene() {
        scene.voxel_size_m = voxel_m;
        for (std::size_t a = 0; a < 4; ++a) scene.manhattan_from_input[5 * a] = 1;
    }
    std::int32_t box(const Vec3& low, const Vec3& high, bool grounded = false) {
        const auto id = static_cast<std::int32_t>(scene.objects.size());
        Object& o = scene.objects.emplace_back();
        o.id = id;
        o.grounded = grounded;
        o.primitives = {id};
        Primitive& p = scene.primitives.emplace_back();
        p.id = p.object = id;
        for (std::size_t a = 0; a < 3; ++a) o.center_of_mass_m[a] = (low[a] + high[a]) / 2;
        part(id, low, high);
        return id;
    }
    void part(std::int32_t object, const Vec3& low, const Vec3& high) {
        const auto count = [&](std::size_t a) { return std::lround((high[a] - low[a]) / voxel_m); };
        for (long i = 0; i < count(0); ++i)
            for (long j = 0; j < count(1); ++j)
                for (long k = 0; k < count(2); ++k) {
                    const auto at = [&](double from, long n) {
                        return static_cast<float>(from + (static_cast<double>(n) + 0.5) * voxel_m);
                    };
                    scene.solid.x.push_back(at(low[0], i));
                    scene.solid.y.push_back(at(low[1], j));
                    scene.solid.z.push_back(at(low[2], k));
                    scene.solid.primitive.push_back(object);
                    scene.solid.object.push_back(object);
                    scene.solid.state.push_back(0);
                }
    }
    void carries(std::int32_t supporter, std::int32_t supported, double probability = 0.95) {
        scene.supports.push_back({supporter, supported, 0.01, probability});
    }
    std::int32_t floor() { return box({-1, -1, -0.02}, {1, 1, 0}, true); }

    FallsWithout without(const Ids& taken) const { return falls_without(scene, taken); }
    Ids falling(const Ids& taken) const {
        Ids out;
        for (const Unheld& one : without(taken).falls) out.push_back(one.object);
        return out;
    }
    // Turned about the vertical and put elsewhere, as scans lie.
    void turn(double degrees) {
        const double a = degrees * std::numbers::pi / 180;
        const auto turned = [&](const Vec3& p) {
            return Vec3{std::cos(a) * p[0] - std::sin(a) * p[1] + 3,
                        std::sin(a) * p[0] + std::cos(a) * p[1] - 5, p[2] + 0.7};
        };
        scene.manhattan_from_input = {
            std::cos(a), std::sin(a), 0, 0, -std::sin(a), std::cos(a), 0, 0, 0, 0, 1, 0,
            0,           0,           0, 1};
        for (Object& o : scene.objects) o.center_of_mass_m = turned(o.center_of_mass_m);
        for (std::size_t n = 0; n < scene.solid.x.size(); ++n) {
            const Vec3 at = turned({scene.solid.x[n], scene.solid.y[n], scene.solid.z[n]});
            scene.solid.x[n] = static_cast<float>(at[0]);
            scene.solid.y[n] = static_cast<float>(at[1]);
            scene.solid.z[n] = static_cast<float>(at[2]);
        }
    }

    static constexpr double voxel_m = 0.02;
};

// Objects 1 on the floor, 2 on 1, 3 on 2, and 4 beside them.
struct Stack : AskedScene {
    Stack() {
        floor();
        for (int n = 0; n < 3; ++n) {
            box({0, 0, 0.2 * n}, {0.2, 0.2, 0.2 * (n + 1)});
            carries(n, n + 1);
        }
        box({0.5, 0, 0}, {0.7, 0.2, 0.2});
        carries(0, 4);
    }
};

// A shelf, 4, as long as a metre on tables 1 and 2 at its ends, with a cup, 3, in its middle.
struct ShelfOnTables : AskedScene {
    ShelfOnTables() {
        floor();
        box({-0.5, 0, 0}, {-0.3, 0.2, 0.4});
        box({0.3, 0, 0}, {0.5, 0.2, 0.4});
        box({-0.04, 0.06, 0.44}, {0.04, 0.14, 0.54});
        box({-0.5, 0, 0.4}, {0.5, 0.2, 0.44});
        carries(0, 1);
        carries(0, 2);
        carries(1, 4);
        carries(2, 4);
        carries(4, 3);
    }
};

TEST(FallsWithout, AStackComesDownFromWhatIsTaken) {
    Stack stack;
    const FallsWithout one = stack.without({1});
    ASSERT_EQ(one.falls.size(), 2u);
    EXPECT_EQ(one.falls[0].object, 2);
    EXPECT_THAT(one.falls[0].lost, ElementsAre(1));
    EXPECT_THAT(one.falls[0].left, IsEmpty());
    EXPECT_TRUE(std::isnan(one.falls[0].beyond_m));
    EXPECT_EQ(one.falls[0].probability, 0.95);
    EXPECT_EQ(one.falls[0].reason, "Object 2 rests on object 1, and on nothing else");
    EXPECT_EQ(one.falls[1].reason, "Object 3 rests on object 2, and on nothing else");
    EXPECT_THAT(one.unsure, IsEmpty());
    EXPECT_THAT(stack.falling({2}), ElementsAre(3));
    EXPECT_THAT(stack.falling({3}), IsEmpty());
    EXPECT_THAT(stack.falling({4}), IsEmpty());
    EXPECT_THAT(stack.falling({2, 4}), ElementsAre(3));
    EXPECT_THAT(stack.falling({1, 2, 3}), IsEmpty()) << "what is taken does not fall";
    EXPECT_THAT(stack.falling({}), IsEmpty());
}

TEST(FallsWithout, NamesAndDoubtsAreTold) {
    Stack stack;
    stack.scene.objects[1].name = "crate";
    stack.scene.supports[1].probability = 0.62;
    EXPECT_EQ(stack.without({1}).falls.at(0).reason,
              "Object 2 rests on object 1 (crate), and on nothing else (62 % "
              "likely)");
}

TEST(FallsWithout, AShelfTipsWithoutOneOfTwoTables) {
    for (const double degrees : {0.0, 33.0}) {
        ShelfOnTables shelf;
        if (degrees > 0) shelf.turn(degrees);
        const FallsWithout one = shelf.without({2});
        ASSERT_EQ(one.falls.size(), 2u);
        EXPECT_EQ(one.falls[0].object, 4);
        EXPECT_THAT(one.falls[0].left, ElementsAre(1));
        EXPECT_NEAR(one.falls[0].beyond_m, 0.3, 1e-5) << "from its middle to the end of table 1";
        EXPECT_EQ(one.falls[0].reason,
                  "Object 4 loses object 2: its centre of mass lies 0.30 m outside of what is left "
                  "to stand on, object 1");
        EXPECT_EQ(one.falls[1].object, 3) << "the cup goes with the shelf, and so after it";
        EXPECT_THAT(shelf.falling({1, 2}), ElementsAre(4, 3));
        EXPECT_THAT(shelf.falling({3}), IsEmpty());
    }
}

TEST(FallsWithout, AThirdFootUnderTheMiddleIsEnough) {
    ShelfOnTables shelf;
    shelf.box({-0.1, 0, 0}, {0.1, 0.2, 0.4});
    shelf.carries(5, 4);
    EXPECT_THAT(shelf.falling({2}), IsEmpty());
    EXPECT_THAT(shelf.falling({5}), IsEmpty()) << "it spans from one to the other";
    EXPECT_THAT(shelf.falling({2, 5}), ElementsAre(4, 3));
}

// To half a voxel the border is not known.
TEST(FallsWithout, OnTheBorderItStays) {
    ShelfOnTables shelf;
    Vec3& center = shelf.scene.objects[4].center_of_mass_m;
    center[0] = -0.291;
    EXPECT_THAT(shelf.falling({2}), IsEmpty());
    center[0] = -0.289;
    EXPECT_THAT(shelf.falling({2}), ElementsAre(4, 3));
}

// A measured centre that is beyond all that was seen to carry it: it stood, all the same.
TEST(FallsWithout, WhatWasScannedStood) {
    ShelfOnTables shelf;
    shelf.scene.objects[4].center_of_mass_m[0] = -0.6;
    EXPECT_THAT(shelf.falling({2}), IsEmpty()) << "no further outside than with both";
    EXPECT_THAT(shelf.falling({1}), ElementsAre(4, 3));
}

TEST(FallsWithout, AGapThatNoiseLeavesIsAFoothold) {
    for (const double gap_m : {0.02, 0.06, 0.08}) {
        AskedScene scene;
        scene.floor();
        scene.box({0, 0, 0}, {0.2, 0.2, 0.2});
        scene.box({0, 0, 0.2 + gap_m}, {0.2, 0.2, 0.4});
        scene.carries(0, 1);
        scene.carries(1, 2);
        EXPECT_EQ(held_by(scene.scene, 2).at(0).from_below, gap_m < 0.07) << gap_m;
    }
}

// A picture on the wall, with a board below it: the wall holds it.
TEST(FallsWithout, WhatHangsOnTheBuildingStays) {
    AskedScene scene;
    const std::int32_t ground = scene.floor();
    scene.part(ground, {-1, 0.98, 0}, {1, 1, 2});
    const std::int32_t board = scene.box({0, 0, 0}, {0.4, 0.98, 0.8});
    const std::int32_t picture = scene.box({0.1, 0.94, 0.8}, {0.3, 0.98, 1.2});
    scene.carries(ground, board);
    scene.carries(ground, picture);
    scene.carries(board, picture);
    EXPECT_THAT(scene.falling({board}), IsEmpty());
    const std::vector<Holder> holders = held_by(scene.scene, picture);
    ASSERT_EQ(holders.size(), 2u);
    EXPECT_TRUE(holders[0].building);
    EXPECT_FALSE(holders[0].from_below);
    EXPECT_TRUE(holders[1].from_below);
}

// Cards that lean on each other, 2 and 3, on a box, 1.
struct Ring : AskedScene {
    explicit Ring(bool on_box = true) {
        floor();
        box({0, 0, 0}, {0.4, 0.4, 0.2});
        box({0.1, 0.1, 0.2}, {0.2, 0.3, 0.4});
        box({0.2, 0.1, 0.2}, {0.3, 0.3, 0.4});
        carries(0, 1);
        if (on_box) carries(1, 2);
        carries(2, 3);
        carries(3, 2);
    }
};

TEST(FallsWithout, ARingDoesNotHoldItself) {
    Ring ring;
    EXPECT_THAT(ring.falling({1}), ElementsAre(2, 3));
    EXPECT_THAT(ring.without({1}).falls.at(0).reason, HasSubstr("a ring that nothing else holds"));
    EXPECT_THAT(ring.falling({2}), ElementsAre(3));
    // Held by nothing that was seen: it was scanned so, and does not fall because of others.
    const Ring loose(false);
    EXPECT_THAT(loose.falling({1}), IsEmpty());
}

TEST(FallsWithout, WithoutVoxelsItGoesByTheSupportsAlone) {
    ShelfOnTables shelf;
    shelf.scene.solid = {};
    EXPECT_THAT(shelf.falling({2}), IsEmpty());
    EXPECT_THAT(shelf.falling({1, 2}), ElementsAre(4, 3));
    EXPECT_FALSE(held_by(shelf.scene, 4).at(0).from_below);
}

TEST(FallsWithout, WhatTouchesItAndIsHeldByNobodyKnowsWhatIsUnsure) {
    Stack stack;
    const std::int32_t beside = stack.box({0.2, 0, 0.1}, {0.3, 0.2, 0.3});
    stack.scene.contacts.push_back({.a = 1, .b = beside, .relation = "adjacent"});
    EXPECT_THAT(stack.without({1}).unsure, IsEmpty()) << "it rests by what was seen";
    stack.scene.objects[beside].rests_by = "leaning";
    EXPECT_THAT(stack.without({1}).unsure, ElementsAre(beside));
    EXPECT_THAT(stack.without({4}).unsure, IsEmpty());
    stack.scene.contacts.back() = {.a = beside, .b = 3, .relation = "adjacent"};
    EXPECT_THAT(stack.without({1}).unsure, ElementsAre(beside)) << "3 falls";
}

TEST(RemovalSteps, FromTheTop) {
    EXPECT_EQ(removal_steps(Stack().scene), (Steps{{3}, {4}, {2}, {1}}));
    EXPECT_EQ(removal_steps(ShelfOnTables().scene), (Steps{{3}, {4}, {1}, {2}}));
    EXPECT_EQ(removal_steps(Ring().scene), (Steps{{2, 3}, {1}}));
    AskedScene empty;
    EXPECT_THAT(removal_steps(empty.scene), IsEmpty());
    empty.floor();
    EXPECT_THAT(removal_steps(empty.scene), IsEmpty());
}

TEST(RemovalSteps, WhatHasToGoBeforeOne) {
    const Stack stack;
    EXPECT_EQ(removal_steps(stack.scene, 1), (Steps{{3}, {2}, {1}}));
    EXPECT_EQ(removal_steps(stack.scene, 4), (Steps{{4}}));
    EXPECT_EQ(removal_steps(ShelfOnTables().scene, 2), (Steps{{3}, {4}, {2}}));
    EXPECT_EQ(removal_steps(Ring().scene, 1), (Steps{{2, 3}, {1}}));
    EXPECT_EQ(removal_steps(Ring().scene, 2), (Steps{{2, 3}})) << "together";
}

// Each step carries nothing that is still there, and none of a pile as high as can be.
TEST(RemovalSteps, OfAHighPile) {
    AskedScene pile;
    constexpr std::int32_t count = 20'000;
    pile.scene.objects.resize(count);
    for (std::int32_t n = 0; n < count; ++n) {
        pile.scene.objects[n].id = n;
        if (n > 0) pile.carries(n - 1, n, 1);
    }
    pile.scene.objects[0].grounded = true;
    const Steps steps = removal_steps(pile.scene);
    ASSERT_EQ(steps.size(), count - 1u);
    for (std::size_t n = 0; n < steps.size(); ++n)
        ASSERT_EQ(steps[n], Ids{count - 1 - static_cast<std::int32_t>(n)});
    EXPECT_EQ(pile.falling({1}).size(), count - 2u);
}

TEST(HeldBy, TheLikeliestFirst) {
    ShelfOnTables shelf;
    shelf.scene.supports[2].probability = 0.6;  // of table 1
    const std::vector<Holder> holders = held_by(shelf.scene, 4);
    ASSERT_EQ(holders.size(), 2u);
    EXPECT_EQ(holders[0].object, 2);
    EXPECT_EQ(holders[0].probability, 0.95);
    EXPECT_EQ(holders[0].area_m2, 0.01);
    EXPECT_TRUE(holders[0].from_below);
    EXPECT_FALSE(holders[0].building);
    EXPECT_EQ(holders[1].object, 1);
    EXPECT_TRUE(held_by(shelf.scene, 1).at(0).building);
}

TEST(Ask, RefusesWhatIsNotThereOrNotTaken) {
    const Stack stack;
    const auto refused = [&](std::int32_t id, const std::string& why) {
        const std::string text = "object " + std::to_string(id) + ": " + why;
        EXPECT_THAT(message_of([&] { falls_without(stack.scene, {id}); }, ErrorKind::usage),
                    HasSubstr(text));
        EXPECT_THAT(message_of([&] { removal_steps(stack.scene, id); }, ErrorKind::usage),
                    HasSubstr(text));
        EXPECT_THAT(message_of([&] { held_by(stack.scene, id); }, ErrorKind::usage),
                    HasSubstr(text));
    };
    refused(5, "the scene has objects 0 to 4");
    refused(-1, "the scene has objects 0 to 4");
    refused(0, "it is the building, or fixed to it");
    EXPECT_THAT(message_of([] { held_by({}, 0); }, ErrorKind::usage), HasSubstr("no objects"));
}

}  // namespace
}  // namespace topple::test

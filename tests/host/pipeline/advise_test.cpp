// SPDX-License-Identifier: MIT
#include "safety/advise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "assessed_room.h"
#include "device/devices.h"
#include "safety/earthquake/earthquake_field.h"
#include "safety/human/human_field.h"
#include "safety/wind/wind_field.h"

namespace topple::test {
namespace {

constexpr double advice_friction = 0.3, advice_tolerable_J = 0.1;

// All fields of a room, and what is advised.
class Advice : public ::testing::Test {
  protected:
    std::vector<Suggestion> of(Room& room) {
        scene = std::make_unique<AssessedRoom>(*device, room, advice_friction);
        safety::HumanOptions walking;
        walking.paths = 200;
        std::vector<std::unique_ptr<safety::DisturbanceField>> walkers;
        walkers.push_back(
            std::make_unique<safety::HumanField>(*device, scene->around, scene->at_risk, walking));
        std::vector<safety::Disturbance> fields;
        fields.push_back(walkers.front()->disturbance());
        fields.push_back(safety::wind_field(*device, scene->around, scene->at_risk, {}));
        fields.push_back(
            safety::earthquake_field(*device, scene->around, scene->at_risk, advice_friction, {}));
        risk.clear();
        for (const auto& field : fields) risk.push_back(safety::risk(field, scene->at_risk));
        return advise(scene->solids, room.object_of_primitive, scene->objects, scene->at_risk,
                      fields, risk, walkers, advice_friction, advice_tolerable_J);
    }
    double worst(std::int32_t id) const {
        double most = 0;
        for (const auto& field : risk) most = std::max(most, field[id].mean_J);
        return most;
    }
    static const Suggestion& at(const std::vector<Suggestion>& all, std::int32_t id) {
        return all[id];
    }

    std::unique_ptr<device::Device> device = device::open_native(2);
    std::unique_ptr<AssessedRoom> scene;
    std::vector<std::vector<safety::Risk>> risk;
};

// A heavy flat box that overhangs nothing, 5 cm from the edge of a wide table.
std::int32_t box_on_table(Room& room, double x, double y = 0) {
    room.floor(-2, 2, -2, 2);
    room.box(-0.8, 0.8, -0.8, 0.8, 0.7, 0.75);
    return room.box(x, x + 0.2, y - 0.1, y + 0.1, 0.75, 0.9, false);
}

TEST_F(Advice, WhatIsAtAnEdgeIsMovedInwardsToWhereItIsTolerated) {
    Room room(0.025);
    const auto box = box_on_table(room, 0.575);
    const auto advice = of(room);
    ASSERT_GT(worst(box), advice_tolerable_J);
    const Suggestion& what = at(advice, box);
    ASSERT_EQ(what.kind, Suggestion::Kind::move);
    EXPECT_LT(what.move_m[0], -0.05) << "away from the edge at x = 0.8";
    EXPECT_LT(std::hypot(what.move_m[0], what.move_m[1]), 0.9);
    EXPECT_LE(what.risk_J, advice_tolerable_J);
    // It keeps what it promises: a box that stands there is tolerated.
    Room moved(0.025);
    const auto there = box_on_table(moved, 0.575 + what.move_m[0], what.move_m[1]);
    of(moved);
    EXPECT_LE(worst(there), advice_tolerable_J);
}

TEST_F(Advice, WhatIsSafeIsLeftAlone) {
    Room room(0.025);
    const auto box = box_on_table(room, -0.1);
    const auto advice = of(room);
    EXPECT_LE(worst(box), advice_tolerable_J);
    EXPECT_EQ(at(advice, box).kind, Suggestion::Kind::nothing);
}

TEST_F(Advice, ATallThinThingIsFixedAndTheFixingHoldsIt) {
    Room room(0.025);
    room.floor(-2, 2, -2, 2);
    const auto post = room.box(0, 0.15, 0, 0.15, 0, 1.5, false);
    const auto advice = of(room);
    ASSERT_GT(worst(post), advice_tolerable_J);
    const Suggestion& what = at(advice, post);
    ASSERT_EQ(what.kind, Suggestion::Kind::fix) << "shaking tips it anywhere";
    EXPECT_NEAR(what.hold.height_m, 1.5, 0.03);
    // 23.6 kg at up to 3 e m/s^2 tip it by (a h - g b) m over its height.
    const double mass = 700 * 0.15 * 0.15 * 1.5;
    EXPECT_GT(what.hold.force_N, mass * (3.0 * 0.75 - 9.80665 * 0.075) / 1.5);
    EXPECT_LT(what.hold.force_N, 1000);
}

TEST_F(Advice, WhatHangsOnNothingSeenIsToBeSeen) {
    Room room(0.025);
    room.floor(-2, 2, -2, 2);
    const auto lamp = room.box(0, 0.2, 0, 0.2, 1.5, 1.7, false);
    const auto advice = of(room);
    EXPECT_EQ(worst(lamp), 0);
    EXPECT_EQ(at(advice, lamp).kind, Suggestion::Kind::see);
}

// What is said to upset it would have done so before it was scanned.
TEST(StandsAgainstOdds, WhereTheScanIsReadOneWayOfSeveralOrItWouldNotHaveStood) {
    Body object;
    object.overturning.tilt_deg = 12;
    const auto doubted = [&](double walk, double quake) {
        std::vector<safety::Disturbance> disturbances(2);
        disturbances[0].name = "human";
        disturbances[1].name = "earthquake";
        const std::vector<std::vector<safety::Risk>> risk{{{1, 0, walk}}, {{1, 0, quake}}};
        return stands_against_odds(object, disturbances, risk, 0);
    };
    EXPECT_FALSE(doubted(0.01, 1)) << "it was not scanned in an earthquake";
    EXPECT_TRUE(doubted(0.1, 0));
    object.overturning.tilt_deg = 2;
    EXPECT_TRUE(doubted(0, 0));
    object.overturning.tilt_deg = std::nan("");
    EXPECT_FALSE(doubted(0, 0));
    object.rest_probability = 0.4;
    EXPECT_TRUE(doubted(0, 0));
    object.grounded = true;
    EXPECT_FALSE(doubted(0, 0));
}

}  // namespace
}  // namespace topple::test

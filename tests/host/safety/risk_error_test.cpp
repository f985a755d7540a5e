// SPDX-License-Identifier: MIT
#include "safety/risk_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "device/devices.h"
#include "physics/landscape.h"
#include "room.h"
#include "safety/earthquake/earthquake_field.h"
#include "safety/human/human_field.h"
#include "safety/objects.h"
#include "safety/wind/wind_field.h"

namespace topple::safety {
namespace {

// A post of b / h = 0.1, whose barrier is that of its edge.
RiskObject post() {
    RiskObject object;
    object.mass_kg = 10;
    object.base_m = 0;
    object.center = Vec3{0, 0, 1};
    object.height_m = 2;
    object.base_width_m = 0.2;
    object.barrier_J = tipping_energy(10, 1, 0.1);
    object.curve = {{object.barrier_J, 90}};
    return object;
}

TEST(RiskError, EndsHaveTheBarriersOfWiderAndNarrowerSupports) {
    RiskObject object = post();
    object.barrier_error_J = tipping_energy(10, 1, 0.12) - object.barrier_J;
    const RiskObject wider = at_end(std::span(&object, 1), 1)[0];
    EXPECT_NEAR(wider.border_shift_m, 0.02, 1e-9) << "the edge that is so much further out";
    EXPECT_NEAR(push_barrier_J(wider, {1, 0, 0}), tipping_energy(10, 1, 0.12), 1e-9);
    EXPECT_NEAR(half_base(wider, {}, 1, 0), 0.12, 1e-9);
    // What just upset it before does not now, and what has the energy does.
    EXPECT_EQ(instability(object, {object.barrier_J, 1, {1, 0, 0}}), 90);
    EXPECT_EQ(instability(wider, {object.barrier_J, 1, {1, 0, 0}}), 0);
    EXPECT_EQ(instability(wider, {push_barrier_J(wider, {1, 0, 0}), 1, {1, 0, 0}}), 90);
    const RiskObject narrower = at_end(std::span(&object, 1), -1)[0];
    EXPECT_NEAR(push_barrier_J(narrower, {1, 0, 0}), object.barrier_J - object.barrier_error_J,
                1e-9);
    EXPECT_EQ(instability(narrower, {0.99 * object.barrier_J, 1, {1, 0, 0}}), 90);
}

TEST(RiskError, BarriersDoNotFallBelowZeroAndMayRiseFromIt) {
    RiskObject object = post();
    object.barrier_error_J = 2 * object.barrier_J;
    const RiskObject narrower = at_end(std::span(&object, 1), -1)[0];
    EXPECT_EQ(push_barrier_J(narrower, {1, 0, 0}), 0);
    EXPECT_NEAR(half_base(narrower, {}, 1, 0), 0, 1e-12);
    EXPECT_EQ(instability(narrower, {0, 1, {1, 0, 0}}), 90) << "it falls by itself";
    object.barrier_J = 0;
    object.base_width_m = 0;
    object.curve = {{0, 90}};
    object.barrier_error_J = 0.3;
    const RiskObject wider = at_end(std::span(&object, 1), 1)[0];
    EXPECT_NEAR(push_barrier_J(wider, {1, 0, 0}), 0.3, 1e-12);
    EXPECT_EQ(instability(wider, {0.29, 1, {1, 0, 0}}), 0);
    EXPECT_EQ(instability(wider, {0.3, 1, {1, 0, 0}}), 90);
    // Without an error nothing changes, to the last bit.
    object.barrier_error_J = 0;
    EXPECT_EQ(at_end(std::span(&object, 1), 1)[0].root_shift, 0);
}

TEST(RiskError, SlidersSlideFurtherWithTheirBarrier) {
    RiskObject object = post();
    object.slides = true;
    object.slide_distance_m = 0.05;
    object.barrier_J = 0.3 * 10 * physics::gravity * 0.05;
    object.barrier_error_J = 0.2 * object.barrier_J;
    EXPECT_NEAR(slide_towards_m(at_end(std::span(&object, 1), 1)[0], {1, 0, 0}, 0), 0.06, 1e-12);
    EXPECT_NEAR(slide_towards_m(at_end(std::span(&object, 1), -1)[0], {1, 0, 0}, 0), 0.04, 1e-12);
}

TEST(RiskError, AddsItsPartsInSquares) {
    const Risk risk{2, 0.3, 0.1};
    EXPECT_DOUBLE_EQ(risk_error_J(risk, {risk, risk}, 0), 0.3);
    EXPECT_DOUBLE_EQ(risk_error_J(risk, {{2.8, 0, 0}, {2.0, 0, 0}}, 0), 0.5);
    EXPECT_DOUBLE_EQ(risk_error_J(risk, {{2.8, 0, 0}, {2.0, 0, 0}}, 0.6), 1.3);
}

// Each field tells what firmer and weaker things risk, and nothing else where they are as measured.
TEST(RiskError, FieldsTellTheRisksOfBothEnds) {
    const auto device = device::open_native(2);
    test::Room room(0.025);
    room.floor(0, 4, 0, 3);
    const auto thing = static_cast<std::size_t>(room.box(2, 2.2, 1, 1.2, 0, 1, false, 1000));
    RiskObject& object = room.objects[thing];
    object.base_m = 0;
    object.center = Vec3{2.1, 1.1, 0.5};
    object.barrier_J = tipping_energy(object.mass_kg, 0.5, 0.1);
    object.curve = {{object.barrier_J, 5}};
    object.barrier_error_J = 0.6 * object.barrier_J;
    const Surroundings around = room.surroundings();
    WindOptions gale;  // that just upsets it
    gale.speed_m_s = tipping_gusts(*device, around, room.objects, gale)[thing];
    EarthquakeOptions shaking;
    shaking.pga_m_s2 = 6;
    const Disturbance fields[] = {human_field(*device, around, room.objects, {}),
                                  wind_field(*device, around, room.objects, gale),
                                  earthquake_field(*device, around, room.objects, 0.6, shaking)};
    for (const Disturbance& field : fields) {
        const double measured = risk(field, room.objects)[thing].mean_J;
        EXPECT_DOUBLE_EQ(risk_if(field, room.objects)[thing].mean_J, measured) << field.name;
        const double weaker = risk_if(field, at_end(room.objects, -1))[thing].mean_J;
        const double firmer = risk_if(field, at_end(room.objects, 1))[thing].mean_J;
        EXPECT_GE(weaker, measured) << field.name;
        EXPECT_LE(firmer, measured) << field.name;
        EXPECT_GT(weaker, firmer) << field.name;
    }
}

}  // namespace
}  // namespace topple::safety

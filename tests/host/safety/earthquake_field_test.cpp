// SPDX-License-Identifier: MIT
#include "safety/earthquake/earthquake_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "device/devices.h"
#include "physics/landscape.h"
#include "room.h"
#include "safety/columns.h"
#include "safety/fields.h"
#include "safety/objects.h"
#include "topple/error.h"

namespace topple::safety {
namespace {

using physics::gravity;
constexpr double mu = 0.3;

RiskObject block(double mass = 1) {
    RiskObject object;
    object.mass_kg = mass;
    return object;
}

// A rectangle of half base b and half height h.
Profile rectangle(double b, double h) {
    return {b, b, h, std::sqrt((b * b + h * h) / 3)};
}

TEST(Earthquake, RockingStartsWhereWestSaysAndOnlyBelowTheFrictionAngle) {
    const double b = 0.05, h = 0.25, west = gravity * b / h;
    const auto work = [](double base, double height, double a) {
        return pulse_work(block(), rectangle(base, height), a, mu, 0.25);
    };
    EXPECT_EQ(work(b, h, 0.999 * west), 0);
    EXPECT_GT(work(b, h, 1.001 * west), 0);
    // b / h >= mu: it slides instead, and only beyond mu g, however small the work to tip it is.
    EXPECT_EQ(work(0.31 * h, h, 0.999 * mu * gravity), 0);
    const double sliding = work(0.31 * h, h, 1.2 * mu * gravity);
    EXPECT_EQ(sliding, work(10 * h, h, 1.2 * mu * gravity));
    EXPECT_GT(sliding, 0);
}

// The pulse that just overturns: p t = ln(eta / (eta - 1)) (Housner 1963), at small slenderness
// angles.
TEST(Earthquake, OverturnsAtHousnersPulse) {
    const double alpha = 0.05, h = 1.0, b = h * std::tan(alpha);
    const double p = std::sqrt(3 * gravity / (4 * std::hypot(b, h)));
    for (const double eta : {1.1, 1.5, 2.0, 4.0}) {
        double low = 0, high = 10;
        for (int n = 0; n < 100; ++n) {
            const double t = (low + high) / 2;
            const bool falls = pulse_work(block(), rectangle(b, h), eta * gravity * b / h, mu, t) >=
                               tipping_energy(1, h, b);
            (falls ? high : low) = t;
        }
        EXPECT_NEAR(p * high, std::log(eta / (eta - 1)), 1e-3 * std::log(eta / (eta - 1)))
            << "eta " << eta;
    }
}

TEST(Earthquake, SlidingWorkMatchesIntegration) {
    const double a = 5, t1 = 0.25, dt = 1e-6;
    double v = 0, ground = 0, slip = 0;  // velocities, relative distance
    for (double t = 0; t < 3; t += dt) {
        ground += (t < t1 ? a : 0) * dt;
        v = std::min(ground, v + mu * gravity * dt);
        slip += (ground - v) * dt;
    }
    const double work = pulse_work(block(2), rectangle(1, 0.1), a, mu, t1);
    EXPECT_NEAR(work, mu * 2 * gravity * slip, 1e-3 * work);
}

// A motion that does not go over an edge, or off the support, stays below the barrier, however much
// energy it has.
TEST(Earthquake, WorkReachesTheBarrierExactlyWhereItFalls) {
    RiskObject object = block(2);
    object.barrier_J = 0.01;
    const Profile tall = rectangle(0.05, 0.5);
    Profile squat = rectangle(1, 0.1);
    EXPECT_LT(pulse_work(object, squat, 8, mu, 0.25), 0.01) << "slides on a floor without an edge";
    const double way = pulse_work(block(2), squat, 8, mu, 0.25) / (mu * 2 * gravity);
    object.slide_distance_m = 0.99 * way;
    EXPECT_GE(pulse_work(object, squat, 8, mu, 0.25), 0.01);
    object.slide_distance_m = 1.01 * way;
    EXPECT_LT(pulse_work(object, squat, 8, mu, 0.25), 0.01);
    object.slide_distance_m = 0.1 * way;
    squat.support_ahead_m = 1.01 * way;
    EXPECT_LT(pulse_work(object, squat, 8, mu, 0.25), 0.01) << "the near edge is another";
    squat.support_ahead_m = 0.99 * way;
    EXPECT_GE(pulse_work(object, squat, 8, mu, 0.25), 0.01);
    object.slide_distance_m = -1;
    EXPECT_LT(pulse_work(object, tall, 1.2, mu, 0.25), 0.01) << "rocks";
    object.barrier_J = 1e9;
    EXPECT_EQ(pulse_work(object, tall, 9, mu, 2), 1e9) << "overturns";
}

TEST(Earthquake, TippingEnergyOfTheBox) {
    EXPECT_NEAR(tipping_energy(21, 0.25, 0.10), 3.96604, 1e-4);
    EXPECT_NEAR(tipping_energy(21, 0.25, 0.15), 8.55630, 1e-4);
}

class EarthquakeField : public ::testing::Test {
  protected:
    double risk_of(double width, double height, double pga) {
        test::Room room(0.02);
        room.floor(0, 2, 0, 2);
        const auto id = static_cast<std::size_t>(
            room.box(1 - width / 2, 1 + width / 2, 1 - width / 2, 1 + width / 2, 0, height, false));
        auto& object = room.objects[id];
        object.barrier_J = tipping_energy(object.mass_kg, height / 2, width / 2);
        object.curve = {{object.barrier_J, 10}};
        EarthquakeOptions options;
        options.pga_m_s2 = pga;
        return risk(earthquake_field(*device, room.surroundings(), room.objects, mu, options),
                    room.objects)[id]
            .mean_J;
    }
    std::unique_ptr<device::Device> device = device::open_native(1);
};

TEST_F(EarthquakeField, TallerNarrowerStrongerIsNotSafer) {
    double last = 0;
    for (const double pga : {0.5, 1.0, 2.0, 4.0, 8.0}) {
        const double r = risk_of(0.12, 0.6, pga);
        EXPECT_GE(r, last) << "pga " << pga;
        last = r;
    }
    EXPECT_GT(last, 0);
    EXPECT_EQ(risk_of(0.12, 0.6, 0), 0);
    last = 0;
    for (const double height : {0.2, 0.4, 0.6, 0.8}) {
        const double r = risk_of(0.12, height, 3);
        EXPECT_GE(r, last) << "height " << height;
        last = r;
    }
    last = 0;
    for (const double width : {0.32, 0.24, 0.16, 0.08}) {
        const double r = risk_of(width, 0.6, 3);
        EXPECT_GE(r, last) << "width " << width;
        last = r;
    }
}

TEST_F(EarthquakeField, SameSeedSameEvents) {
    test::Room room(0.02);
    room.floor(0, 1, 0, 1);
    room.thing(0.5, 0.5, 0);
    const auto surroundings = room.surroundings();
    EarthquakeOptions options;
    const auto a = earthquake_field(*device, surroundings, room.objects, mu, options);
    const auto b = earthquake_field(*device, surroundings, room.objects, mu, options);
    ASSERT_EQ(a.work[1].size(), 64u);
    EXPECT_TRUE(a.work[0].empty()) << "the floor is grounded";
    EXPECT_NEAR(test::total_probability(a.work[1]), 1, 1e-12);
    bool other = false;
    options.seed = 2;
    const auto c = earthquake_field(*device, surroundings, room.objects, mu, options);
    for (std::size_t n = 0; n < 64; ++n) {
        EXPECT_EQ(a.work[1][n].W_J, b.work[1][n].W_J);
        other = other || a.work[1][n].direction != c.work[1][n].direction;
    }
    EXPECT_TRUE(other);
    EXPECT_FALSE(a.samples.x.empty());
    options.pga_m_s2 = std::nan("");
    EXPECT_THROW(earthquake_field(*device, surroundings, room.objects, mu, options), Error);
}

TEST_F(EarthquakeField, SupportPolygonGivesTheBaseEachWay) {
    RiskObject object;
    object.base_width_m = 99;
    object.support_polygon = {{0, 0}, {0.4, 0}, {0.4, 0.2}, {0, 0.2}};
    Stance stands;
    stands.center = {0.1, 0.1, 0};
    EXPECT_NEAR(half_base(object, stands, 1, 0), 0.3, 1e-12);
    EXPECT_NEAR(half_base(object, stands, -1, 0), 0.1, 1e-12);
    EXPECT_NEAR(half_base(object, stands, 0, 1), 0.1, 1e-12);
    EXPECT_NEAR(half_base(object, stands, std::sqrt(0.5), std::sqrt(0.5)), 0.1 * std::sqrt(2),
                1e-12);
    stands.center = {-0.1, 0.1, 0};  // hangs over
    EXPECT_EQ(half_base(object, stands, -1, 0), 0);
}

// A box on a table, nearer to one end.
TEST_F(EarthquakeField, SupportGoesOnUntilTheTableEnds) {
    test::Room room(0.02);
    room.floor(0, 3, 0, 3);
    room.box(1, 2, 1, 2, 0.68, 0.7);
    const auto id = static_cast<std::size_t>(room.thing(1.14, 1.5, 0.7));
    const auto surroundings = room.surroundings();
    const auto cells =
        cells_of_objects(movable_object_of_cells(surroundings, room.objects), room.objects.size());
    const Stance stands = stance(surroundings, cells[id]);
    const Columns columns(*surroundings.cells);
    EXPECT_NEAR(support_reach(stands, columns, -1, 0), 0.14, 0.011);
    EXPECT_NEAR(support_reach(stands, columns, 1, 0), 0.86, 0.011);
    EXPECT_NEAR(support_reach(stands, columns, 0, 1), 0.5, 0.011);
    EXPECT_NEAR(support_reach(stands, columns, -0.6, 0.8), 0.14 / 0.6, 0.02);
}

TEST_F(EarthquakeField, NothingToShake) {
    test::Room room(0.02);
    auto field = earthquake_field(*device, room.surroundings(), room.objects, mu, {});
    EXPECT_TRUE(field.work.empty());
    EXPECT_FALSE(field.notes.empty());
}

}  // namespace
}  // namespace topple::safety

// SPDX-License-Identifier: MIT
#include "safety/wind/wind_field.h"

#include "device/devices.h"
#include "physics/directions.h"
#include "room.h"
#include "safety/columns.h"
#include "safety/objects.h"
#include "testing.h"

namespace topple::safety {
namespace {

class WindField : public ::testing::Test {
  protected:
    std::unique_ptr<device::Device> device = device::open_native(1);

    // The load of wind along +x on an object of the room.
    WindLoad load(test::Room& room, std::int32_t id, unsigned d = 0) {
        const auto surroundings = room.surroundings();
        const auto cells = cells_of_objects(movable_object_of_cells(surroundings, room.objects),
                                            room.objects.size());
        const auto& own = cells[id];
        const Columns columns(*surroundings.cells);
        const Frontage front = wind_frontage(*surroundings.cells, columns, own, direction(d), 1.0);
        const MassSpread stands = stance(surroundings, own, room.objects[id]);
        return {front.area_m2, front.center_m - stands.bottom_m, room.objects[id].base_width_m / 2,
                stands.height()};
    }
};

// Speed at which the work reaches the barrier.
double critical_speed(const RiskObject& object, const WindLoad& load, WindOptions options) {
    double low = 0, high = 1000;
    for (int n = 0; n < 100; ++n) {
        options.speed_m_s = (low + high) / 2;
        (wind_work(object, load, options) >= object.barrier_J ? high : low) = options.speed_m_s;
    }
    return high;
}

TEST_F(WindField, ClosedFormsOfTheBox) {
    test::Room room(0.01);
    const auto id = room.box(0, 0.2, 0, 0.3, 0, 0.5, false);
    const WindLoad across = load(room, id);
    EXPECT_NEAR(across.area_m2, 0.15, 1e-9);
    EXPECT_NEAR(across.pressure_height_m, 0.25, 1e-9);
    WindOptions options;
    RiskObject& box = room.objects[0];
    box.barrier_J = 3.96604;
    // v = sqrt(2 rho g d^2 / (rho_air C_d h)) and sqrt(2 mu m g / (rho_air C_d A)).
    for (const double air : {1.2, 1.225}) {
        options.air_density_kg_m3 = air;
        box.base_width_m = 0.2;
        box.slide_distance_m = -1;
        box.friction = 0.5;
        const double tips = critical_speed(box, across, options);
        EXPECT_NEAR(tips, std::sqrt(2 * 700 * 9.80665 * 0.04 / (air * 1.3 * 0.5)), 1e-6);
        EXPECT_NEAR(tips, 26.26, 0.02 * 26.26);
        box.slide_distance_m = 0.3;
        box.friction = 0.3;
        const double slides = critical_speed(box, across, options);
        EXPECT_NEAR(slides, std::sqrt(2 * 0.3 * 21 * 9.80665 / (air * 1.3 * 0.15)), 1e-6);
        EXPECT_NEAR(slides, 22.74, 0.02 * 22.74);
    }
    // On a smooth floor it slides before it tips. Blown at above its centre it tips on the way once
    // F (p - h) > m g (b - mu h), which is where its inertia lags behind.
    box.slide_distance_m = -1;
    WindLoad high = across;
    EXPECT_LT(wind_work(box, high, options), 1e-9) << "it glides away";
    high.pressure_height_m = 0.3;
    const double force = 21 * 9.80665 * (0.1 - 0.3 * 0.25) / 0.05;
    EXPECT_NEAR(critical_speed(box, high, options), std::sqrt(2 * force / (1.225 * 1.3 * 0.15)),
                1e-6);
}

// A box tips at sqrt(2 m g (d / 2) / (h / 2) / (rho C_d w h)), over its long
// side.
TEST_F(WindField, GustThatTipsTheBox) {
    test::Room room(0.01, {-1, -1}, {1, 1});
    const auto id = static_cast<std::size_t>(room.box(0, 0.2, 0, 0.3, 0, 0.5, false));
    RiskObject& box = room.objects[id];
    box.support_polygon = {{0, 0}, {0.2, 0}, {0.2, 0.3}, {0, 0.3}};
    const auto gusts = tipping_gusts(*device, room.surroundings(), room.objects, {});
    EXPECT_TRUE(std::isnan(gusts[0]));
    const double q = std::numbers::pi / 8, wide = 0.3 * std::cos(q) + 0.2 * std::sin(q);
    EXPECT_NEAR(gusts[id],
                std::sqrt(2 * 21 * 9.80665 * 0.4 / std::cos(q) / (1.2 * 1.3 * 0.5 * wide)), 0.1);
    // A field of wind from all sides has them, too, and none of one side.
    WindOptions options;
    EXPECT_EQ(wind_field(*device, room.surroundings(), room.objects, options).gust_m_s[id],
              gusts[id]);
    options.from_deg = 90;
    EXPECT_TRUE(wind_field(*device, room.surroundings(), room.objects, options).gust_m_s.empty());
}

TEST_F(WindField, FrontageFromAllSides) {
    test::Room room(0.01);
    const auto id = room.box(0, 0.2, 0, 0.3, 0, 0.5, false);
    for (unsigned d = 0; d < direction_count; ++d) {
        const auto [dx, dy] = direction(d);
        const double area = 0.5 * (0.3 * std::fabs(dx) + 0.2 * std::fabs(dy));
        EXPECT_NEAR(load(room, id, d).area_m2, area, 0.05 * area) << "direction " << d;
    }
}

TEST_F(WindField, WorkGrowsWithSpeedAndReachesTheBarrierAtTheThreshold) {
    test::Room room(0.02);
    const auto id = room.box(0, 0.2, 0, 0.3, 0, 0.5, false);
    const WindLoad front = load(room, id);
    RiskObject& box = room.objects[0];
    box.barrier_J = 2;
    box.slide_distance_m = 1;
    WindOptions options;
    double last = 0;
    const double critical = critical_speed(box, front, options);
    for (double v = 0; v < 60; v += 0.25) {
        options.speed_m_s = v;
        const double work = wind_work(box, front, options);
        EXPECT_GE(work, last) << v;
        EXPECT_EQ(work >= box.barrier_J, v >= critical) << v;
        if (v < critical) {
            EXPECT_LT(work - last, 0.1) << "a jump at " << v;
        }
        last = work;
    }
}

TEST_F(WindField, ShelteredFromWhereAWallStands) {
    test::Room room(0.02, {-2, -2}, {3, 3});
    const auto cup = room.thing(0.5, 0.5, 0, 0.1, 0.2);
    const double open = load(room, cup, 0).area_m2;
    EXPECT_NEAR(open, 0.02, 1e-9);
    room.box(0.0, 0.1, -1, 2, 0, 1);  // 0.35 m upwind
    EXPECT_EQ(load(room, cup, 0).area_m2, 0) << "in the lee";
    EXPECT_NEAR(load(room, cup, 8).area_m2, open, 1e-9) << "from the other side";
    const auto field = wind_field(*device, room.surroundings(), room.objects, {});
    EXPECT_LT(test::total_probability(field.work[cup]), 0.99);
    EXPECT_GT(test::total_probability(field.work[cup]), 0.4);
    EXPECT_FALSE(field.samples.x.empty());
    test::Room far(0.02);
    const auto same = far.thing(0.5, 0.5, 0, 0.1, 0.2);
    far.box(-1.2, -1.1, -1, 2, 0, 1);  // further upwind than the lee is long
    EXPECT_NEAR(load(far, same, 0).area_m2, open, 1e-9);
}

// A wall shelters from one side only; degrees clockwise from north, where the wind comes from.
TEST_F(WindField, OneWindComesFromWhereItIsSaidTo) {
    test::Room room(0.02, {-2, -2}, {3, 3});
    const auto cup = static_cast<std::size_t>(room.thing(0.5, 0.5, 0, 0.1, 0.2));
    room.box(0.9, 1.0, -1, 2, 0, 1);  // to the east
    const auto from = [&](double degrees) {
        WindOptions options;
        options.from_deg = degrees;
        return wind_field(*device, room.surroundings(), room.objects, options);
    };
    for (const double degrees : {0.0, 180.0, 270.0, 301.7, -45.0, 630.0}) {
        const Disturbance field = from(degrees);
        EXPECT_EQ(field.draws, 1u);
        ASSERT_EQ(field.work[cup].size(), 1u) << degrees;
        EXPECT_EQ(field.work[cup][0].probability, 1);
        const double angle = degrees * std::acos(-1.0) / 180;
        EXPECT_NEAR(field.work[cup][0].direction[0], -std::sin(angle), 1e-12) << degrees;
        EXPECT_NEAR(field.work[cup][0].direction[1], -std::cos(angle), 1e-12) << degrees;
    }
    EXPECT_TRUE(from(90).work[cup].empty()) << "in the lee";
    // The mean over the 16 directions is the field without one.
    const auto mean = [&](const Disturbance& field) {
        double sum = 0;
        for (const WorkSample& s : field.work[cup]) sum += s.W_J * s.probability;
        return sum;
    };
    double sum = 0;
    for (unsigned d = 0; d < direction_count; ++d) sum += mean(from(22.5 * d)) / direction_count;
    const double all = mean(wind_field(*device, room.surroundings(), room.objects, {}));
    EXPECT_NEAR(sum, all, 1e-9 * all);
    EXPECT_GT(all, 0);
}

// In the lee of a wall there is none; elsewhere it blows as it was said to.
TEST_F(WindField, OverSpaceIsAllButTheLeeOfAWall) {
    test::Room room(0.025, {-2, -2}, {3, 3});
    room.box(0.5, 0.6, -2, 3, 0, 1);
    WindOptions options;
    options.from_deg = 270;  // along +x
    options.over_space = true;
    const auto field = wind_field(*device, room.surroundings(), room.objects, options).space;
    ASSERT_TRUE(field);
    const auto blows = [&](double x, double z) {
        const std::array<double, 3> at{x, 0.52, z};
        std::array<std::int32_t, 3> cell{};
        for (std::size_t a = 0; a < 3; ++a)
            cell[a] = static_cast<std::int32_t>(
                std::floor((at[a] - field->corner_m[a]) / field->along_m[a][a]));
        return std::ranges::binary_search(field->cell, cell);
    };
    EXPECT_TRUE(blows(0.3, 0.5)) << "before the wall";
    EXPECT_FALSE(blows(0.55, 0.5)) << "in the wall";
    for (const double x : {0.7, 1.0, 1.4}) EXPECT_FALSE(blows(x, 0.5)) << x;
    EXPECT_TRUE(blows(1.8, 0.5)) << "where the lee ends";
    for (std::size_t n = 0; n < field->size(); ++n) {
        ASSERT_EQ(field->frequency[n], 1);
        ASSERT_NEAR(field->velocity_m_s[n][0], 12, 1e-5);
        ASSERT_NEAR(field->energy[n], 0.5 * 1.2 * 144, 1e-3);
    }
    EXPECT_EQ(field->energy_unit, "J/m^3");
}

TEST_F(WindField, BlowsInClosedRoomsWhereItIsAskedFor) {
    test::Room room(0.02, {-2, -2}, {3, 3});
    const auto cup = static_cast<std::size_t>(room.thing(0.5, 0.5, 0, 0.1, 0.2));
    Surroundings around = room.surroundings();
    const auto works = [&](const ParseOptions& asked) {
        return !wind_kind().field(*device, around, room.objects, asked).work[cup].empty();
    };
    ParseOptions only, strong, from_one_side;
    only.disturbances = {"wind"};
    strong.wind_m_s = 20;
    from_one_side.wind_from_deg = 90;
    EXPECT_TRUE(works({}));
    around.below_ceiling = true;
    EXPECT_FALSE(works({}));
    EXPECT_FALSE(wind_kind().field(*device, around, room.objects, {}).notes.empty());
    EXPECT_TRUE(works(only));
    EXPECT_TRUE(works(strong));
    EXPECT_TRUE(works(from_one_side));
}

TEST_F(WindField, NothingInTheWind) {
    test::Room room(0.02);
    const auto empty = wind_field(*device, room.surroundings(), room.objects, {});
    EXPECT_TRUE(empty.notes.empty()) << "that nothing was judged is said once for all";
    room.floor(0, 1, 0, 1);
    const auto field = wind_field(*device, room.surroundings(), room.objects, {});
    EXPECT_TRUE(field.work[0].empty());
    EXPECT_TRUE(field.notes.empty());
}

}  // namespace
}  // namespace topple::safety

// SPDX-License-Identifier: MIT
#include "device/devices.h"
#include "physics/landscape.h"
#include "room.h"
#include "safety/action.h"
#include "safety/earthquake/earthquake_field.h"
#include "safety/human/convolution.h"
#include "safety/human/human_field.h"
#include "safety/largest_risk.h"
#include "safety/objects.h"
#include "safety/risk_error.h"
#include "safety/unsafety_category.h"
#include "safety/wind/wind_field.h"
#include "testing.h"

namespace topple::safety {
namespace {

TEST(Risk, SumsReleaseOverTheWorkDistribution) {
    RiskObject cup;
    cup.curve = {{0.1, 2}, {0.5, 5}};
    Disturbance field;
    field.name = "human";
    field.draws = 100;
    field.work = {
        {{0.05, 0.5, {}}, {0.1, 0.2, {}}, {0.4, 0.1, {}}, {0.5, 0.01, {}}, {9, 0.001, {}}}};
    const auto got = risk(field, std::span(&cup, 1));
    ASSERT_EQ(got.size(), 1u);
    const double mean = 0.2 * 2 + 0.1 * 2 + 0.01 * 5 + 0.001 * 5;
    EXPECT_DOUBLE_EQ(got[0].mean_J, mean);
    EXPECT_DOUBLE_EQ(got[0].chance, 0.311);
    EXPECT_DOUBLE_EQ(got[0].spread_J, std::sqrt((0.3 * 4 + 0.011 * 25 - mean * mean) / 100));
    cup.grounded = true;
    EXPECT_EQ(risk(field, std::span(&cup, 1))[0].mean_J, 0);
}

TEST(Risk, UnsafetyRunsFromOneToTen) {
    const std::vector<std::vector<Risk>> risks{{{}, {1e-3}, {0.5}}, {{}, {2e-3}, {0.1}}};
    const auto got = unsafety(risks);
    ASSERT_EQ(got.size(), 3u);
    EXPECT_DOUBLE_EQ(got[0], 1);
    EXPECT_GT(got[1], 1);
    EXPECT_LT(got[1], 10);
    EXPECT_DOUBLE_EQ(got[2], 10);
    const std::vector<std::vector<Risk>> none{{{}, {}}};
    EXPECT_EQ(unsafety(none), (std::vector<double>{1, 1}));
    EXPECT_TRUE(unsafety({}).empty());
}

// What is struck takes over all of the energy: it is as heavy, and gives back all.
std::vector<WorkSample> strikes_of(const Strikes& strikes, std::vector<double> energy) {
    SecondaryMotion motion;
    motion.mass_kg.assign(energy.size(), 2);
    motion.energy_J = std::move(energy);
    RiskObject thing;
    thing.mass_kg = 2;
    thing.curve = {{0, 1}};
    return strongest_strikes(strikes, motion, thing, {0, 0.8}, 1);
}

TEST(Risk, OneWalkStrikesOnceAndMostlyHard) {
    Strikes strikes(8);
    strikes[0][3][0] = 0.5;  // the strongest
    strikes[1][0][0] = 0.6;
    strikes[1][8][0] = 0.6;
    const auto samples = strikes_of(strikes, {8, 2, 1, 1, 1, 1, 1, 1});
    ASSERT_EQ(samples.size(), 3u);
    EXPECT_DOUBLE_EQ(samples[0].W_J, 8);
    EXPECT_DOUBLE_EQ(samples[0].probability, 0.5);
    // Missed by the first, and struck from either side: 0.5 (1 - 0.4 * 0.4), shared evenly.
    EXPECT_NEAR(samples[1].probability, 0.21, 1e-12);
    EXPECT_NEAR(samples[2].probability, 0.21, 1e-12);
    EXPECT_NEAR(samples[1].direction[0], -samples[2].direction[0], 1e-12);
    for (const WorkSample& sample : samples) EXPECT_DOUBLE_EQ(sample.height_m, 0.05);
}

// A pass meets a thing in one of the places that it sweeps, as often as each is swept.
TEST(Risk, OnePassStrikesAtOneHeight) {
    Strikes strikes(8);
    for (auto& level : strikes) {
        for (auto& heights : level) {
            heights[2] = 0.01;
            heights[5] = 0.005;
        }
    }
    const auto samples = strikes_of(strikes, {8, 7, 6, 5, 4, 3, 2, 1});
    EXPECT_EQ(samples.size(), 256u);
    double sum = 0, low = 0;
    for (const auto& s : samples) {
        sum += s.probability;
        if (s.height_m < 0.4) low += s.probability;
    }
    EXPECT_NEAR(sum, 1 - std::pow(0.99, 128), 1e-12);
    EXPECT_NEAR(low, 2 * sum / 3, 1e-12);
}

// Of a weak strike that overturns it and a strong one that does not, the weak one counts.
TEST(Risk, OfAWalksStrikesTheOneThatDoesMostCounts) {
    Strikes strikes(2);
    strikes[0][0][0] = strikes[1][0][7] = 0.5;
    const auto samples = strikes_of(strikes, {8, 2});
    ASSERT_EQ(samples.size(), 2u);
    EXPECT_DOUBLE_EQ(samples[0].W_J, 8);
    EXPECT_DOUBLE_EQ(samples[0].probability, 0.5);
    EXPECT_DOUBLE_EQ(samples[1].probability, 0.25);
}

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
    test::Room room(0.025, {0, 0}, {4, 3});
    const auto thing = static_cast<std::size_t>(room.box(2, 2.2, 1, 1.2, 0, 1, false, 1000));
    RiskObject& object = room.objects[thing];
    object.base_m = 0;
    object.center = Vec3{2.1, 1.1, 0.5};
    object.barrier_J = tipping_energy(object.mass_kg, 0.5, 0.1);
    object.curve = {{object.barrier_J, 5}};
    object.barrier_error_J = 0.6 * object.barrier_J;
    object.friction = 0.6;
    const Surroundings around = room.surroundings();
    WindOptions gale;  // that just upsets it
    gale.speed_m_s = tipping_gusts(*device, around, room.objects, gale)[thing];
    EarthquakeOptions shaking;
    shaking.pga_m_s2 = 6;
    const Disturbance fields[] = {human_field(*device, around, room.objects, {}),
                                  wind_field(*device, around, room.objects, gale),
                                  earthquake_field(*device, around, room.objects, shaking)};
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

TEST(LargestRisk, is_by_one_of_the_kinds) {
    Object o;
    EXPECT_EQ(largest_risk(o).kind, nullptr);
    o.risk_J = {{"human", 0}, {"wind", std::numeric_limits<double>::quiet_NaN()}};
    EXPECT_EQ(largest_risk(o).kind, nullptr);
    EXPECT_EQ(largest_risk(o).risk_J, 0);
    o.risk_J = {{"earthquake", 2}, {"human", 3}, {"wind", 3}, {"flood", 9}};
    ASSERT_NE(largest_risk(o).kind, nullptr);
    EXPECT_STREQ(largest_risk(o).kind->name, "human");
    EXPECT_EQ(largest_risk(o).risk_J, 3);
}

// The table of docs/output.md, by rows from likely to rare and columns from negligible to deadly.
TEST(UnsafetyCategory, IsTheTable) {
    constexpr Category none = Category::none, low = Category::low, medium = Category::medium,
                       high = Category::high;
    const double chances[] = {0.1, 0.01, 0.001, 0.0009, 0};
    const double energies[] = {0.99, 1, 15, 79};
    const Category expected[5][4] = {{none, medium, high, high},
                                     {none, low, medium, high},
                                     {none, low, low, medium},
                                     {none, none, low, low},
                                     {none, none, none, none}};
    for (int c = 0; c < 5; ++c) {
        for (int e = 0; e < 4; ++e)
            EXPECT_EQ(category(chances[c], energies[e]), expected[c][e])
                << chances[c] << " " << energies[e];
    }
    EXPECT_EQ(category(1, 1000), high);
    EXPECT_EQ(category(0.0999, 14.9), low);
}

TEST(UnsafetyCategory, NeverFallsWithChanceOrEnergy) {
    for (double chance = 1e-5; chance < 1; chance *= 1.7) {
        for (double energy = 0.1; energy < 500; energy *= 1.7) {
            EXPECT_LE(category(chance, energy), category(1.7 * chance, energy));
            EXPECT_LE(category(chance, energy), category(chance, 1.7 * energy));
        }
    }
}

TEST(UnsafetyCategory, OfARiskTakesTheMeanEnergyOfAFall) {
    Risk risk;
    risk.chance = 0.02;
    risk.mean_J = 0.02 * 14;
    EXPECT_EQ(category(risk, 1), Category::low);
    EXPECT_EQ(category(risk, 1.1), Category::medium) << "10 % more mass makes it 15.4 J";
    EXPECT_EQ(category(Risk{}, 1), Category::none);
    risk.mean_J = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(category(risk, 1), Category::none);
    EXPECT_STREQ(to_string(Category::high), "high");
    EXPECT_STREQ(to_string(Category::none), "none");
}

// A shelf before a wall, whose foot, one error smaller, lets it lean on that and never fall.
TEST(UnsafetyCategory, IsTheWorstOfWhatWasMeasuredAndOfBothEnds) {
    const Risk measured{26.3, 0, 0.0156};
    CategoryEnds ends;
    EXPECT_EQ(ends.worst(), Category::none);
    EXPECT_TRUE(ends.certain());
    ends.measured = category(measured, 1);
    EXPECT_EQ(ends.worst(), Category::high);
    EXPECT_FALSE(ends.certain());
    ends.lower = ends.higher = Category::high;
    EXPECT_TRUE(ends.certain());
    ends.measured = Category::low;
    EXPECT_EQ(ends.worst(), Category::high);
    EXPECT_FALSE(ends.certain());
}

class Action : public ::testing::Test {
  protected:
    Action() {
        scene_.events["tolerable_J"] = 1;
        o_.barrier_J = 5;
        o_.barrier_error_J = 1;
        o_.release_J = 123;
        o_.fall_chance = {{"human", 0}, {"earthquake", 0.02}};
        o_.unsafety_category = "medium";
        o_.advice.sentence = "Fasten it to the wall.";
    }
    std::string text() const { return action_text(scene_, o_); }

    Scene scene_;
    Object o_;
};

TEST_F(Action, is_the_advice_where_there_is_need_to_act) {
    EXPECT_EQ(text(), "Fasten it to the wall.");
    o_.advice.sentence.clear();
    EXPECT_EQ(text(),
              "Its risk is below the 1 J per event that this run tolerates: if it must not fall "
              "all the same, fasten it.");
}

TEST_F(Action, is_none_where_nothing_happens) {
    o_.unsafety_category = "none";
    EXPECT_EQ(text(),
              "No need to act. To bring its risk below the 1 J per event that this run tolerates "
              "all the same: fasten it to the wall.");
    scene_.events.clear();
    EXPECT_EQ(text(),
              "No need to act. To bring its risk below what is tolerated all the same: fasten it "
              "to the wall.");
    o_.advice.sentence.clear();
    EXPECT_EQ(text(), "No need to act.");
    o_.barrier_J = 0.5;  // within its error: a category of none says nothing
    o_.advice.sentence = "Look whether it stands firm.";
    EXPECT_EQ(text(), o_.advice.sentence);
}

// What this run's events leave standing may fall in others.
TEST_F(Action, is_to_see_that_what_is_tall_and_heavy_is_fastened) {
    o_.unsafety_category = "none";
    o_.fall_chance = {{"earthquake", 0}};
    o_.advice.sentence.clear();
    o_.size_m = {0.4, 2.7, 1.96};
    EXPECT_EQ(text(),
              "Nothing in this run upsets it. It is tall and heavy: see that it is fastened.");
    o_.size_m[2] = 1.1;
    EXPECT_EQ(text(), "No need to act.");
    o_.size_m = {2.4, 2.7, 1.96};
    EXPECT_EQ(text(), "No need to act.") << "it is deeper than high";
    o_.size_m[0] = 0.4;
    o_.release_J = 78;
    EXPECT_EQ(text(), "No need to act.");
    o_.instability = {{20, 595}};
    EXPECT_THAT(text(), testing::HasSubstr("tall and heavy"));
}

TEST_F(Action, is_to_look_where_only_its_errors_upset_it) {
    o_.unsafety_certain = false;
    EXPECT_FALSE(upset_by_nothing(o_));
    EXPECT_EQ(text(), "Fasten it to the wall.");
    o_.fall_chance["earthquake"] = 0.00009;
    EXPECT_TRUE(upset_by_nothing(o_));
    EXPECT_EQ(text(),
              "Nothing upsets it as measured; if its foot is one error smaller, it falls with up "
              "to 123 J: check that it stands firm.");
    // Harder pushes than the easiest may free more.
    o_.instability = {{2, 0}, {9, 229}};
    EXPECT_THAT(text(), testing::HasSubstr("with up to 229 J"));
}

TEST_F(Action, is_to_see_what_was_not_seen) {
    o_.seen_enough = false;
    o_.unsafety_category.clear();
    o_.unsafety_certain = false;
    o_.advice.sentence = "See what holds it.";
    EXPECT_EQ(text(), "See what holds it.");
}

}  // namespace
}  // namespace topple::safety

// SPDX-License-Identifier: MIT
#include "safety/reach/reach_field.h"

#include "core/random.h"
#include "device/devices.h"
#include "errors.h"
#include "host/pipeline/assessed_room.h"
#include "room.h"
#include "safety/human/human_field.h"
#include "safety/human/walkable_map.h"
#include "safety/reach/hand_load.h"
#include "testing.h"

namespace topple::safety {
namespace {

constexpr double g = 9.80665;

// A hand whose force grows in small steps to its most: what first gives way, if anything does.
enum class Gives { nothing, tips, slides };
Gives pulled(double mass, double half_base, double height, double force, double friction) {
    for (int n = 1; n <= 20000; ++n) {
        const double f = force * n / 20000;
        if (f * height > mass * g * half_base) return Gives::tips;
        if (f > friction * mass * g) return Gives::slides;
    }
    return Gives::nothing;
}

RiskObject standing(double mass, double barrier, double slide_m) {
    RiskObject out;
    out.mass_kg = mass;
    out.barrier_J = barrier;
    out.slide_distance_m = slide_m;
    out.curve = {{barrier, 5}};
    return out;
}

TEST(HandLoads, UpsetWhatAForceThatGrowsUpsets) {
    Random random(3);
    int tips = 0, slides = 0, stays = 0;
    for (int n = 0; n < 2000; ++n) {
        const double mass = std::exp(random.uniform(std::log(0.3), std::log(60.0)));
        const double half = random.uniform(0.02, 0.4), height = random.uniform(0.05, 1.3);
        const double force = random.uniform(20, 100), mu = random.uniform(0.1, 0.8);
        const Gives gives = pulled(mass, half, height, force, mu);
        // Near what decides it the steps do.
        const double tip = mass * g * half / height, slide = mu * mass * g;
        if (std::fabs(tip / slide - 1) < 1e-3 || std::fabs(std::min(tip, slide) / force - 1) < 1e-3)
            continue;
        const HandLoad load{.way = {1, 0, 0},
                            .force_N = force,
                            .height_m = height,
                            .half_base_m = half,
                            .arm_m = 0.4};
        const auto falls = [&](double slide_m) {
            RiskObject object = standing(mass, 1.5, slide_m);
            object.friction = mu;
            return hand_work_J(object, load) >= object.barrier_J;
        };
        (gives == Gives::tips ? tips : gives == Gives::slides ? slides : stays)++;
        EXPECT_EQ(falls(-1), gives == Gives::tips) << n << ": on the floor";
        EXPECT_EQ(falls(0.01), gives != Gives::nothing) << n << ": at an edge";
        EXPECT_EQ(falls(0.5), gives == Gives::tips) << n << ": farther from it than an arm";
    }
    EXPECT_GT(tips, 200);
    EXPECT_GT(slides, 200);
    EXPECT_GT(stays, 200);
}

// 55.3 lb ft a foot and 26.6 lb ft: of a child of 51.2 lb, 16 CFR 1261.4.
TEST(HandLoads, ClimbersAreThoseOfTheRule) {
    constexpr double lb_kg = 0.45359237, foot_m = 0.3048;
    for (const double out_m : {0.0, 0.2, 0.4}) {
        const double rule = (55.3 * out_m / foot_m + 26.6) * lb_kg * g * foot_m;
        EXPECT_NEAR(climber_moment_Nm(51.2 * lb_kg, out_m), rule, 0.004 * rule);
    }
    const double moment = climber_moment_Nm(27, 0);
    const RiskObject object = standing(20, 1.5, -1);
    HandLoad load{.way = {1, 0, 0}, .height_m = 1, .climber_Nm = moment, .arm_m = 0.4};
    for (const double half : {0.5 * moment / 20 / g, 0.999 * moment / 20 / g}) {
        load.half_base_m = half;
        EXPECT_GE(hand_work_J(object, load), object.barrier_J);
    }
    load.half_base_m = 1.001 * moment / 20 / g;
    EXPECT_LT(hand_work_J(object, load), object.barrier_J);
}

// A rod on its foot, which falls over by steps of a tenth of a millisecond.
TEST(HandLoads, WhoTripsFallsAsARodDoes) {
    Random random(5);
    for (int n = 0; n < 50; ++n) {
        const double height = random.uniform(0.8, 1.8), mass = random.uniform(10, 80);
        const double walking = random.uniform(0.3, 1.5), z = random.uniform(0.3, 0.8) * height;
        const double away = random.uniform(0.05, 0.4);
        // What walks on at one speed turns about its foot with the same moment about that.
        const double inertia = mass * height * height / 3;
        double omega = mass * walking * height / 2 / inertia, theta = 0;
        constexpr double step = 1e-4;
        while (z * std::tan(theta) < away) {
            omega += step * mass * g * height / 2 * std::sin(theta) / inertia;
            theta += step * omega;
        }
        const Fall fall = fall_against(height, mass, walking, z, away);
        EXPECT_NEAR(fall.speed_m_s, omega * z, 0.003 * omega * z);
        EXPECT_DOUBLE_EQ(fall.mass_kg, std::min(mass, inertia / z / z));
    }
}

// Both go on together.
TEST(HandLoads, ABlowKeepsItsMomentum) {
    const RiskObject object = standing(20, 1.5, -1);
    HandLoad load{.way = {1, 0, 0}, .height_m = 0.5};
    load.struck_kg = 30;
    load.struck_m_s = 2;
    const double together = 30.0 * 2 / (30 + 20);
    EXPECT_NEAR(hand_work_J(object, load), 20 * together * together / 2, 1e-9);
    EXPECT_NEAR(blow_impulse_Ns(object, load), 20 * together, 1e-9);
}

class ReachField : public ::testing::Test {
  protected:
    Disturbance reach(topple::test::Room& room, std::initializer_list<const char*> names,
                      unsigned threads = 2) {
        std::vector<const PersonKind*> kinds;
        for (const char* name : names) kinds.push_back(&person_kind(name));
        const auto device = device::open_native(threads);
        return reach_field(*device, room.surroundings(), room.objects, kinds);
    }
    static double taken(const Disturbance& field, std::int32_t object) {
        return topple::test::total_probability(field.work[object]);
    }
};

TEST_F(ReachField, GetsAtWhatIsLowAndNearEnough) {
    topple::test::Room room(0.025, {0, 0}, {4, 4});
    room.box(1, 3, 1, 3, 0.7, 0.75);    // a table
    room.box(0, 0.4, 0, 4, 1.1, 1.15);  // a board
    room.box(3.6, 4, 0, 4, 1.4, 1.45);  // a higher one
    const auto edge = room.thing(1.05, 2, 0.75), middle = room.thing(2, 2, 0.75);
    const auto board = room.thing(0.35, 2, 1.15), high = room.thing(3.65, 2, 1.45);
    const Disturbance toddlers = reach(room, {"toddlers"}), children = reach(room, {"children"});
    EXPECT_DOUBLE_EQ(taken(toddlers, edge), 1) << "nothing else is in reach";
    for (const auto object : {middle, board, high}) EXPECT_EQ(taken(toddlers, object), 0);
    EXPECT_GT(taken(children, edge), 0.1);
    EXPECT_GT(taken(children, board), 0.1);
    EXPECT_NEAR(taken(children, edge) + taken(children, board), 1, 1e-12);
    for (const auto object : {middle, high}) EXPECT_EQ(taken(children, object), 0);
    // The same of each kind as often.
    const Disturbance both = reach(room, {"toddlers", "children"});
    EXPECT_NEAR(taken(both, board), taken(children, board) / 2, 1e-12);
    EXPECT_EQ(both.holds[edge].size(), 5u)
        << "two kinds pull and lean; it is above toddlers' shoulders, who fall";
    EXPECT_EQ(both.holds[edge].front().by, "toddlers");
    // It is exposed where it is reached alone.
    const Surroundings s = room.surroundings();
    for (std::size_t c = 0; c < both.exposure.size(); ++c)
        EXPECT_EQ(both.exposure[c] > 0 && s.object[c] != edge && s.object[c] != board, false);
}

TEST_F(ReachField, NobodyReachesThroughAWall) {
    for (const bool wall : {false, true}) {
        topple::test::Room room(0.025, {0, 0}, {3, 2});
        room.box(0, 3, 2.2, 2.6, 0.75, 0.8);  // a shelf beyond the floor
        const auto cup = room.thing(1.5, 2.25, 0.8);
        if (wall) room.box(0, 3, 2.1, 2.125, 0, 2);
        const Disturbance field = reach(room, {"children"});
        EXPECT_EQ(taken(field, cup) == 0, wall);
        EXPECT_EQ(field.notes.size(), wall ? 1u : 0u);
    }
}

// Each place from which a level line meets the thing first, counted anew.
TEST_F(ReachField, EveryPlaceAndDirectionCountsAlike) {
    topple::test::Room room(0.05, {0, 0}, {2, 2});
    const auto near_box = room.box(0.5, 0.7, 0.8, 1.2, 0, 0.5, false);
    const auto far_box = room.box(1.5, 1.7, 0.8, 1.2, 0, 0.5, false);
    const PersonKind& kind = person_kind("toddlers");
    const Surroundings s = room.surroundings();
    const WalkableMap map = walkable_map(s, walker(kind));
    std::map<std::int32_t, double> chance;
    double places = 0;
    for (const std::uint32_t cell : map.walkable) {
        const auto [x, y] = map.center(map.place(cell));
        std::map<std::int32_t, int> lines;
        for (unsigned d = 0; d < direction_count; ++d) {
            const double angle = d * std::numbers::pi / 8;
            for (double way = 0; way <= kind.arm_m; way += 0.025) {
                const double px = x + way * std::cos(angle), py = y + way * std::sin(angle);
                const bool in = py > 0.8 && py < 1.2;
                const std::int32_t met = in && px > 0.5 && px < 0.7   ? near_box
                                         : in && px > 1.5 && px < 1.7 ? far_box
                                                                      : -1;
                if (met < 0) continue;
                ++lines[met];
                break;
            }
        }
        places += !lines.empty();
        for (const auto& [object, count] : lines) chance[object] += 1.0 / double(lines.size());
    }
    const Disturbance field = reach(room, {"toddlers"});
    EXPECT_NEAR(taken(field, near_box), chance[near_box] / places, 0.02);
    EXPECT_NEAR(taken(field, far_box), chance[far_box] / places, 0.02);
    // Lines along the borders of cells go either way.
    EXPECT_NEAR(double(field.draws), places, 0.07 * places);
}

// A tall narrow bookcase comes down onto who pulls, and a wide chest stays; a cup at a table's edge
// is pulled off.
TEST_F(ReachField, PullsDownWhatIsTopHeavy) {
    topple::test::Room room(0.025, {-2, -2}, {2, 2});
    const auto tall = room.box(-1, -0.2, -1.5, -1.25, 0, 1.5, false, 120);
    const auto chest = room.box(0.5, 1.3, -1.5, -0.8, 0, 0.5, false, 400);
    const auto table = room.box(-0.5, 0.5, 0.8, 1.5, 0.65, 0.7);
    for (const double x : {-0.5, 0.45})
        for (const double y : {0.8, 1.45}) room.part(table, x, x + 0.05, y, y + 0.05, 0, 0.65);
    const auto cup = room.thing(0, 0.85, 0.7);
    const auto device = device::open_native(2);
    const topple::test::AssessedRoom scene(*device, room, 0.3);
    const PersonKind* const kinds[] = {&person_kind("children")};
    const Disturbance field = reach_field(*device, scene.around, scene.at_risk, kinds);
    const auto r = risk(field, scene.at_risk);
    EXPECT_GT(r[tall].mean_J, 0);
    EXPECT_EQ(r[chest].mean_J, 0);
    EXPECT_GT(r[cup].mean_J, 0);
    ASSERT_FALSE(field.holds[tall].empty());
    const Hold& pull = field.holds[tall].front();
    EXPECT_EQ(pull.act, "pull");
    EXPECT_GT(pull.fall_chance, 0);
    EXPECT_LE(pull.fall_chance, pull.chance);
    EXPECT_NEAR(pull.place_m[2], person_kind("children").reach_high_m, 0.03);
    EXPECT_NEAR(std::hypot(pull.force_N[0], pull.force_N[1]), 77, 1e-9);
    EXPECT_EQ(field.holds[chest].size(), 3u) << "too low to climb";
    EXPECT_EQ(field.holds[tall].size(), 4u);
    const Hold& fall = field.holds[tall].back();
    EXPECT_EQ(fall.act, "fall");
    EXPECT_NEAR(fall.place_m[2], person_kind("children").shoulder_m, 0.03);
    EXPECT_EQ(fall.force_N, (Vec3{}));
    EXPECT_GT(std::hypot(fall.impulse_Ns[0], fall.impulse_Ns[1]), 1);
    EXPECT_EQ(pull.impulse_Ns, (Vec3{}));
}

// A chest with its back to a wall: drawers come out to the front alone.
TEST_F(ReachField, DrawersArePulledOutFromBeforeThem) {
    topple::test::Room room(0.025, {-2, -2}, {2, 2});
    const auto chest = room.box(-0.4, 0.4, -0.2, 0.2, 0, 1, false, 187.5);
    const auto device = device::open_native(2);
    topple::test::AssessedRoom scene(*device, room, 0.3);
    RiskObject& object = scene.at_risk[chest];
    const PersonKind* const kinds[] = {&person_kind("children"), &person_kind("elderly")};
    const auto opened = [&](std::string_view by) {
        const Disturbance field = reach_field(*device, scene.around, scene.at_risk, kinds);
        for (const Hold& hold : field.holds[chest])
            if (hold.act == "open" && hold.by == by) return hold;
        return Hold{};
    };
    EXPECT_EQ(opened("children").chance, 0) << "it has none";
    object.drawers = {0.25, {0, 1}, 0.3, 0.5};
    const Hold likely = opened("children");
    object.drawers.probability = 0.5;
    const Hold child = opened("children"), old = opened("elderly");
    // One of its pull, lean, climb, a tenth of a fall and as many of this as it may have drawers.
    EXPECT_NEAR(likely.chance / child.chance, 0.25 / 3.35 / (0.5 / 3.6), 1e-9);
    EXPECT_GT(child.fall_chance, 0);
    EXPECT_EQ(child.fall_chance, child.chance) << "from nowhere else";
    EXPECT_EQ(old.fall_chance, 0) << "half of it goes out by as much as half of three quarters";
    // M = m g (1.08 e + 0.158) of the child, and half of the chest's weight 0.3 m out.
    const double half = 0.2, weight = 60 * g;
    const double moment = climber_moment_Nm(27, 0.3) + 0.5 * weight * 0.3;
    EXPECT_NEAR(child.place_m[1], half + moment / (27 * g), 0.01);
    EXPECT_NEAR(child.place_m[0], 0, 1e-9);
    EXPECT_NEAR(child.force_N[2], -27 * g, 1e-9);
    EXPECT_NEAR(old.place_m[1], half + 0.3, 0.01);
    EXPECT_NEAR(old.force_N[2], -0.5 * weight, 0.02 * weight);
    object.drawers.out_m = 0.45;
    EXPECT_GT(opened("elderly").fall_chance, 0) << "0.5 x 0.45 m is beyond the edge at 0.2 m";
}

TEST_F(ReachField, TheSameBitsOfAnyThreads) {
    topple::test::Room room(0.025, {0, 0}, {3, 3});
    room.box(1, 2, 1, 2, 0.7, 0.75);
    for (int n = 0; n < 5; ++n) room.thing(1.1 + 0.17 * n, 1.06, 0.75);
    const Disturbance one = reach(room, {"toddlers", "elderly"}, 1),
                      four = reach(room, {"toddlers", "elderly"}, 4);
    EXPECT_EQ(one.exposure, four.exposure);
    EXPECT_EQ(one.samples.vx, four.samples.vx);
    ASSERT_EQ(one.work.size(), four.work.size());
    for (std::size_t o = 0; o < one.work.size(); ++o) {
        ASSERT_EQ(one.work[o].size(), four.work[o].size());
        for (std::size_t n = 0; n < one.work[o].size(); ++n) {
            EXPECT_EQ(one.work[o][n].W_J, four.work[o][n].W_J);
            EXPECT_EQ(one.work[o][n].probability, four.work[o][n].probability);
        }
    }
}

TEST(People, AdultsAreWhoWalkedBefore) {
    const HumanOptions before, now = walker(person_kind("adults"));
    EXPECT_EQ(now.body_height_m, before.body_height_m);
    EXPECT_EQ(now.body_mass_kg, before.body_mass_kg);
    EXPECT_EQ(now.walking_speed_m_s, before.walking_speed_m_s);
    EXPECT_EQ(now.body_radius_m, before.body_radius_m);
    EXPECT_EQ(now.step_height_m, before.step_height_m);
    EXPECT_EQ(now.parts.data(), before.parts.data());
    EXPECT_EQ(now.paths, before.paths);
}

// Children strike lower and less hard; who rolls needs wide ways; of both each walks half of the
// time.
TEST(People, WalkAsTheyAre) {
    const auto device = device::open_native(2);
    topple::test::Room room(0.025, {0, 0}, {4, 4});
    room.box(1.9, 2.1, 0, 1.7, 0, 2);
    room.box(1.9, 2.1, 2.3, 4, 0, 2);  // a passage of 0.6 m
    const auto high = room.box(0.5, 0.6, 2, 2.1, 1.1, 1.3, false);
    const auto low = room.box(0.5, 0.6, 1, 1.1, 0, 0.5, false);
    const auto heavy = room.box(0.5, 0.8, 3, 3.3, 0, 0.5, false, 900);
    const Surroundings s = room.surroundings();
    const auto field = [&](std::initializer_list<const char*> names) {
        std::vector<HumanOptions> kinds;
        for (const char* name : names) kinds.push_back(walker(person_kind(name)));
        return people_field(*device, s, room.objects, kinds);
    };
    const auto struck = [](const Disturbance& f, std::int32_t o) {
        return topple::test::total_probability(f.work[o]);
    };
    const auto hardest = [](const Disturbance& f, std::int32_t o) {
        double most = 0;
        for (const WorkSample& w : f.work[o]) most = std::max(most, w.W_J);
        return most;
    };
    const Disturbance adults = field({"adults"}), toddlers = field({"toddlers"});
    EXPECT_GT(struck(adults, high), 0);
    EXPECT_EQ(struck(toddlers, high), 0);
    EXPECT_GT(struck(toddlers, low), 0);
    EXPECT_LT(hardest(toddlers, low), 0.5 * hardest(adults, low));
    const Disturbance both = field({"adults", "toddlers"});
    EXPECT_NEAR(struck(both, high), struck(adults, high) / 2, 1e-12);
    EXPECT_NEAR(struck(both, low), (struck(adults, low) + struck(toddlers, low)) / 2, 1e-12);
    EXPECT_EQ(both.draws, adults.draws + toddlers.draws);
    ASSERT_TRUE(both.work_if && both.risk_at && both.passing_shares);
    EXPECT_EQ(both.work_if(room.objects)[low].size(), both.work[low].size());
    const WalkableMap walked = walkable_map(s, walker(person_kind("adults"))),
                      rolled = walkable_map(s, walker(person_kind("wheelchair")));
    EXPECT_EQ(walked.components, 1);
    EXPECT_EQ(rolled.components, 2);
    const Disturbance chair = field({"wheelchair"});
    EXPECT_GT(hardest(chair, heavy), hardest(adults, heavy)) << "all of it moves";
}

TEST(People, UnknownOnesAreNamed) {
    EXPECT_NE(topple::test::message_of([] { person_kind("pets"); }, ErrorKind::usage)
                  .find("expected adults, children, toddlers, elderly or wheelchair"),
              std::string::npos);
}

}  // namespace
}  // namespace topple::safety

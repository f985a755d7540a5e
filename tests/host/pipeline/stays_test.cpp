// SPDX-License-Identifier: MIT
#include "topple/stays.h"

#include "host/pipeline/scan.h"
#include "host/pipeline/small_room.h"

// Whether an object may be touched.
namespace topple::test {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// A box of 20 kg, 0.4 x 0.4 m wide and a metre high, which stands at the origin on friction 0.3. A
// push at its top tips it at 39 N, and slides it at 59 N; no blow is known to make it fall, and its
// barrier is 7.6 J.
struct StandingBox {
    Scene scene;
    Object& box() { return scene.objects[1]; }

    StandingBox() {
        scene.voxel_size_m = 0.02;
        scene.objects.resize(2);
        scene.objects[0].id = 0;
        scene.objects[0].grounded = true;
        Object& o = scene.objects[1];
        o.id = 1;
        o.primitives = {3};
        o.mass_kg = 20;
        o.size_m = {0.4, 0.4, 1};
        o.box_middle_m = {0, 0, 0.5};
        o.support_height_m = 0;
        o.center_height_m = 0.5;
        const double across = 20 * (0.4 * 0.4 + 1) / 12;
        o.inertia_kg_m2 = {across, 0, 0, 0, across, 0, 0, 0, 20 * 0.32 / 12};
        o.barrier_J = 20 * gravity * (std::hypot(0.5, 0.2) - 0.5);
        o.overturning.push_N = o.overturning.hand_push_N = 20 * gravity * 0.2;
        o.overturning.push_error_N = 0;
        o.overturning.slide_N = 0.3 * 20 * gravity;
        o.overturning.hand_height_m = 1;
        DirectedBarrier& b = o.barrier_by_direction;
        for (int h = 0; h < 8; ++h) b.height_m.push_back((h + 0.5) / 8);
        for (std::size_t n = 0; n < DirectedBarrier::directions; ++n) {
            const double azimuth = static_cast<double>(n) * std::numbers::pi / 8;
            b.direction.push_back({std::sin(azimuth), std::cos(azimuth), 0});
            b.push_J.push_back(unbounded);
            b.push_N.push_back(20 * gravity * 0.2);
            b.push_error_N.push_back(0);
        }
        b.blow_Ns.assign(DirectedBarrier::directions * 8, unbounded);
        b.blow_J = b.blow_Ns;
    }
    bool stays(const Touch& touch) { return topple::stays(scene, box(), touch); }
    std::string refusal(const Touch& touch) {
        return message_of([&] { stays(touch); }, ErrorKind::usage);
    }

    static constexpr double gravity = 9.80665;
};

constexpr Vec3 top_place{0, 0, 1}, middle_place{0, 0, 0.5}, eastwards{1, 0, 0};

TEST(Stays, PushesThatTipOrSlide) {
    StandingBox box;
    EXPECT_TRUE(box.stays({.place_m = top_place, .way = eastwards, .force_N = 39}));
    EXPECT_FALSE(box.stays({.place_m = top_place, .way = eastwards, .force_N = 40}));
    // Halfway up it takes twice as much to tip it, and before that it slides.
    EXPECT_TRUE(box.stays({.place_m = middle_place, .way = eastwards, .force_N = 58}));
    EXPECT_FALSE(box.stays({.place_m = middle_place, .way = eastwards, .force_N = 59}));
    box.box().mass_error_kg = 2;
    EXPECT_TRUE(box.stays({.place_m = middle_place, .force_N = 47}));
    EXPECT_FALSE(box.stays({.place_m = middle_place, .force_N = 48}));
    box.box().overturning.push_error_N = box.box().overturning.push_N / 4;
    EXPECT_TRUE(box.stays({.place_m = top_place, .force_N = 19}));
    EXPECT_FALSE(box.stays({.place_m = top_place, .force_N = 20}));
}

// Weaker to one side alone: asked of that side, of those next to it, and of any.
TEST(Stays, AsksTheDirectionsNextToTheWay) {
    StandingBox box;
    box.box().barrier_by_direction.push_N[4] = 10;  // east
    const auto stays = [&](double degrees) {
        const double a = degrees * std::numbers::pi / 180;
        return box.stays(
            {.place_m = top_place, .way = {std::sin(a), std::cos(a), 0}, .force_N = 20});
    };
    EXPECT_FALSE(stays(90));
    EXPECT_FALSE(stays(68));
    EXPECT_FALSE(stays(112));
    EXPECT_TRUE(stays(66));
    EXPECT_TRUE(stays(-90));
    EXPECT_FALSE(box.stays({.place_m = top_place, .force_N = 20})) << "zeros: to any side";
    box.box().barrier_by_direction.push_N[4] = unbounded;  // no edge there
    EXPECT_TRUE(stays(90));
}

// v^2 / (2 mu g) with v = P / M: 2 cm at 0.343 m/s, 6.86 N s.
TEST(Stays, BumpsThatSetItSliding) {
    StandingBox box;
    std::ranges::fill(box.box().barrier_by_direction.blow_Ns, 1000.0);
    EXPECT_TRUE(box.stays({.place_m = middle_place, .way = eastwards, .impulse_Ns = 6.8}));
    EXPECT_FALSE(box.stays({.place_m = middle_place, .way = eastwards, .impulse_Ns = 6.9}));
    EXPECT_TRUE(box.stays({.place_m = middle_place, .impulse_Ns = 15.3, .slack_m = 0.1}));
    EXPECT_FALSE(box.stays({.place_m = middle_place, .impulse_Ns = 15.4, .slack_m = 0.1}));
    EXPECT_FALSE(box.stays({.place_m = middle_place, .impulse_Ns = 0.01, .slack_m = 0}));
    EXPECT_TRUE(box.stays({.place_m = middle_place, .force_N = 20, .slack_m = 0}));
    box.box().mass_error_kg = 2;  // as if it weighed 16 kg
    EXPECT_TRUE(box.stays({.place_m = middle_place, .impulse_Ns = 5.4}));
    EXPECT_FALSE(box.stays({.place_m = middle_place, .impulse_Ns = 5.5}));
}

TEST(Stays, BumpsThatMakeItFallAtTheHeightsNextToThePlace) {
    StandingBox box;
    auto& blow = box.box().barrier_by_direction.blow_Ns;
    std::ranges::fill(blow, 1000.0);
    blow[4 * 8 + 4] = 3;  // towards east, at 0.5625 m
    const auto stays = [&](double z, const Vec3& way = eastwards) {
        return box.stays({.place_m = {0.2, 0, z}, .way = way, .impulse_Ns = 4});
    };
    EXPECT_TRUE(stays(0.4));
    EXPECT_FALSE(stays(0.45));
    EXPECT_FALSE(stays(0.68));
    EXPECT_TRUE(stays(0.7));
    EXPECT_TRUE(stays(0.5, {-1, 0, 0}));
    EXPECT_FALSE(stays(0.5, {}));
}

TEST(Stays, SaysWhyNot) {
    StandingBox box;
    const auto why = [&](const Touch& touch) { return why_moves(box.scene, box.box(), touch); };
    EXPECT_EQ(why({.place_m = top_place, .force_N = 39}), "");
    EXPECT_EQ(why({.place_m = top_place, .force_N = 40}),
              "the push may tip it: at that height, from 39 N on it may");
    EXPECT_EQ(why({.place_m = top_place, .force_N = 70}),
              "the push may tip it: at that height, from 39 N on it may")
        << "it may slide, too, from 59 N on";
    EXPECT_EQ(why({.place_m = middle_place, .force_N = 59}),
              "the push may set it sliding: from 59 N on it may");
    EXPECT_EQ(why({.place_m = middle_place, .impulse_Ns = 15.4}),
              "the bump may set it sliding by 0.10 m");
    EXPECT_EQ(why({.place_m = {0, 0, 1.5}, .force_N = 1}), "the place is above its top, by 0.50 m");
    EXPECT_EQ(why({.place_m = {0, 0, -0.5}, .force_N = 1}),
              "the place is lower than what it stands on, by 0.50 m");
    std::ranges::fill(box.box().barrier_by_direction.blow_Ns, 3.0);
    EXPECT_EQ(why({.place_m = middle_place, .impulse_Ns = 4}),
              "the bump may make it fall: there, from 3.0 N s on it may");
    box.box().piece_of = 7;
    EXPECT_EQ(why({.place_m = top_place}),
              "it is likelier than not a piece of object 7: ask about that one");
    box.box().seen_enough = false;
    EXPECT_EQ(why({.place_m = top_place}), "the scan does not show what holds it");
    EXPECT_EQ(why_moves(box.scene, box.scene.objects[0], {.force_N = 1e6}), "") << "the ground";
}

TEST(Stays, UpToTheLeastPushThere) {
    StandingBox box;
    constexpr double gravity = StandingBox::gravity;
    EXPECT_NEAR(stays_up_to_N(box.scene, box.box(), top_place), 4 * gravity, 1e-9) << "tips";
    EXPECT_NEAR(stays_up_to_N(box.scene, box.box(), middle_place), 6 * gravity, 1e-9) << "slides";
    box.box().barrier_by_direction.push_N[4] = 10;  // east
    EXPECT_NEAR(stays_up_to_N(box.scene, box.box(), top_place, eastwards), 10, 1e-9);
    EXPECT_NEAR(stays_up_to_N(box.scene, box.box(), top_place, {-1, 0, 0}), 4 * gravity, 1e-9);
    EXPECT_EQ(stays_up_to_N(box.scene, box.box(), {0, 0, 2}), 0) << "beyond it";
    box.box().barrier_by_direction.push_N[4] = unknown;
    EXPECT_EQ(stays_up_to_N(box.scene, box.box(), top_place), 0);
    EXPECT_EQ(stays_up_to_N(box.scene, box.scene.objects[0], top_place), unbounded);
}

// A mass that goes by what such things weigh is off by factors: two errors below 20 kg +- 20 kg are
// 5 kg, of another mass nothing is known.
TEST(Stays, MassesByKindAreOffByFactors) {
    StandingBox box;
    box.box().mass_error_kg = 20;
    EXPECT_FALSE(box.stays({.place_m = middle_place, .force_N = 1}));
    box.box().mass_model = "kind";
    EXPECT_TRUE(box.stays({.place_m = middle_place, .force_N = 14.7}));
    EXPECT_FALSE(box.stays({.place_m = middle_place, .force_N = 14.8}));
}

// At its middle the energy of P is P^2 / (2 M), that of the barrier at 17.4 N s; near its top it is
// 1 + 0.44^2 / 0.0967 times as much.
TEST(Stays, AnInfiniteBlowIsNoPromise) {
    StandingBox box;
    const auto most = [&](const Vec3& at) {
        double low = 0, high = 1e3;
        while (high - low > 1e-6) {
            const double P = (low + high) / 2;
            (box.stays({.place_m = at, .impulse_Ns = P, .slack_m = 1e6}) ? low : high) = P;
        }
        return low;
    };
    const double sideways = std::sqrt(2 * 20 * box.box().barrier_J);
    const auto with_arm = [&](double arm) {
        return sideways / std::sqrt(1 + arm * arm / (1.16 / 12));
    };
    EXPECT_NEAR(most(top_place), with_arm(0.4375), 1e-3);
    EXPECT_NEAR(most(middle_place), with_arm(0.0625), 1e-3) << "the heights next to it";
    box.box().overturning.push_error_N = box.box().overturning.push_N / 4;
    EXPECT_NEAR(most(top_place), with_arm(0.4375) / 2, 1e-3) << "two standard errors";
}

TEST(Stays, AHitOutsideItsHeightIsNotKnown) {
    StandingBox box;
    box.scene.up = {0, 0, 1};
    for (const double z : {-0.019, 0.0, 1.0, 1.019})
        EXPECT_TRUE(box.stays({.place_m = {0, 0, z}, .impulse_Ns = 0.1})) << z;
    for (const double z : {-0.021, -1.0, 1.021, 500.0})
        EXPECT_FALSE(box.stays({.place_m = {0, 0, z}, .impulse_Ns = 0.1})) << z;
    // Heights are above what it stands on, along the scene's up.
    box.scene.up = {0, 1, 0};
    box.box().box_middle_m = {0, 2.5, 0};
    box.box().support_height_m = 2;
    for (Vec3& d : box.box().barrier_by_direction.direction) d = {d[0], 0, d[1]};
    EXPECT_TRUE(box.stays({.place_m = {0, 2.1, 0}, .force_N = 50}));
    EXPECT_FALSE(box.stays({.place_m = {0, 2.9, 0}, .force_N = 50}));
    EXPECT_FALSE(box.stays({.place_m = {0, 1.9, 0}, .force_N = 1}));
}

// Whatever is NaN or missing, or makes the figures of another thing.
TEST(Stays, WhatNobodyKnowsIsNo) {
    const Touch gentle{.place_m = middle_place, .way = eastwards, .force_N = 1, .impulse_Ns = 0.1};
    ASSERT_TRUE(StandingBox().stays(gentle));
    const auto no = [&](const char* what, const auto& spoil) {
        StandingBox box;
        spoil(box.box());
        EXPECT_FALSE(box.stays(gentle)) << what;
        EXPECT_FALSE(box.stays({.place_m = middle_place})) << what << ", and nothing is done";
    };
    no("unseen", [](Object& o) { o.seen_enough = false; });
    no("held otherwise", [](Object& o) { o.rest_probability = 0.4; });
    no("a piece", [](Object& o) { o.piece_of = 0; });
    no("two things", [](Object& o) { o.joint_probability = 0.4; });
    no("falls by itself", [](Object& o) { o.barrier_J = 0; });
    no("hangs", [](Object& o) { o.barrier_by_direction.push_N.clear(); });
    no("no figures", [](Object& o) { o.barrier_by_direction = {}; });
    no("unsure", [](Object& o) { o.overturning.push_error_N = o.overturning.push_N / 2; });
    no("light", [](Object& o) { o.mass_error_kg = o.mass_kg / 2; });
    for (double Object::*figure :
         {&Object::mass_kg, &Object::mass_error_kg, &Object::barrier_J, &Object::support_height_m,
          &Object::center_height_m, &Object::rest_probability})
        no("NaN", [&](Object& o) { o.*figure = unknown; });
    for (double Overturning::*figure : {&Overturning::push_N, &Overturning::push_error_N,
                                        &Overturning::slide_N, &Overturning::hand_height_m})
        no("NaN", [&](Object& o) { o.overturning.*figure = unknown; });
    no("no box", [](Object& o) { o.box_middle_m = {unknown, unknown, unknown}; });
    no("NaN push", [](Object& o) { o.barrier_by_direction.push_N[4] = unknown; });
    no("NaN blow", [](Object& o) { o.barrier_by_direction.blow_Ns[4 * 8 + 4] = unknown; });
    no("NaN inertia", [](Object& o) { o.inertia_kg_m2[4] = unknown; });
    StandingBox box;
    box.scene.friction = unknown;
    EXPECT_FALSE(box.stays(gentle));
    // What is fixed stays.
    EXPECT_TRUE(stays(box.scene, box.scene.objects[0], gentle));
}

TEST(Stays, RefusesWhatMakesNoSense) {
    StandingBox box;
    const auto way = [&](const Vec3& v) { return box.refusal({.place_m = top_place, .way = v}); };
    EXPECT_EQ(way({2, 0, 0}),
              "stays: way (2, 0, 0) is 2 long: expected a unit vector, or zeros for any way; "
              "divide it by its length");
    EXPECT_THAT(way({unknown, 0, 0}), testing::HasSubstr("is nan long"));
    EXPECT_THAT(way({0.6, 0, 0.8}),
                testing::HasSubstr("leads up or down by 0.8: expected a level"));
    EXPECT_THAT(way({0, 0, -1}), testing::HasSubstr("expected a level way"));
    EXPECT_EQ(way({std::cos(0.08), 0, std::sin(0.08)}), "nothing was thrown") << "within 5 degrees";
    EXPECT_EQ(
        box.refusal({.place_m = {0, unknown, 1}}),
        "stays: place_m (0, nan, 1): expected metres in the frame of the result's points, all "
        "finite");
    for (const double wrong : {-1.0, unknown, unbounded}) {
        EXPECT_THAT(box.refusal({.place_m = top_place, .force_N = wrong}),
                    testing::HasSubstr("expected newtons, a finite number from 0 on"));
        EXPECT_THAT(box.refusal({.place_m = top_place, .impulse_Ns = wrong}),
                    testing::HasSubstr("expected newton seconds"));
        EXPECT_THAT(box.refusal({.place_m = top_place, .slack_m = wrong}),
                    testing::HasSubstr("expected metres"));
    }
    EXPECT_THROW(stays(box.scene, Object{}, {}), Error);
    Object other = box.box();
    other.primitives = {7};
    EXPECT_THROW(stays(box.scene, other, {}), Error);
    other = box.box();  // a copy is as good
    EXPECT_TRUE(stays(box.scene, other, {.place_m = top_place, .force_N = 1}));
}

// Of a parse: what is said to stay slides no farther than the slack, is not said to stay where it
// is touched harder, and some touches are allowed.
TEST_F(ParsedRoom, StaysWhereItIsTouchedGently) {
    const Scene& scene = result().scene;
    int allowed = 0, asked = 0;
    for (const Object& o : scene.objects) {
        if (o.grounded) continue;
        for (const double share : {0.1, 0.5, 0.95}) {
            const Vec3 at{o.box_middle_m[0], o.box_middle_m[1],
                          o.support_height_m + share * o.size_m[2]};
            for (std::size_t n = 0; n <= DirectedBarrier::directions; ++n) {
                const bool any = n == DirectedBarrier::directions;
                const Vec3 way = any ? Vec3{} : o.barrier_by_direction.direction[n];
                bool before = true;
                for (double P = 0.25; P < 300; P *= 2) {
                    const bool stay = stays(scene, o, {at, way, 0, P, 0.02});
                    EXPECT_TRUE(before || !stay) << o.id << ": " << P;
                    before = stay;
                    allowed += stay;
                    ++asked;
                    const double v = P / o.mass_kg, slides_m = v * v / (2 * 0.3 * 9.80665);
                    EXPECT_TRUE(!stay || slides_m <= 0.02) << o.id << ": " << P;
                }
                EXPECT_FALSE(stays(scene, o, {at, way, o.mass_kg * 3, 0, 0.02}));
            }
        }
        EXPECT_TRUE(stays(scene, o, {.place_m = o.center_of_mass_m, .force_N = 1}));
    }
    EXPECT_GT(allowed, asked / 4);
    EXPECT_LT(allowed, asked * 3 / 4);
}

}  // namespace
}  // namespace topple::test

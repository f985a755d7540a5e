// SPDX-License-Identifier: MIT
#include "core/random.h"
#include "errors.h"
#include "room.h"
#include "safety/human/body_parts.h"
#include "safety/human/footprint.h"
#include "safety/human/human_field.h"
#include "safety/human/secondary_motion.h"
#include "safety/human/walkable_map.h"
#include "topple/kernel_testing/each_backend.h"

namespace topple::safety {
namespace {

using ::testing::HasSubstr;

constexpr double rate_hz = 100, stature_m = 1.75;

// A body that walks along `heading` at a steady speed without moving a limb, but for its right hand
// and wrist, which swing sideways by `swing_m` at 1 Hz.
BodyMotion walker(double heading, double speed, double swing_m = 0) {
    BodyMotion out;
    out.step_s = 1 / rate_hz;
    const double fx = std::cos(heading), fy = std::sin(heading);
    const auto add = [&](BodyJoint joint, double ahead, double left, double height,
                         double swing = 0) {
        auto& track = out.track[static_cast<std::size_t>(joint)];
        for (int f = 0; f < 300; ++f) {
            const double along = ahead + speed * f / rate_hz;
            const double side = left + swing * std::sin(2 * std::numbers::pi * f / rate_hz);
            track.push_back({3 + along * fx - side * fy, -2 + along * fy + side * fx,
                             0.5 + height * stature_m});
        }
    };
    using enum BodyJoint;
    add(pelvis, 0, 0, 0.53);
    add(neck, 0, 0, 0.87);
    add(head, 0, 0, 0.98);
    for (const int side : {1, -1}) {
        const auto joint = [&](BodyJoint left, BodyJoint right) { return side > 0 ? left : right; };
        const double swing = side < 0 ? swing_m : 0;
        add(joint(left_shoulder, right_shoulder), 0, side * 0.2, 0.818);
        add(joint(left_elbow, right_elbow), 0, side * 0.22, 0.63);
        add(joint(left_wrist, right_wrist), 0, side * 0.22, 0.485, swing);
        add(joint(left_fingers, right_fingers), 0, side * 0.22, 0.40, swing);
        add(joint(left_hip, right_hip), 0, side * 0.1, 0.53);
        add(joint(left_knee, right_knee), 0, side * 0.1, 0.285);
        add(joint(left_ankle, right_ankle), 0, side * 0.1, 0.039);
        add(joint(left_toes, right_toes), 0.15, side * 0.1, 0.01);
    }
    return out;
}

SecondaryMotion motion_of(const BodyMotion& recorded, HumanOptions options = {}) {
    options.motions = {std::make_shared<const BodyMotion>(recorded)};
    return recorded_motion(options);
}

// Whether the table's hand that reaches out was added, as the last level.
bool reaches_by_table(const SecondaryMotion& motion) {
    return std::ranges::any_of(motion.notes, [](const std::string& note) {
        return note.find("reaches out") != std::string::npos;
    });
}

// Passes of what was recorded, per walk at height z and `aside` metres to the left of the path,
// over all levels; and their mean energy.
struct Passes {
    double sum = 0, energy = 0;
};
Passes passes(const SecondaryMotion& motion, const HumanOptions& options, double z, double aside) {
    const auto band = static_cast<unsigned>(z / (options.body_height_m / band_count));
    Passes out;
    for (const MotionLayer& layer : motion.layers) {
        if (band < layer.bands.first || band >= layer.bands.first + layer.bands.count) continue;
        if (reaches_by_table(motion) && layer.level + 1 == motion.energy_J.size()) continue;
        for (const auto& way : layer.ways) {
            for (int step = -60; step <= 60; ++step) {
                const double p = way.passes(0.025 * step, aside, 0.025);
                out.sum += p;
                out.energy += p * motion.energy_J[layer.level];
            }
        }
    }
    if (out.sum > 0) out.energy /= out.sum;
    return out;
}

TEST(RecordedMotion, AStiffBodyPassesEachPlaceOnceWithTheWalkersSpeed) {
    HumanOptions options;
    options.wander_m = 0;
    for (const double heading : {0.0, 1.0, 4.0}) {
        const SecondaryMotion motion = motion_of(walker(heading, 0.9), options);
        // A plate of 40 cm at the shoulders, seen in a mirror; a pelvis strikes with .142 of 70 kg.
        const Passes chest = passes(motion, options, 1.25, 0.05);
        EXPECT_NEAR(chest.sum, 1, 0.25) << heading;
        // Thighs, which have .1, are in the same of 8 levels.
        EXPECT_GT(chest.energy, 0.5 * 0.100 * 70 * 1.3 * 1.3) << heading;
        EXPECT_LT(chest.energy, 0.5 * 0.142 * 70 * 1.3 * 1.3) << heading;
        EXPECT_EQ(passes(motion, options, 1.25, 0.5).sum, 0);
        EXPECT_EQ(passes(motion, options, 0.3, 0).sum, 0) << "between the legs";
        EXPECT_GT(passes(motion, options, 0.3, 0.1).sum, 0.5);
        // As wide as a calf, and no wider.
        EXPECT_NEAR(passes(motion, options, 0.3, 0.175).sum, 0.5, 0.3);
        EXPECT_EQ(passes(motion, options, 0.3, 0.25).sum, 0);
        EXPECT_TRUE(reaches_by_table(motion));
        EXPECT_NEAR(motion.reach_m, 0.62, 0.05) << "of the hand that reaches out";
        for (const MotionLayer& layer : motion.layers) {
            if (layer.level + 1 == motion.energy_J.size()) continue;
            EXPECT_NEAR(layer.speed_m_s, 1.3, 1e-9);
            ASSERT_EQ(layer.ways.size(), 1u);
            EXPECT_EQ(layer.ways[0].turn, 0u);
        }
    }
}

TEST(RecordedMotion, AHandThatSwingsReachesFurtherAndStrikesHarder) {
    HumanOptions options;
    options.wander_m = 0;
    const SecondaryMotion still = motion_of(walker(0, 1.3), options);
    const SecondaryMotion swings = motion_of(walker(0, 1.3, 0.3), options);
    EXPECT_TRUE(reaches_by_table(still));
    EXPECT_FALSE(reaches_by_table(swings)) << "its own does";
    const double hand = 0.44 * stature_m;
    EXPECT_EQ(passes(still, options, hand, 0.5).sum, 0);
    EXPECT_GT(passes(swings, options, hand, 0.48).sum, 0);
    EXPECT_GT(passes(swings, options, hand, -0.48).sum, 0) << "either hand may swing";
    // At the middle of its swing it moves at 1.3 ahead and 1.9 m/s sideways.
    double fastest = 0;
    for (const double e : swings.energy_J) fastest = std::max(fastest, e);
    const double before = *std::max_element(still.energy_J.begin(), still.energy_J.end());
    EXPECT_GE(fastest, before * 0.8);
    bool sideways = false;
    for (const MotionLayer& layer : swings.layers) {
        for (const auto& way : layer.ways) sideways = sideways || way.turn == 2 || way.turn == 14;
    }
    EXPECT_TRUE(sideways) << "some passes go aside of the walk";
}

TEST(RecordedMotion, SeveralAreEachAsOftenAndMissNothingThatOneHas) {
    HumanOptions options;
    options.wander_m = 0;
    BodyMotion arms = walker(0, 1.3, 0.3);
    for (const BodyJoint leg :
         {BodyJoint::left_knee, BodyJoint::right_knee, BodyJoint::left_ankle,
          BodyJoint::right_ankle, BodyJoint::left_toes, BodyJoint::right_toes})
        arms.track[static_cast<std::size_t>(leg)].clear();
    const auto one = std::make_shared<const BodyMotion>(walker(0, 1.3));
    const auto other = std::make_shared<const BodyMotion>(arms);
    const auto at = [&](std::vector<std::shared_ptr<const BodyMotion>> motions, double z,
                        double y) {
        HumanOptions with = options;
        with.motions = std::move(motions);
        return passes(recorded_motion(with), options, z, y).sum;
    };
    const double hand = 0.44 * stature_m;
    // Half of the passes far out are left, where half of the walkers swing; legs are of the one
    // alone.
    const double alone = at({other}, hand, 0.48);
    EXPECT_GT(alone, 0);
    EXPECT_NEAR(at({one, other}, hand, 0.48), alone / 2, 0.02 * alone);
    EXPECT_NEAR(at({one, other}, 0.3, 0.1), at({one}, 0.3, 0.1), 1e-3);
    EXPECT_EQ(at({other}, 0.3, 0.1), 0);
    EXPECT_NEAR(at({one, one}, hand, 0.22), at({one}, hand, 0.22), 1e-9);
}

TEST(RecordedMotion, RefusesWhatTellsNothing) {
    const auto refused = [](const BodyMotion& motion) {
        return test::message_of([&] { motion_of(motion); }, ErrorKind::input);
    };
    EXPECT_THAT(refused({}), HasSubstr("no motion"));
    BodyMotion motion = walker(0, 1);
    for (auto& track : motion.track) track.assign(track.size(), Vec3{1, 1, 1});
    EXPECT_THAT(refused(motion), HasSubstr("at one place"));
    motion = walker(0, 1);
    for (std::size_t j = 1; j < body_joint_count; ++j) motion.track[j].clear();
    EXPECT_THAT(refused(motion), HasSubstr("faces"));
    motion = walker(0, 1);
    motion.track[3].pop_back();
    EXPECT_THAT(refused(motion), HasSubstr("different numbers"));
    HumanOptions standing;
    standing.walking_speed_m_s = 0;
    EXPECT_THROW(motion_of(walker(0, 1), standing), Error);
}

class RecordedField : public test::EachBackend {};

// The device's field against a direct double-precision sum over the same walks, without obstacles.
TEST_P(RecordedField, IsTheSumOverWalkersAndTheirMotion) {
    test::Room room(0.05, {0, 0}, {2.5, 2.0});
    // As thin as a cell, so that they are not in their own way.
    const auto low = room.thing(1.025, 1.225, 0, 0.05, 0.2);
    const auto tall = room.thing(1.625, 0.625, 0, 0.05, 0.9);
    HumanOptions options;
    options.paths = 40;
    options.motions = {std::make_shared<BodyMotion>(walker(2, 1.2, 0.25))};
    const Surroundings s = room.surroundings();
    const Disturbance field = human_field(*device, s, room.objects, options);

    const WalkableMap map = walkable_map(s, options);
    const PrimaryMotion walks = primary_motion(map, options);
    const SecondaryMotion motion = recorded_motion(options);
    const double band_m = options.body_height_m / band_count;
    double worst = 0;
    int compared = 0;
    for (std::size_t v = 0; v < s.cells->size(); ++v) {
        if (s.object[v] != low && s.object[v] != tall) continue;
        const std::size_t cell = map.cell_of(s.cells->i[v], s.cells->j[v]);
        const auto x = static_cast<std::int64_t>(cell) % map.nx,
                   y = static_cast<std::int64_t>(cell) / map.nx;
        const auto band = static_cast<unsigned>((s.cells->k[v] + 0.5) * s.cells->voxel_m / band_m);
        double exposure = 0;
        for (const MotionLayer& layer : motion.layers) {
            for (unsigned d = 0; d < direction_count; ++d) {
                double most = 0;
                for (const unsigned b : {band, band + 1}) {
                    if (b < layer.bands.first || b >= layer.bands.first + layer.bands.count)
                        continue;
                    double sum = 0;
                    for (const std::uint32_t from : map.walkable) {
                        const double wx = static_cast<double>(from % map.nx - x) * map.cell_m,
                                     wy = static_cast<double>(from / map.nx - y) * map.cell_m;
                        if (std::hypot(wx, wy) > motion.reach_m) continue;
                        for (const auto& way : layer.ways) {
                            const unsigned heading = (d + direction_count - way.turn) % 16;
                            const double visits = walks.frequency(heading, from, map.size());
                            if (visits == 0) continue;
                            const auto [dx, dy] = direction(heading);
                            const double weight =
                                way.passes(-(wx * dx + wy * dy), wx * dy - wy * dx,
                                           map.cell_m / std::max(std::fabs(dx), std::fabs(dy)));
                            if (weight > 1e-5) sum += weight * visits;
                        }
                    }
                    most = std::max(most, sum);
                }
                exposure += most;
            }
        }
        ++compared;
        EXPECT_GT(exposure, 0) << v;
        worst = std::max(worst, std::fabs(field.exposure[v] / exposure - 1));
    }
    EXPECT_GT(compared, 20);
    EXPECT_LE(worst, 1e-4);
    EXPECT_GT(test::total_probability(field.work[static_cast<std::size_t>(low)]), 0);
    EXPECT_GT(test::total_probability(field.work[static_cast<std::size_t>(tall)]), 0);
}

TOPPLE_ON_EACH_BACKEND(RecordedField);

}  // namespace
}  // namespace topple::safety

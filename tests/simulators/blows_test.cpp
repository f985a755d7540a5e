// SPDX-License-Identifier: MIT
#include "device/devices.h"
#include "physics/directions.h"
#include "safety/earthquake/made_up_records.h"
#include "safety/earthquake/rocking.h"
#include "simulators/script.h"
#include "simulators/struck_thing.h"

// The least energy of a blow that makes a thing fall, by direction and height: the table of a parse
// against blows in MuJoCo (blows_check.py).
namespace topple::exports::test {
namespace {

// What the simulator says of so many things in 16 directions, at three heights.
void judge_blows(int count) {
    const auto device = device::open_native(2);
    Random random(5);
    auto things = nlohmann::json::array();
    for (int n = 0; n < count; ++n) {
        const StruckThing thing(random, n);
        StruckRoom alone(thing);
        const std::int32_t id = alone.id;
        const topple::test::AssessedRoom scene(*device, alone.room, blow_friction);
        const auto& toppling = scene.at_risk[id].toppling;
        ASSERT_TRUE(toppling);
        auto blows = nlohmann::json::array();
        for (unsigned d = 0; d < safety::direction_count; ++d) {
            const auto [x, y] = safety::direction(d);
            for (const std::size_t part : {1, 4, 7}) {
                const double height = toppling->height_m(part);
                const double W = toppling->blow_barrier_J({x, y, 0}, height);
                blows.push_back({{"way", {x, y}}, {"height_m", height}});
                blows.back()["W_J"] = std::isfinite(W) ? nlohmann::json(W) : nlohmann::json();
            }
        }
        things.push_back({{"parts", thing.parts},
                          {"fixed", thing.fixed},
                          {"barrier_J", scene.at_risk[id].barrier_J},
                          {"blows", blows}});
    }
    judge_by_script("blows", nlohmann::json{{"friction", blow_friction},
                                            {"voxel_m", blow_voxel_m},
                                            {"density_kg_m3", 700},
                                            {"things", things}});
}

TEST(Blows, TakeWhatTheTableSays) {
    judge_blows(4);
}

// Takes minutes.
TEST(Blows, DISABLED_OfFortyThings) {
    judge_blows(40);
}

// Blocks in earthquakes, by the kernel and in MuJoCo (rocking_check.py).

// Peaks as multiples of what just moves the block, so that about half of the blocks fall.
constexpr double least_peak = 1, most_peak = 6;
constexpr std::size_t record_count = 50;

struct ShakenBlock {
    safety::Profile body;
    safety::Shaking shaking;

    ShakenBlock(Random& random, const std::vector<Accelerogram>& records) {
        const double width = random.uniform(0.05, 0.6), slender = random.uniform(1, 6);
        body.ahead_m = body.behind_m = width / 2;
        body.height_m = width * slender / 2;
        body.gyration_m = std::hypot(width, width * slender) / std::sqrt(12);
        // Its whole base stands on what carries it.
        body.support_ahead_m = width / 2 + random.uniform(0, 0.3);
        body.support_behind_m = width / 2 + random.uniform(0, 0.3);
        body.friction = random.uniform(0.2, 0.8);
        shaking.record = static_cast<std::uint32_t>(random.below(records.size()));
        const double moves = physics::gravity * std::min(body.friction, 1 / slender);
        const double scale = moves * least_peak *
                             std::pow(most_peak / least_peak, random.uniform()) /
                             records[shaking.record].peak_m_s2();
        const double way = random.uniform(0, 2 * std::numbers::pi);
        shaking.along = scale * std::cos(way);
        shaking.across = scale * std::sin(way);
        shaking.up = scale;
    }

    safety::Motion at(device::Device& device, const std::vector<Accelerogram>& records,
                      double times) const {
        safety::Shaking s = shaking;
        s.body = 0;
        s.along *= times;
        s.across *= times;
        s.up *= times;
        return safety::shake(device, {&body, 1}, records, {&s, 1})[0];
    }
};

bool fell(const safety::Motion& motion, const safety::Profile& body) {
    return motion.overturned() || motion.slid_off(body);
}

// least_alike: of all; least_both: of those that fall in either the share that does in both.
void judge_rocking(std::size_t count, double least_alike, double least_both) {
    const auto device = device::open_native(2);
    const auto records = safety::made_up_records(record_count, 3);
    Random random(7);
    auto cases = nlohmann::json::array();
    for (std::size_t n = 0; n < count; ++n) {
        const ShakenBlock block(random, records);
        const safety::Motion motion = block.at(*device, records, 1);
        const auto fell_at = [&](double times) {
            return fell(block.at(*device, records, times), block.body);
        };
        cases.push_back({{"half_width_m", block.body.ahead_m},
                         {"half_height_m", block.body.height_m},
                         {"friction", block.body.friction},
                         {"support_m", {block.body.support_behind_m, block.body.support_ahead_m}},
                         {"record", block.shaking.record},
                         {"scale", {block.shaking.along, block.shaking.across, block.shaking.up}},
                         {"overturned", motion.overturned()},
                         {"slid_off", motion.slid_off(block.body)},
                         {"near", fell_at(0.9) != fell(motion, block.body) ||
                                      fell_at(1.1) != fell(motion, block.body)}});
    }
    auto shaken = nlohmann::json::array();
    for (const Accelerogram& r : records)
        shaken.push_back({{"step_s", r.step_s}, {"m_s2", {r.m_s2, r.across_m_s2, r.up_m_s2}}});
    judge_by_script("rocking", nlohmann::json{{"gravity", physics::gravity},
                                              {"records", shaken},
                                              {"cases", cases},
                                              {"least_alike", least_alike},
                                              {"least_both", least_both}});
}

// So few that three or four otherwise are chance.
TEST(Rocking, EndsAsInMujoco) {
    judge_rocking(40, 0.85, 0.75);
}

// Takes minutes.
TEST(Rocking, DISABLED_OfFiveHundredBlocks) {
    judge_rocking(500, 0.9, 0.85);
}

}  // namespace
}  // namespace topple::exports::test

// SPDX-License-Identifier: MIT
#include "device/devices.h"
#include "physics/directions.h"
#include "safety/objects.h"
#include "safety/reach/hand_load.h"
#include "simulators/script.h"
#include "simulators/struck_thing.h"

// What pulls at a thing or climbs it, and whether it falls: topple's statics against MuJoCo
// (holds_check.py).
namespace topple::exports::test {
namespace {

// So many things, each held at four times.
void judge_holds(int count) {
    const auto device = device::open_native(2);
    Random random(11);
    auto things = nlohmann::json::array();
    for (int n = 0; n < count; ++n) {
        const StruckThing thing(random, n);
        StruckRoom alone(thing);
        const topple::test::AssessedRoom scene(*device, alone.room, blow_friction);
        const safety::RiskObject& object = scene.at_risk[alone.id];
        const auto cells = safety::cells_of_objects(
            safety::movable_object_of_cells(scene.around, scene.at_risk), scene.at_risk.size());
        const safety::MassSpread stands = safety::stance(scene.around, cells[alone.id], object);
        const double weight = object.mass_kg * physics::gravity;
        auto holds = nlohmann::json::array();
        for (int h = 0; h < 4; ++h) {
            safety::HandLoad load;
            const auto [x, y] = safety::direction(static_cast<unsigned>(random.below(16)));
            load.way = {x, y, 0};
            load.arm_m = 0.4;
            load.half_base_m = safety::half_base(object, stands, x, y);
            load.height_m = random.uniform(0.3, 1) * (stands.top_m - stands.bottom_m);
            // About what moves it.
            const double times = std::exp(random.uniform(-1.2, 1.2));
            if (h == 3)
                load.climber_Nm = times * weight * load.half_base_m;
            else
                load.force_N =
                    times * weight * std::min(blow_friction, load.half_base_m / load.height_m);
            const double W = safety::hand_work_J(object, load);
            const bool falls = safety::instability(object, {W, 1, load.way}) > 0;
            holds.push_back({{"way", {x, y}},
                             {"height_m", load.height_m},
                             {"force_N", load.force_N},
                             {"climber_Nm", load.climber_Nm},
                             {"half_base_m", load.half_base_m},
                             {"arm_m", load.arm_m},
                             {"falls", falls}});
        }
        things.push_back({{"parts", thing.parts}, {"fixed", thing.fixed}, {"holds", holds}});
    }
    judge_by_script("holds", nlohmann::json{{"friction", blow_friction},
                                            {"voxel_m", blow_voxel_m},
                                            {"density_kg_m3", 700},
                                            {"things", things}});
}

TEST(Holds, UpsetWhatTheyUpsetInMujoco) {
    judge_holds(10);
}

// Takes a minute.
TEST(Holds, DISABLED_OfThirtyThings) {
    judge_holds(30);
}

}  // namespace
}  // namespace topple::exports::test

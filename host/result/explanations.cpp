// SPDX-License-Identifier: MIT
#include "result/explanations.h"

#include <cmath>
#include <numbers>

#include "physics/fall_sweep.h"

namespace topple {

double azimuth_deg(const Vec3& way) {
    const double degrees = std::atan2(way[0], way[1]) * 180 / std::numbers::pi;
    return degrees < 0 ? degrees + 360 : degrees;
}

void explain(const ObjectStage& objects, const ToInput& to_input, Scene& scene) {
    for (std::size_t o = 0; o < scene.objects.size(); ++o) {
        const Body& from = objects.objects[o];
        Object& object = scene.objects[o];
        Why& why = object.why;
        if (from.grounded) continue;
        const physics::Instability& step = from.instability;
        if (step.weakest != Vec3{}) why.azimuth_deg = azimuth_deg(step.weakest);
        if (step.edge)
            why.edge_m = {to_input.place((*step.edge)[0]), to_input.place((*step.edge)[1])};
        why.W_J = object.barrier_J;
        why.S_J = object.release_J;
        if (object.mode == "slide") why.way_m = from.sliding.distance_m;
        why.drop_m = step.drop_m;
        if (step.drop_m > 0 && step.onto >= 0)
            why.lands_on = objects.object_of_primitive[static_cast<std::size_t>(step.onto)];
    }
}

void predict_falls(const ObjectStage& objects, const SafetyStage& safety, const ToInput& to_input,
                   Scene& scene) {
    for (std::size_t o = 0; o < scene.objects.size(); ++o) {
        Object& object = scene.objects[o];
        const Body& from = objects.objects[o];
        object.fall.lands_m = object.center_of_mass_m;
        if (from.grounded) continue;
        object.fall.takes_along = safety.landings[o].takes_along;
        for (const auto& [name, chance] : object.fall_chance)
            object.fall.falls = object.fall.falls || chance > 0;
        const physics::Swept& swept = safety.landings[o].swept;
        object.fall.hits_J = safety.landings[o].hits_J;
        if (o < safety.people_share.size()) object.fall.people_share = safety.people_share[o];
        object.fall.lands_m = to_input.place(swept.center);
        object.fall.drop_m = swept.stopped ? 0 : safety.landings[o].drop_m;
        const bool elsewhere = swept.stopped || !safety.landings[o].on_easiest;
        object.fall.lands_on = elsewhere ? -1 : object.why.lands_on;
        if (swept.by >= 0)
            object.fall.leans_on = objects.object_of_primitive[static_cast<std::size_t>(swept.by)];
        const Suggestion& what = safety.advice[o];
        static constexpr std::array kinds{"", "see", "check", "move", "fix"};
        object.advice.kind = kinds[static_cast<std::size_t>(what.kind)];
        object.advice.move_m = to_input.way(what.move_m);
        object.advice.risk_J = what.risk_J;
        object.advice.hold_N = what.hold.force_N;
        object.advice.hold_height_m = what.hold.height_m;
    }
}

}  // namespace topple

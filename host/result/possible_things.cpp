// SPDX-License-Identifier: MIT
#include "result/possible_things.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <ranges>

#include "core/vectors.h"
#include "io/text.h"

namespace topple {
namespace {

constexpr std::size_t listed = 3;

// Of its largest risk, joules.
double expected_J(const PossibleThing& thing) {
    double largest = 0;
    for (const auto& [name, risk_J] : thing.risk_J) largest = std::max(largest, risk_J);
    return thing.probability * largest;
}

std::string in_text(const PossibleThing& thing) {
    Vec3 middle = thing.box_middle_m;
    for (double& v : middle) v = std::round(100 * v) / 100 + 0.0;
    std::string text;
    for (const double side : thing.size_m)
        text += (text.empty() ? "" : " x ") + short_number(std::round(100 * side) / 100);
    return text + " m about " + io::vector_text(middle) + ", " +
           io::two_digits(100 * thing.probability) + " % likely";
}

// The middle of the cell of each primitive that is nearest to its centre. Grid frame.
Table<PrimitiveId, Vec3> spots(const SolidCells& cells,
                               TableView<PrimitiveId, physics::MassProperties> bodies) {
    Table<PrimitiveId, Vec3> out(bodies.size());
    Table<PrimitiveId, double> nearest(bodies.size(), HUGE_VAL);
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const PrimitiveId p = cells.primitive[n];
        if (p < 0) continue;
        const Vec3 middle{(cells.i[n] + 0.5) * cells.voxel_m, (cells.j[n] + 0.5) * cells.voxel_m,
                          (cells.k[n] + 0.5) * cells.voxel_m};
        const Vec3 way = minus(middle, bodies[p].center);
        if (!(dot(way, way) < nearest[p])) continue;
        nearest[p] = dot(way, way);
        out[p] = middle;
    }
    return out;
}

}  // namespace

std::vector<PossibleThing> possible_things(const SolidCells& cells, const ObjectStage& objects,
                                           const SafetyStage& safety, const ToInput& to_input) {
    std::vector<PossibleThing> out;
    if (objects.possible_things.empty()) return out;
    const Table<PrimitiveId, Vec3> spot = spots(cells, objects.bodies);
    for (std::size_t n = 0; n < objects.possible_things.size(); ++n) {
        const Body& from = objects.possible_things[n].body;
        PossibleThing& to = out.emplace_back();
        to.primitives = from.candidate.primitives;
        for (const std::int32_t p : to.primitives) to.spots_m.push_back(to_input.place(spot[p]));
        to.probability = objects.possible_things[n].probability;
        to.size_m = from.box.size_m;
        to.box_middle_m = to_input.place(from.box.middle_m);
        to.mass_kg = from.candidate.body.mass_kg;
        to.barrier_J = from.instability.barrier_J;
        to.barrier_error_J = from.barrier_error_J;
        for (std::size_t d = 0; d < safety.disturbances.size(); ++d)
            to.risk_J[safety.disturbances[d].name] = safety.possible_risk[d][n].mean_J;
        if (from.seen_enough() && !safety.disturbances.empty())
            to.unsafety_category = safety::to_string(safety.possible_category[n].worst());
    }
    std::ranges::stable_sort(out, std::ranges::greater{}, expected_J);
    return out;
}

std::string possible_things_note(std::span<const PossibleThing> things) {
    std::vector<const PossibleThing*> told;
    for (const PossibleThing& thing : things)
        if (thing.unsafety_category == "medium" || thing.unsafety_category == "high")
            told.push_back(&thing);
    if (told.empty()) return {};
    std::string text = "The building holds " + io::counted(told.size(), "piece") +
                       (told.size() == 1 ? " that may be a thing" : " that may be things") +
                       ", and then can fall: ";
    for (std::size_t n = 0; n < std::min(listed, told.size()); ++n)
        text += (n ? "; " : "") + in_text(*told[n]);
    if (told.size() > listed) text += "; and others (`possible_things`)";
    return text +
           ". Of what is one tick the parts in the report, or say `one_thing` and `apart` in "
           "corrections (--corrections), with all its `spots_m` of scene.json and a spot on the "
           "floor; of what is none say `fixed`.";
}

}  // namespace topple

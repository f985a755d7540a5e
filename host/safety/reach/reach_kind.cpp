// SPDX-License-Identifier: MIT
#include <algorithm>

#include "safety/reach/reach_field.h"

namespace topple::safety {
namespace {

std::vector<const PersonKind*> reaching(const ParseOptions& options) {
    std::vector<const PersonKind*> out;
    for (const std::string& name : options.people)
        if (const PersonKind& kind = person_kind(name); kind.reaches()) out.push_back(&kind);
    return out;
}

}  // namespace

const DisturbanceKind& reach_kind() {
    static const DisturbanceKind kind{
        .name = "reach",
        .words = {.cause = "someone reaching for it",
                  .event = "hold",
                  .one_event = "one person who takes hold of something in reach",
                  .column = "reach",
                  .doing = "taking hold of what is in reach",
                  .mend = "Fasten it to the wall, lock it, or keep it out of reach",
                  .push = "the hold of someone who pulls at it or climbs",
                  .arrows = {.strength = DisturbanceWords::Arrows::Strength::visits,
                             .at_tip = false,
                             .below_things = false,
                             .title = "Within reach",
                             .says = "What can be reached from the floor, and which way it is "
                                     "pulled.",
                             .legend = "how often it is taken hold of there",
                             .scale = 100,
                             .unit = "times in 100 holds"},
                  .figure = {"pull_N", " with up to ", "pull", "N"},
                  .light_mend = "Put it out of reach, or fasten it",
                  .large_mend = "Take it out of the room, or fasten it",
                  .high_mend = "Put it out of reach"},
        .field =
            [](device::Device& device, const Surroundings& surroundings,
               std::span<const RiskObject> objects, const ParseOptions& options) {
                return reach_field(device, surroundings, objects, reaching(options));
            },
        .events =
            [](const ParseOptions& options) {
                double most = 0;
                for (const PersonKind* kind : reaching(options))
                    most = std::max({most, kind->pull_N, kind->push_N});
                return std::map<std::string, double>{{"pull_N", most}};
            },
        .acts = [](const ParseOptions& options) { return !reaching(options).empty(); }};
    return kind;
}

}  // namespace topple::safety

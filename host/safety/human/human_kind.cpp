// SPDX-License-Identifier: MIT
#include "safety/human/human_field.h"
#include "safety/people.h"

namespace topple::safety {

const DisturbanceKind& human_kind() {
    static const DisturbanceKind kind{
        .name = "human",
        .words = {.cause = "people walking by",
                  .event = "walk",
                  .one_event = "one person walking through the room",
                  .column = "walk",
                  .doing = "walking people through the room",
                  .mend = "Keep the way past it clear, or fasten it",
                  .push = "the push of a person who walks into it",
                  // Where as many come as go, the mean of their speeds is small.
                  .arrows = {.strength = DisturbanceWords::Arrows::Strength::visits,
                             .at_tip = false,
                             .below_things = false,
                             .title = "People walking by",
                             .says = "Which way their bodies pass, and how often: this is what "
                                     "knocks things over.",
                             .legend = "how often people\u2019s bodies pass there",
                             .scale = 100,
                             .unit = "times in 100 walks"},
                  .figure = {"walks", "", "walks", ""},
                  .free_mend = "Keep the way past it clear, take it out, or bolt it to the floor"},
        .field =
            [](device::Device& device, const Surroundings& surroundings,
               std::span<const RiskObject> objects, const ParseOptions& options) {
                std::vector<HumanOptions> kinds;
                for (const std::string& name : options.people) {
                    kinds.push_back(walker(person_kind(name), options));
                    kinds.back().over_space = options.space_fields;
                }
                return people_field(device, surroundings, objects, kinds);
            },
        .events =
            [](const ParseOptions& options) {
                return std::map<std::string, double>{{"walks", options.walks}};
            },
        .everyday = true};
    return kind;
}

}  // namespace topple::safety

// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "safety/human/human_field.h"

// Who may be in a room: kinds of people, as they walk and as they reach for things.
namespace topple::safety {

struct PersonKind {
    const char* name;  // as it is given, and in sentences: "toddlers"
    double height_m, mass_kg, walking_speed_m_s;
    double body_radius_m, step_height_m;  // as HumanOptions
    std::span<const BodyPart> parts;      // that move along, as fractions of height and mass
    // Things that it gets hold of stand within arm_m of its middle, between these heights above the
    // floor; it pulls at them and leans on them so hard. 0 N: it does not reach for things.
    double reach_low_m, reach_high_m, arm_m, pull_N, push_N;
    bool climbs;
    double falls;       // against what is in reach, as often as any other act
    double shoulder_m;  // no higher than which it strikes then

    bool reaches() const { return pull_N > 0; }
};

// Adults first: who walks where nobody says otherwise.
std::span<const PersonKind> person_kinds();
// Throws Error(usage) that names those that there are.
const PersonKind& person_kind(std::string_view name);

// How one of that kind walks.
HumanOptions walker(const PersonKind& kind);
// By the given seed, walks and recordings, too. Recorded bodies are as large as they were for
// adults, else as large as the kind; who rolls is not recorded walking.
HumanOptions walker(const PersonKind& kind, const ParseOptions& options);

}  // namespace topple::safety

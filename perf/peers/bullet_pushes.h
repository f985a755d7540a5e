// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "perf/standing_objects.h"

// What it takes Bullet to find the least blows that topple objects. nullopt where the build found
// none.
namespace topple::perf {

struct PeerPushes {
    std::string library;           // its name and version
    double seconds = 0;            // wall time
    std::vector<double> energy_J;  // by object
};
std::optional<PeerPushes> bullet_pushes(const std::vector<simulation::StandingObject>& objects);

}  // namespace topple::perf

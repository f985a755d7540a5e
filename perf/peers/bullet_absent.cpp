// SPDX-License-Identifier: MIT
#include "perf/peers/bullet_pushes.h"

// Stands for bullet_pushes.cpp where the build found no Bullet.
namespace topple::perf {

std::optional<PeerPushes> bullet_pushes(const std::vector<simulation::StandingObject>&) {
    return std::nullopt;
}

}  // namespace topple::perf

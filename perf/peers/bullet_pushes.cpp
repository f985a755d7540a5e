// SPDX-License-Identifier: MIT
#include "perf/peers/bullet_pushes.h"

#include <LinearMath/btScalar.h>

#include <chrono>

#include "simulation/pushes.h"

namespace topple::perf {

std::optional<PeerPushes> bullet_pushes(const std::vector<simulation::StandingObject>& objects) {
    PeerPushes out;
    out.library = "Bullet " + std::to_string(btGetVersion() / 100) + "." +
                  std::to_string(btGetVersion() % 100);
    const auto start = std::chrono::steady_clock::now();
    for (const simulation::StandingObject& object : objects)
        out.energy_J.push_back(simulation::weakest_blow_J(object));
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return out;
}

}  // namespace topple::perf

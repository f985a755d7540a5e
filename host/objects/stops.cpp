// SPDX-License-Identifier: MIT
#include "objects/stops.h"

namespace topple {

Stops::Stops(const ObjectStage& stage)
    : stage_(stage),
      fixed_(fixed_primitives(stage.object_of_primitive, stage.objects)),
      carriers_(stage.objects.size()) {
    for (const Support& s : stage.supports) carriers_[s.supported].push_back(s.supporter);
}

std::vector<bool> Stops::of(std::span<const std::int32_t> primitives, double mass_kg) const {
    std::vector<bool> out = fixed_;
    std::vector<bool> seen(stage_.objects.size());
    std::vector<std::int32_t> carried;
    const auto carry = [&](std::int32_t o) {
        if (o < 0 || seen[o]) return;
        seen[o] = true;
        carried.push_back(o);
    };
    for (const std::int32_t p : primitives) carry(stage_.object_of_primitive[p]);
    const std::size_t own = carried.size();
    for (std::size_t n = 0; n < carried.size(); ++n) {
        const Body& on = stage_.objects[carried[n]];
        if (on.grounded) continue;
        for (const std::int32_t by : carriers_[carried[n]]) carry(by);
        if (n < own || on.candidate.body.mass_kg < mass_kg) continue;
        for (const std::int32_t p : on.candidate.primitives) out[p] = true;
    }
    return out;
}

}  // namespace topple

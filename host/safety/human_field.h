// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "safety/fields.h"

namespace topple::safety {

// Where else an object might stand: its cells moved by whole voxels.
struct Placement {
    std::size_t object = 0;
    std::int32_t di = 0, dj = 0;
    RiskObject there;  // how it falls from there
};

// The field of people who walk, kept for more than one question. Holds references to all that it
// is made from.
class HumanField {
  public:
    HumanField(device::Device& device, const Surroundings& surroundings,
               std::span<const RiskObject> objects, const HumanOptions& options);
    ~HumanField();

    Disturbance disturbance();
    // The risk of an object that stood elsewhere, by placement: walkers keep to their paths, and
    // everything else, the object where it stood included, stays in their way.
    std::vector<Risk> risk_at(std::span<const Placement> placements);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace topple::safety

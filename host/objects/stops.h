// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "objects/object_stage.h"

namespace topple {

// What does not give way to what falls against it: the building, and what carries the falling body,
// itself or by other things, and is no lighter.
class Stops {
  public:
    // Keeps a reference. Of the stage its objects' masses and supports must be known.
    explicit Stops(const ObjectStage& stage);
    // By primitive; of a body of these primitives.
    std::vector<bool> of(std::span<const std::int32_t> primitives, double mass_kg) const;

  private:
    const ObjectStage& stage_;
    Table<PrimitiveId, bool> fixed_;
    Table<ObjectId, std::vector<std::int32_t>> carriers_;
};

}  // namespace topple

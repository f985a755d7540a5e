// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/solid_scene.h"
#include "graph/undersides.h"
#include "objects/object_stage.h"
#include "physics/body_errors.h"

namespace topple {

// What a set of primitives is as one body: its mass, and how it is held. Keeps references: the
// masses, contacts and floors of the stage are looked up when a body is made.
class BodyMaker {
  public:
    // shell: see graph::candidate_of. sensed: whether it is known what sensors saw.
    BodyMaker(const SolidScene& solids, const ObjectStage& stage,
              const Table<PrimitiveId, bool>& shell, bool sensed);

    // columns: the undersides of what it is made of. Its inertia is the caller's to find out.
    Body made(std::vector<std::int32_t> primitives, const std::vector<graph::Underside>& columns,
              bool grounded) const;

  private:
    const BoundaryCells& boundary_;
    const ObjectStage& stage_;
    const Table<PrimitiveId, bool>& shell_;
    bool sensed_;
    std::vector<physics::VolumeError> errors_;
};

}  // namespace topple

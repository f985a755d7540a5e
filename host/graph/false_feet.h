// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/object_of.h"
#include "core/solid_scene.h"

namespace topple::graph {

// The solids, with cells of no primitive that are no feet of their objects, though they lie below
// all else of them: what nobody saw, and what hangs together with nothing that was seen of the
// object, not even across a gap of some voxels up or down. Rays of the filling pass from a cup
// through the bed on which it stands and take the space below that for more of the cup. Nor are
// feet cells of which the surfaces that bound the object leave nothing, where these reach further
// below all else of it than noise does.
// grounded: the object that is left as it is; -1: none. The same solids where there are none.
std::shared_ptr<const SolidScene> without_false_feet(
    const std::shared_ptr<const SolidScene>& solids, ObjectOf object_of_primitive,
    std::int32_t grounded);

}  // namespace topple::graph

// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "export/convex_part.h"
#include "export/visual.h"

namespace topple::exports {

// A rigid body of a simulation. World frame: z up, metres.
struct Body {
    std::int32_t object = -1;
    bool fixed = false;  // of the world, which nothing moves
    // How far up it stands: above all that carries it; 0 for what is fixed.
    int level = 0;
    std::vector<std::int32_t> carried_by;  // places in the list of bodies
    std::vector<ConvexPart> parts;         // convex, together its collision shape
    double solid_m3 = 0;                   // of what was parsed
    double mass_kg = 0;
    Vec3 center_m{};  // of mass
    Mat3 inertia_kg_m2{};
    Vec3 moved_m{};      // by settling
    double lost_m3 = 0;  // of its parts, so that they lie in no other body's
    // How far inside its footing its centre of mass stands, by its barrier; 0: it falls by itself.
    double firm_m = 0;
    double friction = 0;  // coefficient; if not above 0, the scene's
    bool has_own_friction() const { return friction > 0; }
    double friction_or(double of_scene) const { return has_own_friction() ? friction : of_scene; }
    int struts = 0;  // of its parts: feet that were not seen
    // Its footing was not seen, or was cut away as it lay in others: it stands on a pad made for
    // it, or is held where it is.
    bool on_pad = false, held = false;
    Visual visual;  // empty: it has no other look than its parts
};

}  // namespace topple::exports

// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "safety/disturbances.h"
#include "safety/fields.h"
#include "safety/human/body_parts.h"
#include "topple/motion.h"

namespace topple::safety {

struct HumanOptions {
    std::uint64_t seed = 1;
    unsigned paths = 500;
    double cell_m = 0.05;  // of the walkable map and of the field
    double body_radius_m = 0.20;
    double body_height_m = 1.8;
    double step_height_m = 0.05;   // obstacles up to this height don't stop a walker
    double largest_hole_m = 0.30;  // holes in the scanned floor up to this width are bridged
    double body_mass_kg = 70;
    double walking_speed_m_s = 1.3;
    double wander_m = 0.20;    // how far walkers stray sideways from their path, at most
    double restitution = 0.5;  // of a body's part that strikes a thing
    // How the bodies of walkers move, each as often as the others; none: as in the table of parts.
    std::vector<std::shared_ptr<const BodyMotion>> motions;
    std::span<const BodyPart> parts = body_parts;
    bool over_space = false;  // Disturbance::space is wanted
};

inline constexpr unsigned max_shown_paths = 100;  // walks whose way the report draws

// People who walk between random places (5.1.2): 500 shortest paths give the primary motion, a
// table of body parts (body_parts.h) the secondary; their convolution (kernels disturbance_reach,
// disturbance) the passes of each part through each cell per walk. W is what a thing of mass M
// takes over of m v^2 / 2 of the part (5.2): (1 + e)^2 m M / (m + M)^2 of it. One event is one
// walk. Nothing walkable, no object: an empty field, and a note that says why. Asked what elsewhere
// would be, walkers keep to their paths, and everything else, the object where it stood included,
// stays in their way.
Disturbance human_field(device::Device& device, const Surroundings& surroundings,
                        std::span<const RiskObject> objects, const HumanOptions& options);
// Of several kinds of people, each of whom walks as often as the others.
Disturbance people_field(device::Device& device, const Surroundings& surroundings,
                         std::span<const RiskObject> objects, std::span<const HumanOptions> kinds);

const DisturbanceKind& human_kind();

}  // namespace topple::safety

// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "device/device.h"
#include "graph/contact_graph.h"
#include "graph/scene_prior.h"
#include "physics/landscape.h"

// Grouping primitives into objects that stand (paper, 4.1).
namespace topple::graph {

struct GroupingOptions {
    std::uint64_t seed = 1;
    // The disturbance W of Eq. 8, for each object: the work that tilts it by this angle, or its
    // support, degrees. Standards for the stability of furniture and lamps ask for 6 to 15; what a
    // smaller tilt knocks over is no object on its own.
    double tilt_deg = 10;
    // Unit of instability, metres: an object that would release m g * scale_m counts 1.
    double scale_m = 0.3;
    double worst_instability = 3;  // cap, in those units
    // T of Eq. 10: q_e = exp(-F / T), clipped to [0.05, 0.95].
    double turn_on_temperature = 0.5;
    ScenePrior::Weights prior;
    double time_limit_s = 0;  // see SwendsenWangOptions
    std::function<bool()> cancelled;
};

struct Grouping {
    std::vector<std::int32_t> group;       // of each primitive; -1: fixed to the ground
    std::vector<double> pair_probability;  // by pair of the contact graph: that the joint is fixed
    // By group: share of the sampler's chains that found it, but for a tenth of its primitives.
    std::vector<double> agreement;
    std::vector<double> energy_curve;  // best energy after each step of the annealing
};

// The rigid body that a set of primitives makes: its mass properties, and where it is held up by
// what is not part of it. What something below carries is held as well where it touches the room's
// shell at a height no less than its centre of mass: a ladder leans on its wall.
// ground: by primitive, true for the shell.
physics::Candidate candidate_of(const ContactGraph& graph, std::span<const physics::Body> bodies,
                                const std::vector<bool>& ground,
                                std::vector<std::int32_t> primitives);

// Height that the body falls before it meets something, metres, where nothing holds it up.
double free_fall_m(const ContactGraph& graph, std::span<const std::int32_t> primitives);

// ground: by primitive, true for the room's shell. Minimises Eq. 8 by Swendsen-Wang cuts; with the
// sign of its penalty such that joints which take freedom away cost energy.
Grouping group_primitives(device::Device& device, const physics::SupportTable& table,
                          const SolidCells& cells, const ContactGraph& graph,
                          std::span<const physics::Body> bodies, const SurfaceSeams& seams,
                          const std::vector<bool>& ground, const GroupingOptions& options);

}  // namespace topple::graph

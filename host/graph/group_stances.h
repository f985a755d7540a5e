// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/table.h"
#include "graph/contact_graph.h"
#include "graph/stamped_set.h"
#include "graph/swendsen_wang.h"
#include "topple/kernels/buffer.h"

namespace topple::graph {

// How a group of primitives would stand by itself. Grid frame, metres.
struct Stance {
    double mass_kg = 0;
    double height_m = 0;  // of its centre of mass above the lowest contact that holds it
    // Of the centre of mass inside of the support polygon, -infinity where nothing holds it.
    double margin_m = -std::numeric_limits<double>::infinity();
};

// S(O, W) in nats: -ln P(the body stays where it is under a disturbance of W = level m g h), where
// the border of its support is known to about `noise_m`. To stay, its centre of mass must be so far
// inside of its support that tipping over the nearest edge takes W. At level 0 what stands, however
// precariously, costs next to nothing; what lies on nothing that was seen costs most, but no more
// than scans hide supports.
double standing_cost(const Stance& stance, double noise_m, double level = 0);

// Stances of many groups at a time (kernel group_stance). What something below carries is held as
// well where it touches the room's shell at a height no less than its centre of mass: a ladder
// leans on its wall. A margin is exact in 64 directions, and between two of them too large by no
// more than a thousandth of itself and 1/40 of an edge. Keeps references to its arguments.
class GroupStances {
  public:
    GroupStances(device::Device& device, const ContactGraph& contacts,
                 TableView<PrimitiveId, physics::MassProperties> bodies,
                 const Table<PrimitiveId, bool>& shell);

    // From one thread at a time.
    std::vector<Stance> of(std::span<const GroupQuery> groups);

  private:
    struct Batch {
        std::vector<std::uint32_t> first{0}, footing;
        std::vector<float> x, y;
    };
    Stance add(const GroupQuery& group, Batch& batch);
    std::vector<float> margins(const Batch& batch);

    device::Device& device_;
    const ContactGraph& contacts_;
    TableView<PrimitiveId, physics::MassProperties> bodies_;
    const Table<PrimitiveId, bool>& shell_;
    double origin_[2] = {};  // of what the device gets: floats are exact nearby
    StampedSet members_;
    device::Buffer<float> reach_, ux_, uy_, x_, y_, margin_;
    device::Buffer<std::uint32_t> first_, footing_;
};

}  // namespace topple::graph

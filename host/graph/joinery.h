// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "graph/contact_graph.h"
#include "graph/surface_seams.h"
#include "physics/bodies.h"

namespace topple::graph {

// How surely primitives that touch are made in one piece, by what things that merely stand on or
// beside one another hardly ever do:
//   flush    their faces are in line, see SurfaceSeams;
//   mated    a side of the one is covered by the other, as a shelf's board ends at its sides and a
//            sofa's back at its seat: what is put beside something leaves a gap or shows an edge;
//   legs     the one carries the other together with more such, none of which could alone.
// And how surely they were not: a ledge between them, see SurfaceSeams, unless the one is a leg.
// The room's shell mates with nothing: furniture is pushed against it.
class Joinery {
  public:
    Joinery(const ContactGraph& graph, std::span<const physics::Body> bodies,
            const SurfaceSeams& seams, const std::vector<bool>& ground);

    // -1 to 1; 0 for two that don't touch.
    double made_as_one(std::int32_t a, std::int32_t b) const;

  private:
    void raise(std::int32_t a, std::int32_t b, double value);
    std::map<std::pair<std::int32_t, std::int32_t>, double> one_;  // (a, b), a < b
};

}  // namespace topple::graph

// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/object_of.h"
#include "core/table.h"
#include "graph/contact_graph.h"
#include "graph/undersides.h"
#include "topple/scene.h"

// Which object carries which (paper, 4.2), with the probability that it is so. Grid frame.
namespace topple::graph {

// By object.
struct Carried {
    bool grounded = false;
    double mass_kg = 0;
};

// Two objects with contacts that may carry, A below B, are taken to be one that carries another
// with the log-odds
//
//     b0 + b1 ln(m_A / m_B) + b2 ln(1 + n) - b3 logit(j),
//
// m their masses, n the columns of voxels in which B lies above A, the mean of those in contact and
// of those with a gap that noise may leave, j the probability of the likeliest joint between them:
// pieces of one thing lie on each other, too, but do not carry. Fitted on generated rooms.
//
// Returned are those likelier than not, and of what stands on nothing such its likeliest supporter,
// if that is likely enough: sorted by (supporter, supported). The ground carries and is not
// carried. Two may carry one another; of a longer round the least likely support is left out.
//   pair_probability  of each of the contacts' pairs, that both are one
//   columns           undersides of each object
std::vector<Support> find_supports(const ContactGraph& contacts,
                                   std::span<const double> pair_probability, ObjectOf object_of,
                                   TableView<ObjectId, Carried> objects,
                                   const Table<ObjectId, std::vector<Underside>>& columns);

}  // namespace topple::graph

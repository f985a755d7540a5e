// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "graph/contact_graph.h"
#include "graph/joinery.h"
#include "graph/surface_seams.h"
#include "graph/swendsen_wang.h"
#include "physics/bodies.h"

namespace topple::graph {

// The scene prior F(O) of a group (paper, Eq. 9), a penalty:
//   f1  share of the scene's voxels, to the power `size_exponent`. With exponent 1 its sum would be
//       the same for every partition; above 1 it prefers smaller objects.
//   f2  mean of 1 - n.n' over neighbouring surface elements of the group, across its primitives
//       too.
//   f3  lost freedom: for each pair of its primitives of which one carries the other, how small the
//       contact is beside the mean level section of the carrier, on a logarithmic scale. Gluing a
//       cup to a table top costs much, gluing a table top to its leg nothing. The same for touching
//       a wall, by the thing's own face there. What hangs on others only by joints at its sides
//       loses as much as the strongest of them is weak, by the mean of the two faces. Parts
//       that were made as one have no freedom to lose.
//   f4  (ours) minus how surely its pairs of primitives were made as one, see Joinery.
class ScenePrior {
  public:
    struct Weights {
        double size = 0.1, complexity = 0.1, freedom = 0.7;  // lambda 1 to 3 of the paper
        double made_as_one = 0.3;
        double size_exponent = 2;
    };
    ScenePrior(const ContactGraph& graph, std::span<const physics::Body> bodies,
               const SurfaceSeams& seams, const std::vector<bool>& ground, const Weights& weights);

    double operator()(const Group& group) const;

    // Freedom lost by fixing two primitives that touch to one another, 0 to 1.
    double lost_between(std::int32_t a, std::int32_t b) const;

  private:
    struct Joint {
        std::int32_t other;
        double lost;
    };
    void add_carrying(const Carrying& carrying);
    void add_touching(const physics::TouchingPair& pair);
    double held_at_sides(const Group& group) const;

    const ContactGraph& graph_;
    const SurfaceSeams& seams_;
    Joinery joinery_;
    const std::vector<bool>& ground_;
    Weights weights_;
    std::vector<double> volume_share_;
    // By primitive: what carries it, and the shell beside it; and what touches its side.
    std::vector<std::vector<Joint>> carriers_, sides_;
    std::vector<std::vector<std::int32_t>> loads_;  // by primitive: what it carries
    // By the lower primitive of each pair that touches or has a common seam.
    struct Neighbour {
        std::int32_t other;
        Seam seam;
        double made_as_one;
    };
    std::vector<std::vector<Neighbour>> between_;
};

}  // namespace topple::graph

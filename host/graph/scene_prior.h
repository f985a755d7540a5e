// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
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
//   f3  lost freedom. A joint by which one primitive carries the other takes the more, the smaller
//       its area is beside the mean level section of the carrier, on a logarithmic scale: gluing a
//       cup to a table top costs much, gluing a table top to its leg nothing. Joints at sides
//       take from both, by the face of each, those with a wall from the thing, by its own face.
//       Parts that were made as one have no freedom to lose. n primitives are held together by n -
//       1 joints; the group pays for those that take least (its minimum spanning tree), since
//       others have nothing left to take. A scrap of a few voxels, mostly noise between two things,
//       hangs on one of them and holds none together. Joints with the shell all count: furniture
//       stands in a room without being fixed to it, whatever it touches.
//   f4  (ours) minus how surely its pairs of primitives were made as one, or were not, see
//       Joinery.
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

    // Freedom lost by fixing two primitives that touch to one another: 0 to 1 for each that loses
    // some, so up to 2.
    double lost_between(std::int32_t a, std::int32_t b) const;

  private:
    // A joint with its place among all joints by rising loss, so that sorting places sorts joints.
    struct RankedJoint {
        double lost;
        std::int32_t a, b;
    };
    // From the lower primitive of two that touch or have a common seam.
    struct Neighbour {
        std::int32_t other;
        Seam seam;
        double made_as_one;
        std::int64_t rank;  // of their joint; -1: none
    };
    using Ranks = std::map<std::pair<std::int32_t, std::int32_t>, std::int64_t>;
    Ranks find_joints();
    double lost_by_carrying(const Carrying& carrying) const;
    double lost_by_touching(const physics::TouchingPair& pair) const;
    bool is_shell(std::int32_t n) const { return ground_[static_cast<std::size_t>(n)]; }
    struct Scratch;
    double lost_among_parts(const Group& group, Scratch& scratch) const;
    bool hang(const RankedJoint& joint, Scratch& scratch) const;

    const ContactGraph& graph_;
    const SurfaceSeams& seams_;
    Joinery joinery_;
    const std::vector<bool>& ground_;
    Weights weights_;
    std::vector<double> volume_share_;
    std::vector<bool> scrap_;
    std::vector<RankedJoint> by_rank_;
    std::map<std::pair<std::int32_t, std::int32_t>, double> lost_;  // (a, b), a < b
    std::vector<std::vector<Neighbour>> neighbours_;
};

}  // namespace topple::graph

// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "graph/contact_graph.h"
#include "graph/swendsen_wang.h"
#include "physics/bodies.h"

namespace topple::graph {

// Sum and count of 1 - n.n' over pairs of neighbouring surface elements, inside primitives and
// across the border of two.
struct NormalVariation {
    struct Sum {
        double sum = 0;
        std::uint64_t pairs = 0;
    };
    std::vector<Sum> inside;                                       // by primitive
    std::map<std::pair<std::int32_t, std::int32_t>, Sum> between;  // (a, b), a < b
};

// The scene prior F(O) of a group (paper, Eq. 9), a penalty:
//   f1  share of the scene's voxels, to the power `size_exponent`. With exponent 1 its sum would be
//   the
//       same for every partition; above 1 it prefers smaller objects.
//   f2  mean of 1 - n.n' over neighbouring surface elements of the group, across its primitives
//   too. f3  lost freedom: for each pair of its primitives of which one carries the other,
//       1 - contact area / area of the carrier seen from above. Gluing a cup to a table top costs
//       almost 1, gluing a table top to its leg almost nothing.
class ScenePrior {
  public:
    struct Weights {
        double size = 0.1, complexity = 0.1, freedom = 0.7;  // lambda 1 to 3 of the paper
        double size_exponent = 2;
    };
    ScenePrior(const ContactGraph& graph, std::span<const physics::Body> bodies,
               const NormalVariation& variation, const std::vector<bool>& ground,
               const Weights& weights);

    double operator()(const Group& group) const;

  private:
    struct Freedom {
        std::int32_t supporter;
        double lost;
    };
    const NormalVariation& variation_;
    Weights weights_;
    std::vector<double> volume_share_;
    std::vector<std::vector<Freedom>> freedoms_;  // by supported primitive
    // Variation across borders, by the lower primitive of the pair: the higher, and the sum.
    std::vector<std::vector<std::pair<std::int32_t, NormalVariation::Sum>>> between_;
};

}  // namespace topple::graph

// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/cell_columns.h"
#include "device/device.h"
#include "graph/contact_graph.h"
#include "graph/scene_prior.h"
#include "graph/stable_objects.h"
#include "graph/swendsen_wang.h"
#include "physics/landscape.h"

namespace topple::graph {

// The energy of groups of primitives (Eq. 8): how much falls when the group is tilted, and the
// scene prior. Keeps references to its arguments.
class GroupEnergy {
  public:
    GroupEnergy(device::Device& device, const physics::SupportTable& table, const SolidCells& cells,
                const ContactGraph& graph, std::span<const physics::Body> bodies,
                const SurfaceSeams& seams, const std::vector<bool>& ground,
                const GroupingOptions& options);

    // One energy for each query, as one batch on the device. Not from two threads at a time.
    void operator()(std::span<const GroupQuery> queries, std::span<double> energies) const;
    const ScenePrior& prior() const { return prior_; }
    // This energy with its bounds, for the sampler.
    GroupEnergies callbacks() const;

  private:
    std::optional<physics::Candidate> unstable_body(const GroupQuery& query) const;
    double fall_m(const physics::Candidate& body) const;
    double instability(double released_m) const;

    device::Device& device_;
    const physics::SupportTable& table_;
    const SolidCells& cells_;
    const ContactGraph& graph_;
    std::span<const physics::Body> bodies_;
    const std::vector<bool>& ground_;
    const GroupingOptions& options_;
    ScenePrior prior_;
    CellColumns columns_;
    double tilt_;  // radians
};

}  // namespace topple::graph

// SPDX-License-Identifier: MIT
#include "graph/joints.h"

#include "fitted/boosted_trees.h"
#include "graph/joint_features.h"

namespace topple::graph {

std::vector<Joint> find_joints(const geometry::SurfaceSamples& samples,
                               const geometry::PrimitiveShapes& shapes,
                               const ContactGraph& contacts,
                               TableView<PrimitiveId, physics::MassProperties> bodies,
                               const geometry::SurfaceSeams& seams,
                               TableView<PrimitiveId, float> shell, ThreadPool& threads) {
    const JointTable table =
        joint_features(samples, shapes, contacts, bodies, seams, shell, threads);
    const fitted::BoostedTrees& model = fitted::joint_model(joint_feature_names());
    const std::size_t width = joint_feature_names().size();
    std::vector<Joint> out(table.pairs.size());
    threads.each(out.size(), 64, [&](std::size_t n) {
        const auto row = std::span(table.rows).subspan(n * width, width);
        // No model knows more than one part in a thousand.
        const double odds = fitted::log_odds(fitted::probability(model.log_odds(row)));
        out[n] = {table.pairs[n].first, table.pairs[n].second, odds};
    });
    return out;
}

}  // namespace topple::graph

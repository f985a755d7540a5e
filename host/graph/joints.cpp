// SPDX-License-Identifier: MIT
#include "graph/joints.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/ranked.h"
#include "fitted/boosted_trees.h"
#include "graph/joint_context.h"
#include "graph/joint_features.h"

namespace topple::graph {
namespace {

// By a logistic fit on depth images of others' models, as they are and with the correlated noise of
// real sensors. The room's primitives are left out: they are large however noisy a scan is.
constexpr double usual_log_samples = 3.4, doubt_per_unit = 1;

}  // namespace

std::vector<Joint> biased_joints(std::span<const Joint> joints, double bias) {
    std::vector<Joint> out(joints.begin(), joints.end());
    for (Joint& j : out) j.log_odds += bias;
    return out;
}

double doubt_of_fragments(std::vector<std::size_t> samples) {
    const auto count = static_cast<double>(samples.size());
    const auto median = static_cast<double>(std::max<std::size_t>(upper_median(samples), 1));
    const double few = count / (count + 10);  // a few small things are no fragments
    return doubt_per_unit * few * std::max(0.0, usual_log_samples - std::log(median));
}

Judged judge_joints(device::Device& device, const geometry::SurfaceSamples& samples,
                    const geometry::PrimitiveShapes& shapes, const ContactGraph& contacts,
                    TableView<PrimitiveId, physics::MassProperties> bodies,
                    const geometry::SurfaceSeams& seams, TableView<PrimitiveId, double> shell) {
    JointOdds alone;
    std::vector<float> in_shell;
    for (const double odds : shell) {
        const double p = fitted::probability(odds);
        in_shell.push_back(static_cast<float>(p));
        alone.shell.push_back(fitted::log_odds(p));
    }
    const JointTable table =
        joint_features(samples, shapes, contacts, bodies, seams, in_shell, device.threads());
    const fitted::BoostedTrees& model = fitted::joint_model(joint_feature_names());
    const std::size_t width = joint_feature_names().size();
    alone.joints.resize(table.pairs.size());
    device.threads().each(table.pairs.size(), 64, [&](std::size_t n) {
        const auto row = std::span(table.rows).subspan(n * width, width);
        // No model knows more than one part in a thousand.
        alone.joints[n] = fitted::log_odds(fitted::probability(model.log_odds(row)));
    });
    JointOdds amid = in_context(device, shapes, table, alone);
    std::vector<std::size_t> fragments;
    for (std::size_t p = 0; p < shapes.of.size(); ++p)
        if (fitted::probability(amid.shell[p]) <= surely_shell)
            fragments.push_back(shapes.of[p].samples());
    const double doubt = doubt_of_fragments(std::move(fragments));
    Judged out{{}, std::move(amid.shell)};
    for (std::size_t n = 0; n < table.pairs.size(); ++n)
        out.joints.push_back({table.pairs[n].first, table.pairs[n].second, amid.joints[n] - doubt});
    return out;
}

}  // namespace topple::graph

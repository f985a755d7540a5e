// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Models whose weights were fitted on generated scans (tests/fitting/fit.py), each one file beside
// this one, compiled in.
namespace topple::fitted {

// Of a split: its feature, or -1 in a leaf, whose value is `threshold`.
struct TreeNode {
    std::int32_t feature = -1;
    float threshold = 0;  // to the left where the value is no greater
    bool missing_left = false;
    std::uint32_t left = 0, right = 0;  // nodes of the table
};

// A model as the build made it of its file, which it checked (fitted/embed_models.py).
struct TreeTable {
    std::span<const std::string_view> features;
    std::span<const TreeNode> nodes;
    std::span<const std::uint32_t> roots;  // of the trees: nodes
    double baseline = 0, scale = 1, offset = 0;
};

// A calibrated classifier: gradient-boosted trees (Friedman 2001) whose sum is a log-odds, and
// Platt's scaling of that.
class BoostedTrees {
  public:
    // columns: the names of what rows hold, in their order. Throws Error(input), naming `name`,
    // where a feature is no column. Refers to the table.
    BoostedTrees(const TreeTable& table, const std::string& name,
                 std::span<const std::string_view> columns);

    // The calibrated log-odds of one row, NaN where a feature is not known.
    double log_odds(std::span<const float> row) const;

  private:
    TreeTable table_;
    std::vector<std::size_t> column_;  // of each feature
};

// The probability of some log-odds, and back; probabilities are kept away from 0 and 1 by a
// thousandth, for no model knows more.
double probability(double log_odds);
double log_odds(double probability);

// Whether a primitive is part of the room: floor, wall, ceiling or built in. Rows are
// geometry::shell_features(); its names are the columns, always the same ones.
const BoostedTrees& shell_model(std::span<const std::string_view> columns);
// Whether two primitives are one solid object. Rows are graph::joint_features(), likewise.
const BoostedTrees& joint_model(std::span<const std::string_view> columns);
// Whether an object is one thing, whole. Rows are those of graph::whole_probability(), likewise.
const BoostedTrees& whole_model(std::span<const std::string_view> columns);

}  // namespace topple::fitted

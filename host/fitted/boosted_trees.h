// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Models whose weights were fitted on generated scans (tests/fitting/fit.py), each one file beside
// this one, compiled in.
namespace topple::fitted {

// A calibrated classifier: gradient-boosted trees (Friedman 2001) whose sum is a log-odds, and
// Platt's scaling of that.
class BoostedTrees {
  public:
    // json: a file of schema topple.trees/1. Throws Error(input), naming `name`, where it is none.
    BoostedTrees(std::string_view json, const std::string& name);

    std::span<const std::string> features() const { return features_; }
    // The calibrated log-odds of one row of features, NaN where one is not known.
    double log_odds(std::span<const float> row) const;

  private:
    // Of a split: its feature, or -1 in a leaf, whose value is `threshold`.
    struct Node {
        std::int32_t feature = -1;
        float threshold = 0;  // to the left where the value is no greater
        bool missing_left = false;
        std::uint32_t left = 0, right = 0;
    };
    void add_tree(const struct TreeArrays& tree, const std::string& name);

    std::vector<std::string> features_;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> roots_;
    double baseline_ = 0, scale_ = 1, offset_ = 0;
};

// The probability of some log-odds, and back; probabilities are kept away from 0 and 1 by a
// thousandth, for no model knows more.
double probability(double log_odds);
double log_odds(double probability);

// Whether a primitive is part of the room: floor, wall, ceiling or built in. Rows are
// geometry::shell_features().
const BoostedTrees& shell_model();
// Whether two primitives are one solid object. Rows are graph::joint_features().
const BoostedTrees& joint_model();

}  // namespace topple::fitted

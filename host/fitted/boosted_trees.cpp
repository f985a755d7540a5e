// SPDX-License-Identifier: MIT
#include "fitted/boosted_trees.h"

#include <algorithm>
#include <cmath>

#include "core/json.h"
#include "topple/error.h"

namespace topple::fitted {

struct TreeArrays {
    std::vector<std::int32_t> feature;
    std::vector<float> threshold;
    std::vector<int> missing_left;
    std::vector<std::uint32_t> left, right;
};

namespace {

// The column of each feature.
std::vector<std::int32_t> columns_of(const Json& features,
                                     std::span<const std::string_view> columns,
                                     const std::string& name) {
    std::vector<std::int32_t> out;
    for (const Json& feature : features) {
        const auto at = std::ranges::find(columns, feature.get<std::string>());
        if (at == columns.end())
            throw Error(ErrorKind::input, name + ": nothing is known of its feature " +
                                              feature.get<std::string>() + "; fit it anew");
        out.push_back(static_cast<std::int32_t>(at - columns.begin()));
    }
    return out;
}

}  // namespace

BoostedTrees::BoostedTrees(std::string_view json, const std::string& name,
                           std::span<const std::string_view> columns) {
    try {
        const Json file = Json::parse(json);
        if (file.at("schema") != "topple.trees/1")
            throw Error(ErrorKind::input, name + ": expected schema topple.trees/1");
        const std::vector<std::int32_t> column = columns_of(file.at("features"), columns, name);
        file.at("baseline").get_to(baseline_);
        file.at("scale").get_to(scale_);
        file.at("offset").get_to(offset_);
        for (const Json& tree : file.at("trees")) {
            TreeArrays arrays;
            tree.at("feature").get_to(arrays.feature);
            tree.at("threshold").get_to(arrays.threshold);
            tree.at("missing_left").get_to(arrays.missing_left);
            tree.at("left").get_to(arrays.left);
            tree.at("right").get_to(arrays.right);
            add_tree(arrays, column, name);
        }
    } catch (const nlohmann::json::exception& problem) {
        throw Error(ErrorKind::input, name + ": " + problem.what());
    }
}

void BoostedTrees::add_tree(const TreeArrays& tree, std::span<const std::int32_t> column,
                            const std::string& name) {
    const std::size_t count = tree.feature.size();
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    bool sound = count > 0 && tree.threshold.size() == count && tree.missing_left.size() == count &&
                 tree.left.size() == count && tree.right.size() == count;
    for (std::size_t n = 0; sound && n < count; ++n) {
        const std::int32_t feature = tree.feature[n];
        // Children come after their parents, so that every way down ends.
        sound = feature < static_cast<std::int32_t>(column.size()) &&
                (feature < 0 || (tree.left[n] > n && tree.left[n] < count && tree.right[n] > n &&
                                 tree.right[n] < count));
        if (!sound) break;
        nodes_.push_back({feature < 0 ? -1 : column[static_cast<std::size_t>(feature)],
                          tree.threshold[n], tree.missing_left[n] != 0, first + tree.left[n],
                          first + tree.right[n]});
    }
    if (!sound)
        throw Error(ErrorKind::input,
                    name + ": tree " + std::to_string(roots_.size()) + " is damaged");
    roots_.push_back(first);
}

double BoostedTrees::log_odds(std::span<const float> row) const {
    double sum = baseline_;
    for (const std::uint32_t root : roots_) {
        const Node* node = &nodes_[root];
        while (node->column >= 0) {
            const float value = row[static_cast<std::size_t>(node->column)];
            const bool left = std::isnan(value) ? node->missing_left : value <= node->threshold;
            node = &nodes_[left ? node->left : node->right];
        }
        sum += double{node->threshold};
    }
    return scale_ * sum + offset_;
}

double probability(double log_odds) {
    return std::clamp(1 / (1 + std::exp(-log_odds)), 0.001, 0.999);
}

double log_odds(double p) {
    p = std::clamp(p, 0.001, 0.999);
    return std::log(p / (1 - p));
}

}  // namespace topple::fitted

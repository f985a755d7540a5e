// SPDX-License-Identifier: MIT
#include "fitted/boosted_trees.h"

#include <algorithm>
#include <cmath>

#include "topple/error.h"

namespace topple::fitted {

BoostedTrees::BoostedTrees(const TreeTable& table, const std::string& name,
                           std::span<const std::string_view> columns)
    : table_(table) {
    for (const std::string_view feature : table.features) {
        const auto at = std::ranges::find(columns, feature);
        if (at == columns.end())
            throw Error(ErrorKind::input, name + ": nothing is known of its feature " +
                                              std::string(feature) + "; fit it anew");
        column_.push_back(static_cast<std::size_t>(at - columns.begin()));
    }
}

double BoostedTrees::log_odds(std::span<const float> row) const {
    double sum = table_.baseline;
    for (const std::uint32_t root : table_.roots) {
        const TreeNode* node = &table_.nodes[root];
        while (node->feature >= 0) {
            const float value = row[column_[node->feature]];
            const bool left = std::isnan(value) ? node->missing_left : value <= node->threshold;
            node = &table_.nodes[left ? node->left : node->right];
        }
        sum += double{node->threshold};
    }
    return table_.scale * sum + table_.offset;
}

double probability(double log_odds) {
    return std::clamp(1 / (1 + std::exp(-log_odds)), 0.001, 0.999);
}

double log_odds(double p) {
    p = std::clamp(p, 0.001, 0.999);
    return std::log(p / (1 - p));
}

}  // namespace topple::fitted

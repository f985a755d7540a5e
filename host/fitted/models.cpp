// SPDX-License-Identifier: MIT
#include "fitted/boosted_trees.h"
#include "fitted/model_tables.h"

namespace topple::fitted {

const BoostedTrees& shell_model(std::span<const std::string_view> columns) {
    static const BoostedTrees model(shell_table, "shell.model.json", columns);
    return model;
}

const BoostedTrees& joint_model(std::span<const std::string_view> columns) {
    static const BoostedTrees model(joint_table, "joint.model.json", columns);
    return model;
}

const BoostedTrees& whole_model(std::span<const std::string_view> columns) {
    static const BoostedTrees model(whole_table, "whole.model.json", columns);
    return model;
}

}  // namespace topple::fitted

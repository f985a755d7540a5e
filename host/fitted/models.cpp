// SPDX-License-Identifier: MIT
#include "fitted/boosted_trees.h"
#include "fitted/model_files.h"

namespace topple::fitted {

const BoostedTrees& shell_model() {
    static const BoostedTrees model(shell_model_json(), "shell.model.json");
    return model;
}

const BoostedTrees& joint_model() {
    static const BoostedTrees model(joint_model_json(), "joint.model.json");
    return model;
}

}  // namespace topple::fitted

// SPDX-License-Identifier: MIT
#pragma once

#include "fitted/boosted_trees.h"

// The fitted models, as the build makes constants of their files.
namespace topple::fitted {

extern const TreeTable shell_table, joint_table, whole_table;

}  // namespace topple::fitted

// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include "lab/solids/part.h"

namespace topple::scenes {

// A part as the files of truth hold it (ground_truth.h), but for its ids. Internal to
// topple_lab.
nlohmann::json part_json(const Part& part);

}  // namespace topple::scenes

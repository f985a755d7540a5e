// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "lab/scores/score.h"
#include "perf/measure.h"

namespace topple::perf {

void print_results(const std::vector<Result>& results);
void print_score(const scenes::Score& score);

// Throw Error(input) where the file can't be written.
void write_json(const std::string& path, const std::vector<Result>& results);
void write_csv(const std::string& path, const std::vector<Result>& results);

}  // namespace topple::perf

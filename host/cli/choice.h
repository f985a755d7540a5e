// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "core/listed.h"

namespace topple::cli {

// An option's value is one of these words. The parser's own checks show how they are stored, in the
// help and in what they say of other words.
inline CLI::Validator one_of(const std::vector<std::string>& words) {
    std::string set;
    for (const std::string& word : words) set += (set.empty() ? "{" : ",") + word;
    return {[words](std::string& word) {
                const bool known = std::find(words.begin(), words.end(), word) != words.end();
                return known ? std::string() : word + ": expected " + listed(words);
            },
            set + "}"};
}

}  // namespace topple::cli

// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace topple {

// "m, cm or in".
inline std::string listed(std::span<const std::string> words, const std::string& last = "or") {
    std::string text;
    for (std::size_t n = 0; n < words.size(); ++n) {
        if (n > 0) text += n + 1 < words.size() ? ", " : ' ' + last + ' ';
        text += words[n];
    }
    return text;
}

}  // namespace topple

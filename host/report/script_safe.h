// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace topple::report {

// JSON that may stand inside <script>: nothing in it can end the element or start a comment.
inline std::string script_safe(std::string_view json) {
    std::string out;
    out.reserve(json.size() + json.size() / 64);
    for (const char c : json) {
        if (c == '<') {
            out += "\\u003c";
        } else {
            out += c;
        }
    }
    return out;
}

}  // namespace topple::report

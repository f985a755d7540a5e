// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "io/text.h"

namespace topple::io {

// What a reader of JSON found wrong, without the library's own numbering: "line 3, column 7: syntax
// error while parsing object - unexpected string literal; expected '}'".
inline std::string json_problem(const nlohmann::json::exception& error) {
    std::string_view what = error.what();
    if (const auto end = what.find("] "); what.starts_with("[json.exception.") && end != what.npos)
        what.remove_prefix(end + 2);
    constexpr std::string_view at = "parse error at ";
    if (what.starts_with(at)) what.remove_prefix(at.size());
    return printable(what, 200);
}

}  // namespace topple::io

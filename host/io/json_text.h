// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/json.h"
#include "io/open_file.h"
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

// Refuses what is nested deeper than any file that is meant: readers make an object of each level,
// or call themselves. Throws Error(input).
inline void check_json_nesting(const std::filesystem::path& file, std::string_view text) {
    constexpr std::size_t most = 100;
    std::size_t depth = 0;
    bool in_string = false;
    for (std::size_t n = 0; n < text.size(); ++n) {
        const char c = text[n];
        if (in_string) {
            if (c == '\\') ++n;
            in_string = c != '"';
        } else if (c == '"') {
            in_string = true;
        } else if (c == '[' || c == '{') {
            if (++depth > most)
                fail(file, "its JSON is nested more than " + std::to_string(most) +
                               " deep; the file is damaged");
        } else if ((c == ']' || c == '}') && depth > 0) {
            --depth;
        }
    }
}

// What a text of JSON holds. Throws Error(input) where it is nested too deep, or `problem`, which
// is "is no JSON", say.
inline Json parse_json(const std::filesystem::path& file, std::string_view text,
                       const char* problem = "is no JSON") {
    check_json_nesting(file, text);
    try {
        return Json::parse(text.begin(), text.end());
    } catch (const nlohmann::json::exception& error) {
        fail(file, std::string(problem) + ": " + json_problem(error));
    }
}

// use(document) of a file that topple wrote. Throws Error(input) that names it where it is missing,
// of another schema, or lacks what `use` looks for; what: "scene.json".
template <class Use>
auto read_document(const FileName& name, const std::string& what, const std::string& schema,
                   const Use& use) {
    const std::filesystem::path& file = name.path();
    const FileBytes bytes = read_file(name);
    const std::string_view text = bytes.text();
    check_json_nesting(file, text);
    try {
        const auto json = OrderedJson::parse(text.begin(), text.end());
        if (json.at("schema") != schema) fail(file, "its schema is not " + schema);
        return use(json);
    } catch (const nlohmann::json::exception& error) {
        fail(file, "is no " + what + ": " + json_problem(error));
    }
}

}  // namespace topple::io

// SPDX-License-Identifier: MIT
#include "cli/unknown_option.h"

#include <algorithm>
#include <string_view>
#include <vector>

namespace topple::cli {
namespace {

// Letters to insert, leave out or replace until one word is the other.
std::size_t edits(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

}  // namespace

std::string unknown_option(const CLI::App& app, std::span<const char* const> words) {
    std::vector<std::string> known;
    for (const CLI::App* a = &app; a != nullptr; a = a->get_parent()) {
        for (const CLI::Option* option : a->get_options()) {
            for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
        }
    }
    for (const std::string_view word : words) {
        if (word == "--") break;
        if (!word.starts_with("--")) continue;
        const std::string_view name = word.substr(0, word.find('='));
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        std::string text = "unknown option ";
        text.append(name);
        const auto nearest = std::min_element(known.begin(), known.end(),
                                              [&](const std::string& a, const std::string& b) {
                                                  return edits(name, a) < edits(name, b);
                                              });
        // More than a third of its letters wrong is another word.
        if (nearest != known.end() && 3 * edits(name, *nearest) <= name.size())
            text.append("; did you mean ").append(*nearest).append("?");
        return text;
    }
    return {};
}

}  // namespace topple::cli

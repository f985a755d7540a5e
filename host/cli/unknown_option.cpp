// SPDX-License-Identifier: MIT
#include "cli/unknown_option.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "io/text.h"
#include "safety/earthquake/acceleration_units.h"

namespace topple::cli {
namespace {

// Letters to insert, leave out, replace or swap with the next one until one word is the other.
std::size_t edits(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before, last, row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before = std::exchange(last, row);
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j - 1] + (a[i - 1] != b[j - 1]), last[j] + 1, row[j - 1] + 1});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
    }
    return row.back();
}

// "; did you mean NAME?" with the nearest of the known ones, where one is near. More than a third
// of its letters wrong is another word.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& known) {
    const auto nearest = std::min_element(
        known.begin(), known.end(),
        [&](const auto& a, const auto& b) { return edits(name, a) < edits(name, b); });
    if (nearest == known.end() ||
        3 * edits(name, *nearest) > std::max(name.size(), nearest->size()))
        return {};
    return "; did you mean " + *nearest + "?";
}

}  // namespace

std::string unknown_command(const CLI::App& app, std::span<const char* const> words) {
    if (words.size() < 2) return {};
    const std::string name = words[1];
    if (name.starts_with("-")) return {};
    std::vector<std::string> known;
    for (const CLI::App* sub : app.get_subcommands({})) known.push_back(sub->get_name());
    std::string list;
    for (const std::string& command : known) list += (list.empty() ? "" : ", ") + command;
    const std::string nearest = did_you_mean(name, known);
    return "unknown subcommand " + io::in_quotes(name) +
           (nearest.empty() ? "; there are " + list : nearest);
}

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
        text.append(did_you_mean(name, known));
        return text;
    }
    return {};
}

namespace {

// A title that the shell has taken apart: "" where it is one word.
std::string title_in_words(std::span<const char* const> words) {
    for (std::size_t n = 1; n + 2 < words.size(); ++n) {
        if (std::string_view(words[n]) != "--title") continue;
        std::string title = words[n + 1];
        std::size_t more = n + 2;
        for (; more < words.size() && words[more][0] != '-'; ++more)
            title.append(" ").append(words[more]);
        if (more > n + 2) return io::printable(title);
    }
    return {};
}

}  // namespace

std::string value_with_space(std::span<const char* const> words) {
    const auto goes_on = [&](std::size_t n) {
        const std::string_view before = words[n - 1], word = words[n];
        return !word.starts_with("-") && (before.ends_with(",") || word.starts_with(","));
    };
    for (std::size_t n = 2; n < words.size(); ++n) {
        std::string value = words[n - 1];
        double number = 0;
        if (io::parse_number(value, number) && io::acceleration_unit_m_s2(words[n]))
            return "write it without the space: " + io::printable(value.append(words[n]));
        if (!goes_on(n)) continue;
        for (; n < words.size() && goes_on(n); ++n) value.append(words[n]);
        return "write the list without spaces: " + io::printable(value);
    }
    const std::string title = title_in_words(words);
    if (!title.empty()) return "put a title of several words in quotes, as in \"" + title + "\"";
    return {};
}

}  // namespace topple::cli

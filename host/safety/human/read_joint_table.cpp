// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "io/text.h"
#include "safety/human/motion_formats.h"

namespace topple::io {
namespace {

constexpr std::size_t none = SIZE_MAX;
constexpr std::size_t most_table_columns = 4096;

std::vector<std::string_view> split(std::string_view line) {
    std::vector<std::string_view> out;
    for (std::string_view token; !(token = next_token(line, true)).empty();) {
        while (!token.empty() && (token.front() == '"' || token.front() == '\''))
            token.remove_prefix(1);
        while (!token.empty() && (token.back() == '"' || token.back() == '\''))
            token.remove_suffix(1);
        out.push_back(token);
        if (out.size() > most_table_columns) break;
    }
    return out;
}

// Which columns hold which joint, and the times.
struct Layout {
    std::size_t columns = 0, time = none;
    std::vector<std::string> names;
    std::vector<std::array<std::size_t, 3>> at;  // columns of x, y, z by name
};

constexpr const char* example =
    "; the first line must name the columns, such as "
    "time,left_wrist.x,left_wrist.y,left_wrist.z,right_wrist.x,...";

Layout layout_of(const std::filesystem::path& file, const std::vector<std::string_view>& head) {
    Layout out;
    out.columns = head.size();
    for (std::size_t c = 0; c < head.size(); ++c) {
        const std::string name = lower_case(head[c]);
        if (name == "time" || name == "t" || name == "timestamp" || name == "seconds") {
            out.time = c;
            continue;
        }
        if (name.size() < 2 || name.back() < 'x' || name.back() > 'z') continue;
        std::string_view stem = head[c].substr(0, head[c].size() - 1);
        while (!stem.empty() && (stem.back() == '.' || stem.back() == '_' || stem.back() == '-'))
            stem.remove_suffix(1);
        if (stem.empty()) continue;
        auto known = std::find(out.names.begin(), out.names.end(), stem);
        if (known == out.names.end()) {
            out.names.emplace_back(stem);
            out.at.push_back({none, none, none});
            known = out.names.end() - 1;
        }
        out.at[static_cast<std::size_t>(known - out.names.begin())]
              [static_cast<std::size_t>(name.back() - 'x')] = c;
    }
    for (std::size_t n = out.names.size(); n-- > 0;) {
        const auto& at = out.at[n];
        if (at[0] != none && at[1] != none && at[2] != none) continue;
        out.names.erase(out.names.begin() + static_cast<std::ptrdiff_t>(n));
        out.at.erase(out.at.begin() + static_cast<std::ptrdiff_t>(n));
    }
    if (out.names.empty())
        fail(file, "line 1: no joint has columns for its x, y and z" + std::string(example));
    return out;
}

}  // namespace

NamedMotion read_joint_table(const std::filesystem::path& file, std::string_view text) {
    Lines lines(text);
    std::string_view line;
    std::vector<std::string_view> tokens;
    while (tokens.empty()) {
        if (!lines.next(line)) fail(file, "holds no table");
        tokens = split(line);
    }
    const Layout layout = layout_of(file, tokens);
    const auto bad = [&](const std::string& what) {
        fail(file, "line " + std::to_string(lines.number()) + ": " + what);
    };
    NamedMotion out;
    out.names = layout.names;
    out.track.resize(layout.names.size());
    double first = 0, last = 0;
    std::uint64_t rows = 0;
    while (lines.next(line)) {
        tokens = split(line);
        if (tokens.empty()) continue;
        if (tokens.size() != layout.columns)
            bad(counted(tokens.size(), "column") + ", but the first line names " +
                std::to_string(layout.columns));
        const auto value = [&](std::size_t column) {
            double v = 0;
            if (!parse_number(tokens[column], v) || !std::isfinite(v) || std::abs(v) > 1e9)
                bad("column " + std::to_string(column + 1) + ": expected a number, found " +
                    in_quotes(tokens[column]));
            return v;
        };
        if (layout.time != none) {
            const double time = value(layout.time);
            if (rows == 0) first = time;
            if (rows > 0 && !(time > last))
                bad("its time, " + short_number(time) + ", is not after " + short_number(last) +
                    ", that of the row before");
            last = time;
        }
        for (std::size_t n = 0; n < layout.at.size(); ++n) {
            const auto& at = layout.at[n];
            out.track[n].push_back({value(at[0]), value(at[1]), value(at[2])});
        }
        if (++rows * 3 * layout.at.size() > most_motion_numbers)
            bad("more than " + std::to_string(most_motion_numbers) + " numbers");
    }
    if (layout.time != none && rows > 1)
        out.step_s = (last - first) / static_cast<double>(rows - 1);
    return out;
}

}  // namespace topple::io

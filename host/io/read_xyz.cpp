// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "io/cloud_builder.h"
#include "io/formats.h"
#include "io/pose_rows.h"
#include "io/text.h"

namespace topple::io {
namespace {

constexpr std::size_t no_column = SIZE_MAX;
// Columns beyond this one are not looked at.
constexpr std::size_t most_columns = 256;

// Which columns hold what.
struct Columns {
    using Three = std::array<std::size_t, 3>;
    static constexpr Three nowhere{no_column, no_column, no_column};
    Three point{0, 1, 2}, normal = nowhere, colour = nowhere;
    bool by_name = false;
    static bool found(const Three& three) {
        return three[0] != no_column && three[1] != no_column && three[2] != no_column;
    }
};

std::string_view without_comment(std::string_view line) {
    line = line.substr(0, line.find('#'));
    return line.substr(0, line.find("//"));
}

std::size_t split(std::string_view line, std::array<std::string_view, most_columns>& tokens) {
    std::size_t count = 0;
    while (count < most_columns) {
        const auto token = next_token(line, true);
        if (token.empty()) break;
        tokens[count++] = token;
    }
    return count;
}

// Reads a line of column names; false where it is none.
bool parse_names(const std::array<std::string_view, most_columns>& tokens, std::size_t count,
                 Columns& columns) {
    double number;
    if (count == 0 || parse_number(tokens[0], number)) return false;
    static constexpr std::array<const char*, 12> names{"x", "y", "z", "nx",  "ny",    "nz",
                                                       "r", "g", "b", "red", "green", "blue"};
    std::array<std::size_t, names.size()> at;
    at.fill(no_column);
    for (std::size_t i = 0; i < count; ++i) {
        std::string name;
        for (const char c : tokens[i]) {
            if (c != '"' && c != '\'')
                name += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
        }
        if (name.empty() || !((name[0] >= 'a' && name[0] <= 'z') || name[0] == '_')) return false;
        for (std::size_t k = 0; k < names.size(); ++k) {
            if (name == names[k] && at[k] == no_column) at[k] = i;
        }
    }
    if (at[0] == no_column || at[1] == no_column || at[2] == no_column)
        return true;  // the first three columns
    columns.point = {at[0], at[1], at[2]};
    columns.normal = {at[3], at[4], at[5]};
    columns.colour = {at[6], at[7], at[8]};
    if (!Columns::found(columns.colour)) columns.colour = {at[9], at[10], at[11]};
    columns.by_name = true;
    return true;
}

// Whether nearly all of the triples have length 1: then they are normals and no colours.
bool are_unit(const std::vector<std::array<double, 3>>& triples) {
    std::size_t unit = 0;
    for (const auto& t : triples) {
        const double length = std::sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
        unit += std::abs(length - 1) < 0.02;
    }
    return !triples.empty() && unit >= triples.size() - triples.size() / 100;
}

// Whether all are whole numbers from 0 to 255.
bool are_bytes(const std::vector<std::array<double, 3>>& triples) {
    return !triples.empty() && std::ranges::all_of(triples, [](const auto& t) {
        return std::ranges::all_of(
            t, [](double v) { return v >= 0 && v <= 255 && v == std::floor(v); });
    });
}

class XyzParser {
  public:
    XyzParser(const std::filesystem::path& file, std::string_view bytes, const CloudSink* sink)
        : file_(file), sink_(sink), lines_(bytes) {}

    PointCloud parse() {
        std::string_view line;
        bool first = true;
        while (lines_.next(line)) {
            const auto count = split(without_comment(line), tokens_);
            if (count == 0) continue;
            if (first) {
                first = false;
                if (count == 1 && parse_count(tokens_[0], promised_.emplace())) continue;
                promised_.reset();
                if (parse_names(tokens_, count, columns_)) {
                    names_ = {lines_.number(), std::string(tokens_[0])};
                    continue;
                }
                if (count == 6) columns_.normal = {3, 4, 5};
            }
            add_row(count);
            if (!columns_.by_name && !pose_rows_.full()) look_for_poses(count);
            if (sink_ && points_.size() == rows_at_once) hand_over();
        }
        if (!pose_rows_.full()) refuse_poses();
        if (promised_ && *promised_ != rows_) {
            fail(file_, "its first line promises " + counted(*promised_, "point") +
                            ", the file has " + std::to_string(rows_) +
                            "; it is cut short, or that line is wrong");
        }
        if (rows_ == 0 && names_.line > 0) {
            fail(file_, "line " + std::to_string(names_.line) + ": " + in_quotes(names_.first) +
                            " is not a number, and no line of numbers follows; expected a point's "
                            "x y z in each line");
        }
        hand_over();
        return cloud_->finish();
    }

  private:
    void add_row(std::size_t count) {
        ++rows_;
        points_.push_back(triple(columns_.point, count));
        // A row that has not six columns like the first: nothing is known of those beyond three.
        if (!columns_.by_name && count != 6) columns_.normal = columns_.colour = Columns::nowhere;
        if (Columns::found(columns_.normal)) normals_.push_back(triple(columns_.normal, count));
        if (Columns::found(columns_.colour)) colours_.push_back(triple(columns_.colour, count));
    }

    void look_for_poses(std::size_t count) {
        std::array<double, PoseRows::most_columns> values{};
        for (std::size_t i = 0; i < std::min(count, values.size()); ++i)
            if (!parse_number(tokens_[i], values[i])) values[i] = NAN;
        pose_rows_.add(values, count);
        if (pose_rows_.full()) refuse_poses();
    }
    void refuse_poses() const {
        if (pose_rows_.are_poses())
            fail(file_,
                 "is a file of cameras' poses, not of points: give its folder, with the depth "
                 "images in depth/ and intrinsics.json");
    }

    std::array<double, 3> triple(const std::array<std::size_t, 3>& which, std::size_t count) const {
        std::array<double, 3> values{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (which[axis] >= count) {
                bad(counted(count, "value") + ", but " + std::to_string(which[axis] + 1) +
                    " are needed");
            }
            if (!parse_number(tokens_[which[axis]], values[axis])) {
                bad(in_quotes(tokens_[which[axis]]) + " is not a number; expected " +
                    (&which == &columns_.point ? "x y z" : "a normal or a colour") +
                    " in columns " + std::to_string(which[0] + 1) + ", " +
                    std::to_string(which[1] + 1) + " and " + std::to_string(which[2] + 1));
            }
        }
        return values;
    }

    [[noreturn]] void bad(const std::string& message) const {
        fail(file_, "line " + std::to_string(lines_.number()) + ": " + message);
    }

    // The first rows, which without a sink are all, tell whether the file has normals or colours.
    void hand_over() {
        if (!cloud_) {
            if (!columns_.by_name && !are_unit(normals_)) {
                if (are_bytes(normals_)) {
                    columns_.colour = columns_.normal;
                    colours_ = std::move(normals_);
                }
                columns_.normal = Columns::nowhere;
            }
            CloudFields fields{.normals = Columns::found(columns_.normal)};
            if (Columns::found(columns_.colour))
                fields.colours = columns_.by_name ? ColourValues::real : ColourValues::bytes;
            cloud_.emplace(file_, points_.size(), fields, sink_);
        }
        const auto of = [](const std::vector<std::array<double, 3>>& values, std::size_t i) {
            return i < values.size() ? values[i] : std::array<double, 3>{};
        };
        for (std::size_t i = 0; i < points_.size(); ++i)
            cloud_->add(points_[i], of(normals_, i), of(colours_, i));
        for (auto* rows : {&points_, &normals_, &colours_}) rows->clear();
    }

    static constexpr std::size_t rows_at_once = 1u << 16;  // with a sink

    const std::filesystem::path& file_;
    const CloudSink* sink_;
    std::optional<CloudBuilder> cloud_;
    std::uint64_t rows_ = 0;
    PoseRows pose_rows_;
    Lines lines_;
    Columns columns_;
    std::optional<std::uint64_t> promised_;
    // The line that was taken for the columns' names, and its first word.
    struct {
        std::uint64_t line = 0;
        std::string first;
    } names_;
    std::array<std::string_view, most_columns> tokens_;
    std::vector<std::array<double, 3>> points_, normals_, colours_;
};

}  // namespace

PointCloud parse_xyz(const std::filesystem::path& file, std::string_view bytes,
                     const CloudSink* sink) {
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);  // byte order mark
    if (bytes.substr(0, 4096).find('\0') != std::string_view::npos) {
        fail(file,
             "is not text: it has zero bytes near its start; give text in UTF-8 or ASCII, or a "
             ".ply or .pcd file");
    }
    return XyzParser(file, bytes, sink).parse();
}

}  // namespace topple::io

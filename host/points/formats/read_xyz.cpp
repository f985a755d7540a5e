// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "io/text.h"
#include "points/formats/cloud_builder.h"
#include "points/formats/formats.h"
#include "points/formats/pose_rows.h"
#include "points/formats/text_columns.h"

namespace topple::io {
namespace {

constexpr std::size_t no_column = SIZE_MAX;

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

// Names of columns as programs and surveyors write them, in German and French, too.
struct ColumnName {
    std::string_view name;
    Columns::Three Columns::*three;
    std::size_t axis;
};
constexpr ColumnName column_names[] = {
    {"x", &Columns::point, 0},          {"y", &Columns::point, 1},
    {"z", &Columns::point, 2},          {"easting", &Columns::point, 0},
    {"northing", &Columns::point, 1},   {"elevation", &Columns::point, 2},
    {"rechtswert", &Columns::point, 0}, {"hochwert", &Columns::point, 1},
    {"hoehe", &Columns::point, 2},      {"h\xC3\xB6he", &Columns::point, 2},
    {"height", &Columns::point, 2},     {"altitude", &Columns::point, 2},
    {"nx", &Columns::normal, 0},        {"ny", &Columns::normal, 1},
    {"nz", &Columns::normal, 2},        {"normal_x", &Columns::normal, 0},
    {"normal_y", &Columns::normal, 1},  {"normal_z", &Columns::normal, 2},
    {"r", &Columns::colour, 0},         {"g", &Columns::colour, 1},
    {"b", &Columns::colour, 2},         {"red", &Columns::colour, 0},
    {"green", &Columns::colour, 1},     {"blue", &Columns::colour, 2},
    {"rot", &Columns::colour, 0},       {"gr\xC3\xBCn", &Columns::colour, 1},
    {"gruen", &Columns::colour, 1},     {"blau", &Columns::colour, 2},
    {"rouge", &Columns::colour, 0},     {"vert", &Columns::colour, 1},
    {"bleu", &Columns::colour, 2}};

// A name in small letters without its unit: "X [m]", "x(mm)", "y_m".
std::string plain_name(std::string_view field) {
    std::string name = lower_case(field);
    std::erase_if(name, [](char c) { return c == '"' || c == '\''; });
    name.resize(std::min(name.find_first_of("[("), name.size()));
    for (const char* unit : {"_m", "_mm", "_cm", "_in", "_ft"})
        if (name.ends_with(unit)) name.resize(name.size() - std::string_view(unit).size());
    return std::string(trimmed(name));
}

// Reads a line of column names; false where it is none.
bool parse_names(const TextColumns& text, const TextColumns::Fields& fields, std::size_t count,
                 Columns& columns) {
    double number;
    if (count == 0 || text.number(fields[0], number)) return false;
    Columns found{.point = Columns::nowhere};
    for (std::size_t i = 0; i < count; ++i) {
        const std::string name = plain_name(fields[i]);
        const char first = name.empty() ? '_' : name[0];
        if (!((first >= 'a' && first <= 'z') || first == '_' || (first & 0x80))) return false;
        for (const ColumnName& known : column_names) {
            std::size_t& at = (found.*known.three)[known.axis];
            if (name == known.name && at == no_column) at = i;
        }
    }
    found.by_name = Columns::found(found.point);
    if (found.by_name) columns = found;  // else the first three columns
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
        : file_(file), sink_(sink), lines_(bytes), text_(bytes) {}

    PointCloud parse() {
        if (text_.halves_line() > 0) {
            fail(file_, "line " + std::to_string(text_.halves_line()) +
                            ": commas seem to stand between the columns and in the numbers, too: "
                            "write decimals with points, or semicolons between columns");
        }
        std::string_view line;
        bool first = true;
        while (lines_.next(line)) {
            const auto count = text_.split(line, tokens_);
            if (count == 0) continue;
            if (first) {
                first = false;
                if (count == 1 && parse_count(tokens_[0], promised_.emplace())) continue;
                promised_.reset();
                if (parse_names(text_, tokens_, count, columns_)) {
                    names_ = {lines_.number(), count, std::string(tokens_[0])};
                    continue;
                }
                if (count == 6) columns_.normal = {3, 4, 5};
            }
            add_row(count);
            if (!columns_.by_name && first_rows_.size() < most_pose_rows) look_for_poses(count);
            if (sink_ && points_.size() == rows_at_once) hand_over();
        }
        if (first_rows_.size() < most_pose_rows) refuse_poses();
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
        PointCloud out = cloud_->finish();
        if (names_.line > 0 && !columns_.by_name)
            out.notes.push_back("Line " + std::to_string(names_.line) +
                                " names no columns x, y and z: the first three were taken.");
        return out;
    }

  private:
    void add_row(std::size_t count) {
        ++rows_;
        // Else a value that is not there shifts all behind it.
        if (columns_.by_name && !text_.keeps_places() && count != names_.count) {
            bad(counted(count, "value") + ", but line " + std::to_string(names_.line) + " names " +
                counted(names_.count, "column"));
        }
        points_.push_back(triple(columns_.point, count));
        // A row that has not six columns like the first: nothing is known of those beyond three.
        if (!columns_.by_name && count != 6) columns_.normal = columns_.colour = Columns::nowhere;
        if (Columns::found(columns_.normal)) normals_.push_back(triple(columns_.normal, count));
        if (Columns::found(columns_.colour)) colours_.push_back(triple(columns_.colour, count));
    }

    void look_for_poses(std::size_t count) {
        std::vector<double>& row = first_rows_.emplace_back(count, NAN);
        for (std::size_t i = 0; i < count; ++i)
            if (!text_.number(tokens_[i], row[i])) row[i] = NAN;
        if (first_rows_.size() == most_pose_rows) refuse_poses();
    }
    void refuse_poses() const {
        if (are_poses(first_rows_))
            fail(file_,
                 "is a file of cameras' poses, not of points: give its folder, with the depth "
                 "images in depth/ and intrinsics.json");
    }

    std::array<double, 3> triple(const std::array<std::size_t, 3>& which, std::size_t count) const {
        std::array<double, 3> values{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (which[axis] >= count) {
                bad(counted(count, "value") + ", but " + std::to_string(which[axis] + 1) +
                    " are needed" + text_.rule());
            }
            if (tokens_[which[axis]].empty())
                bad("column " + std::to_string(which[axis] + 1) + " is empty");
            if (!text_.number(tokens_[which[axis]], values[axis])) {
                bad(in_quotes(tokens_[which[axis]]) + " is not a number" + text_.rule() +
                    "; expected " + (&which == &columns_.point ? "x y z" : "a normal or a colour") +
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
        for (std::size_t i = 0; i < points_.size(); ++i) {
            FilePoint point{points_[i]};
            if (i < normals_.size()) point.normal = normals_[i];
            if (i < colours_.size()) point.colour = colours_[i];
            cloud_->add(point);
        }
        for (auto* rows : {&points_, &normals_, &colours_}) rows->clear();
    }

    static constexpr std::size_t most_pose_rows = 10;
    static constexpr std::size_t rows_at_once = 1u << 16;  // with a sink

    const std::filesystem::path& file_;
    const CloudSink* sink_;
    std::optional<CloudBuilder> cloud_;
    std::uint64_t rows_ = 0;
    std::vector<std::vector<double>> first_rows_;  // that may be poses
    Lines lines_;
    TextColumns text_;
    Columns columns_;
    std::optional<std::uint64_t> promised_;
    // The line that was taken for the columns' names, how many, and the first.
    struct {
        std::uint64_t line = 0;
        std::size_t count = 0;
        std::string first;
    } names_;
    TextColumns::Fields tokens_;
    std::vector<std::array<double, 3>> points_, normals_, colours_;
};

}  // namespace

PointCloud parse_xyz(const std::filesystem::path& file, std::string_view bytes,
                     const CloudSink* sink) {
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);  // byte order mark
    const bool wide = bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF");
    const std::string_view begin = bytes.substr(0, 4096);
    if (wide || begin.find('\0') != std::string_view::npos) {
        fail(file, std::string(wide ? "is text in UTF-16"
                                    : "is not text: it has zero bytes near "
                                      "its start") +
                       "; give text in UTF-8 or ASCII (iconv -f UTF-16 -t UTF-8 FILE), or a .ply "
                       "or .pcd file");
    }
    // Lines that end with \r alone.
    std::string lines;
    if (bytes.find('\n') == std::string_view::npos && begin.find('\r') != std::string_view::npos) {
        lines = bytes;
        std::ranges::replace(lines, '\r', '\n');
        bytes = lines;
    }
    return XyzParser(file, bytes, sink).parse();
}

}  // namespace topple::io

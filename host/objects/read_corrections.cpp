// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>

#include "core/json.h"
#include "core/number_options.h"
#include "core/room_measures.h"
#include "io/json_entry.h"
#include "io/text.h"
#include "objects/corrections_json.h"
#include "topple/corrections.h"

namespace topple {
namespace {

constexpr const char* corrections_schema = "topple.corrections/1";
constexpr std::uint64_t largest_corrections_bytes = 10'000'000;
constexpr std::size_t most_corrections = 1000, most_spots = 100, longest_name = 200;
constexpr double thickest_m = 10, heaviest_kg = 1e6;

std::string which(std::size_t n) {
    return "correction " + std::to_string(n + 1);
}

std::string range(double value, const char* unit, double most) {
    return io::short_number(value) + unit + "; it must be above 0 and at most " +
           io::short_number(most) + unit;
}

// What is wrong with a list of spots, after its name.
std::optional<std::string> fault_of_spots(const std::vector<Vec3>& spots, std::size_t least) {
    if (spots.size() < least)
        return std::string("has ") + io::counted(spots.size(), "spot") + "; it takes " +
               io::counted(least, "spot") + " at least";
    if (spots.size() > most_spots)
        return "has " + std::to_string(spots.size()) + " spots, more than the limit of " +
               std::to_string(most_spots);
    for (std::size_t s = 0; s < spots.size(); ++s) {
        for (const double x : spots[s]) {
            if (std::isfinite(x) && std::abs(x) <= farthest_m) continue;
            return "spot " + std::to_string(s + 1) + " is at " + io::short_number(x) +
                   "; coordinates are metres, up to " + io::short_number(farthest_m) +
                   " either way";
        }
    }
    return std::nullopt;
}

// Of a text of one line, after its name.
std::optional<std::string> fault_of_line(const std::string& text) {
    if (text.size() > longest_name)
        return "has " + std::to_string(text.size()) + " bytes, more than the limit of " +
               std::to_string(longest_name);
    for (const char c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            return "holds a control character; it must be one line of text";
    return std::nullopt;
}

std::optional<std::string> fault_of_name(const std::string& name) {
    if (name.find_first_not_of(' ') == std::string::npos) return "is empty";
    return fault_of_line(name);
}

// What the fields are called: in files, and as members.
struct FieldNames {
    std::string at_m, from_m, wall_m, mass_kg, coefficient, name, was;
};
const FieldNames& in_files() {
    static const FieldNames names{"\"at_m\"",        "\"from_m\"", "\"wall_m\"", "\"kg\"",
                                  "\"coefficient\"", "\"name\"",   "\"was\""};
    return names;
}
const FieldNames& as_members() {
    static const FieldNames names{"at_m",        "from_m", "wall_m", "mass_kg",
                                  "coefficient", "name",   "was"};
    return names;
}

std::optional<std::string> fault_of_one(const Correction& c, const FieldNames& names) {
    if (const auto wrong = fault_of_spots(c.at_m, c.kind == Correction::Kind::one_thing ? 2 : 1))
        return names.at_m + ": " + *wrong;
    if (c.kind == Correction::Kind::apart) {
        if (const auto wrong = fault_of_spots(c.from_m, 1)) return names.from_m + ": " + *wrong;
    }
    if (c.kind == Correction::Kind::hollow && !(c.wall_m > 0 && c.wall_m <= thickest_m))
        return names.wall_m + " is " + range(c.wall_m, " m", thickest_m);
    if (c.kind == Correction::Kind::mass && !(c.mass_kg > 0 && c.mass_kg <= heaviest_kg))
        return names.mass_kg + " is " + range(c.mass_kg, " kg", heaviest_kg);
    if (c.kind == Correction::Kind::friction &&
        !(c.coefficient > 0 && c.coefficient <= largest_friction))
        return names.coefficient + " is " + range(c.coefficient, "", largest_friction);
    if (c.kind == Correction::Kind::name) {
        if (const auto wrong = fault_of_name(c.name)) return names.name + " " + *wrong;
    }
    if (const auto wrong = fault_of_line(c.was)) return names.was + " " + *wrong;
    return std::nullopt;
}

// One entry of the list.
class Entry : io::JsonEntry {
  public:
    using JsonEntry::JsonEntry;

    Correction read() {
        Correction out;
        out.kind = kind();
        call_also(std::string(" (") + to_string(out.kind) + ")");
        out.at_m = spots("at_m");
        if (out.kind == Correction::Kind::apart) out.from_m = spots("from_m");
        if (out.kind == Correction::Kind::hollow) out.wall_m = number("wall_m");
        if (out.kind == Correction::Kind::mass) out.mass_kg = number("kg");
        if (out.kind == Correction::Kind::friction) out.coefficient = number("coefficient");
        if (out.kind == Correction::Kind::name) out.name = text("name");
        if (has("was")) out.was = text("was");
        if (const auto what = fault_of_one(out, in_files())) wrong(*what);
        return out;
    }

  private:
    Correction::Kind kind() const {
        const std::string name = text("do");
        if (const auto kind = io::correction_kind(name)) return *kind;
        wrong("\"do\" is " + io::in_quotes(name) + "; there are " + io::known_corrections());
    }
    std::vector<Vec3> spots(const char* name) const {
        const auto due = [&] {
            wrong(io::in_quotes(name) + " is no list of spots [x, y, z], as in [[1.5, 0.2, 0.8]]");
        };
        const Json& list = field(name);
        if (!list.is_array()) due();
        if (list.size() > most_spots)
            wrong(io::in_quotes(name) + ": has " + std::to_string(list.size()) +
                  " spots, more than the limit of " + std::to_string(most_spots));
        std::vector<Vec3> out;
        for (const Json& spot : list) {
            if (!spot.is_array() || spot.size() != 3) due();
            Vec3& to = out.emplace_back();
            for (std::size_t a = 0; a < 3; ++a) {
                if (!spot[a].is_number()) due();
                to[a] = spot[a].get<double>();
            }
        }
        return out;
    }
};

}  // namespace

const char* to_string(Correction::Kind kind) {
    for (const auto& [known, name] : io::correction_kinds)
        if (kind == known) return name;
    return "";
}

std::optional<std::string> fault_of(const std::vector<Correction>& corrections) {
    if (corrections.size() > most_corrections)
        return "there are " + std::to_string(corrections.size()) + ", more than the limit of " +
               std::to_string(most_corrections);
    for (std::size_t n = 0; n < corrections.size(); ++n) {
        if (const auto wrong = fault_of_one(corrections[n], as_members()))
            return which(n) + " (" + to_string(corrections[n].kind) + "): " + *wrong;
    }
    return std::nullopt;
}

std::vector<Correction> corrections_of(std::string_view text, const std::string& name) {
    const std::filesystem::path source = name;
    if (text.size() > largest_corrections_bytes)
        io::fail(source, "has " + io::bytes_text(text.size()) + ", more than the limit of " +
                             io::bytes_text(largest_corrections_bytes));
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
    const Json list =
        io::listed_in(source, text, "file of corrections", corrections_schema, "corrections");
    if (list.size() > most_corrections)
        io::fail(source, "has " + std::to_string(list.size()) +
                             " corrections, more than the limit of " +
                             std::to_string(most_corrections));
    std::vector<Correction> out;
    for (std::size_t n = 0; n < list.size(); ++n)
        out.push_back(Entry(source, which(n), list[n]).read());
    return out;
}

std::vector<Correction> read_corrections(const std::filesystem::path& file) {
    return corrections_of(io::read_file(file, largest_corrections_bytes).text(), file.string());
}

}  // namespace topple

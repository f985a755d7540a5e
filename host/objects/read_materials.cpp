// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "io/json_text.h"
#include "io/text.h"
#include "topple/materials.h"

namespace topple {
namespace {

constexpr const char* materials_schema = "topple.materials/1";
constexpr std::uint64_t largest_materials_bytes = 1'000'000;
constexpr std::size_t most_kinds = 1000, longest_kind = 100;

std::string numbered_kind(std::size_t n) {
    return "kind " + std::to_string(n + 1);
}

std::optional<std::string> fault_of_kind(const ThingKind& kind) {
    const auto fits = [](char c) {
        return static_cast<unsigned char>(c) >= 0x20 && c != 0x7f && !(c >= 'A' && c <= 'Z');
    };
    if (kind.name.empty() || kind.name.size() > longest_kind ||
        !std::ranges::all_of(kind.name, fits))
        return "its name must be of small letters, 1 to " + std::to_string(longest_kind) + " bytes";
    struct Range {
        const char* of;
        double value, least, most;
    };
    for (const auto& [of, value, least, most] :
         {Range{"an edge of size_m", kind.size_m[0], 1e-4, 100},
          {"an edge of size_m", kind.size_m[1], 1e-4, 100},
          {"an edge of size_m", kind.size_m[2], 1e-4, 100},
          {"fill", kind.fill, 1e-3, 1},
          {"density_kg_m3", kind.density_kg_m3, 1, 25000},
          {"spread", kind.spread, 0, 3}})
        if (!(value >= least && value <= most))
            return std::string(of) + " is " + io::short_number(value) + "; it must be from " +
                   io::short_number(least) + " to " + io::short_number(most);
    return std::nullopt;
}

// One kind of the list. All throw Error(input) that names it and what is wrong.
class KindEntry {
  public:
    KindEntry(const std::filesystem::path& file, std::size_t number, const Json& json)
        : file_(file), label_(numbered_kind(number)), json_(json) {
        if (!json.is_object()) wrong(std::string("is ") + json.type_name() + ", not {..}");
    }

    ThingKind read() {
        ThingKind out;
        out.name = name();
        const Json& size = field("size_m");
        if (!size.is_array() || size.size() != 3)
            wrong("\"size_m\" is no list of three lengths, as in [0.08, 0.09, 0.11]");
        for (std::size_t a = 0; a < 3; ++a)
            out.size_m[a] = number(size[a], "an edge in \"size_m\"");
        std::ranges::sort(out.size_m);
        out.fill = number(field("fill"), "\"fill\"");
        out.density_kg_m3 = number(field("density_kg_m3"), "\"density_kg_m3\"");
        out.spread = number(field("spread"), "\"spread\"");
        return out;
    }

  private:
    [[noreturn]] void wrong(const std::string& what) const {
        io::fail(file_, label_ + ": " + what);
    }
    const Json& field(const char* name) const {
        const auto found = json_.find(name);
        if (found == json_.end()) wrong("has no " + io::in_quotes(name));
        return *found;
    }
    double number(const Json& value, const char* what) const {
        if (!value.is_number()) wrong(std::string(what) + " is " + value.type_name());
        return value.get<double>();
    }
    std::string name() const {
        const Json& value = field("name");
        if (!value.is_string()) wrong(std::string("\"name\" is ") + value.type_name());
        return value.get<std::string>();
    }

    const std::filesystem::path& file_;
    std::string label_;
    const Json& json_;
};

}  // namespace

std::optional<std::string> fault_of(const Materials& materials) {
    if (materials.empty() || materials.size() > most_kinds)
        return "there are " + io::counted(materials.size(), "kind") + "; 1 to " +
               std::to_string(most_kinds) + " are taken";
    for (std::size_t n = 0; n < materials.size(); ++n)
        if (const auto wrong = fault_of_kind(materials[n])) return numbered_kind(n) + ": " + *wrong;
    return std::nullopt;
}

Materials read_materials(const std::filesystem::path& file) {
    if (file == "household") return household_materials();
    const io::FileBytes bytes = io::read_file(file, largest_materials_bytes);
    const Json json = io::parse_json(file, bytes.text());
    const auto schema = json.is_object() ? json.find("schema") : json.end();
    if (!json.is_object() || schema == json.end() || *schema != materials_schema)
        io::fail(file, "is no table of materials: its \"schema\" is not " +
                           io::in_quotes(materials_schema));
    const auto list = json.find("kinds");
    if (list == json.end() || !list->is_array()) io::fail(file, "has no list \"kinds\"");
    Materials out;
    for (std::size_t n = 0; n < list->size(); ++n)
        out.push_back(KindEntry(file, n, (*list)[n]).read());
    if (const auto wrong = fault_of(out)) io::fail(file, *wrong);
    return out;
}

}  // namespace topple

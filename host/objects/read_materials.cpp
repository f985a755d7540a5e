// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "core/number_options.h"
#include "io/json_entry.h"
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
          {"spread", kind.spread, 0, 3},
          {"friction", kind.friction, 0, largest_friction}})
        if (!(value >= least && value <= most))
            return std::string(of) + " is " + io::short_number(value) + "; it must be from " +
                   io::short_number(least) + " to " + io::short_number(most);
    return std::nullopt;
}

ThingKind kind_of(io::JsonEntry entry) {
    ThingKind out;
    out.name = entry.text("name");
    const Json& size = entry.field("size_m");
    if (!size.is_array() || size.size() != 3 ||
        !std::ranges::all_of(size, [](const Json& edge) { return edge.is_number(); }))
        entry.wrong("\"size_m\" is no list of three lengths, as in [0.08, 0.09, 0.11]");
    for (std::size_t a = 0; a < 3; ++a) out.size_m[a] = size[a].get<double>();
    std::ranges::sort(out.size_m);
    out.fill = entry.number("fill");
    out.density_kg_m3 = entry.number("density_kg_m3");
    out.spread = entry.number("spread");
    if (entry.has("friction")) out.friction = entry.number("friction");
    return out;
}

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
    const Json list =
        io::listed_in(file, bytes.text(), "table of materials", materials_schema, "kinds");
    Materials out;
    for (std::size_t n = 0; n < list.size(); ++n)
        out.push_back(kind_of({file, numbered_kind(n), list[n]}));
    if (const auto wrong = fault_of(out)) io::fail(file, *wrong);
    return out;
}

}  // namespace topple

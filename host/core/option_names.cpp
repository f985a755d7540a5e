// SPDX-License-Identifier: MIT
#include "topple/option_names.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/pose_mends.h"

namespace topple {
namespace {

constexpr const char* none = nullptr;
// Values first that an interface writes in words of its own.
constexpr auto names = std::to_array<OptionName>({
    {"ParseOptions::unit_m = 0.001", "--unit mm", "unit_m = 0.001", "unit_m=0.001"},
    {"ParseOptions::unit_m = 0.01", "--unit cm", "unit_m = 0.01", "unit_m=0.01"},
    {"ParseOptions::unit_m = 0.0254", "--unit in", "unit_m = 0.0254", "unit_m=0.0254"},
    {"ParseOptions::unit_m = 0.3048", "--unit ft", "unit_m = 0.3048", "unit_m=0.3048"},
    {"ParseOptions::isolate = false", "--no-isolate", "without_isolation = 1", "isolate=False"},
    {"ParseOptions::device", "--backend", "device", "device"},
    {"ParseOptions::voxel_m", "--voxel", "voxel_m", "voxel_m"},
    {"ParseOptions::unit_m", "--unit", "unit_m", "unit_m"},
    {"ParseOptions::up", "--up", "up", "up"},
    {"ParseOptions::disturbances", "--disturbance", "disturbances", "disturbances"},
    {"ParseOptions::seed", "--seed", "seed", "seed"},
    {"ParseOptions::max_memory_bytes", "--max-memory", "max_memory_bytes", "max_memory_bytes"},
    {"ParseOptions::density_kg_m3", "--density", "density_kg_m3", "density_kg_m3"},
    {"ParseOptions::friction", "--friction", "friction", "friction"},
    {"ParseOptions::contents_kg_m3", "--contents", "contents_kg_m3", "contents_kg_m3"},
    {"ParseOptions::walks", "--walks", "walks", "walks"},
    {"ParseOptions::motions", "--motion", none, "motion"},
    {"ParseOptions::wind_m_s", "--wind", "wind_m_s", "wind_m_s"},
    {"ParseOptions::wind_from_deg", "--wind-from", "wind_from_deg", "wind_from_deg"},
    {"ParseOptions::pga_m_s2", "--pga", "pga_m_s2", "pga_m_s2"},
    {"ParseOptions::accelerogram", "--accelerogram", none, "accelerogram"},
    {"ParseOptions::floor_amplification", "--floor-amplification", "floor_amplification",
     "floor_amplification"},
    {"ParseOptions::hazard", "--hazard", "hazard_pga_g", "hazard"},
    {"ParseOptions::tolerable_J", "--tolerable", "tolerable_J", "tolerable_J"},
    {"ParseOptions::isolate", "--no-isolate", "without_isolation", "isolate"},
    {"ParseOptions::corrections", "--corrections", "corrections_json", "corrections"},
    {"ParseOptions::cache_file", "--cache", "cache_file", "cache_file"},
    {"ParseOptions::stability_level", "--stability-level", "stability_level", "stability_level"},
    {"ParseOptions::grouping_time_s", "--grouping-time", "grouping_time_s", "grouping_time_s"},
    {"ParseOptions::tile_m", "--tile", "tile_m", "tile_m"},
    {"MotionFileOptions::unit_m", "--motion-unit", none, "motion_unit"},
    {"MotionFileOptions::rate_hz", "--motion-rate", none, "motion_rate"},
    {"MotionFileOptions::up", "--motion-up", none, "motion_up"},
    {"acceleration_unit_m_s2()", "--accelerogram-unit", none, "accelerogram_unit"},
    {"open_device(): backend", "--backend", "backend", "backend"},
    {"open_device(): threads", "--threads", "threads", "threads"},
    {"ExportOptions::mjcf", "--mjcf", "mjcf", "mjcf"},
    {"ExportOptions::urdf", "--urdf", "urdf", "urdf"},
    {"ExportOptions::sdf", "--sdf", "sdf", "sdf"},
    {"ExportOptions::usd", "--usd", "usd", "usd"},
    {"ExportOptions::visuals", "--no-visuals", none, "visuals"},
    {"ExportOptions::threads", "--threads", none, "threads"},
});

// By interface: what it has for an option, and what stands between that and a value.
constexpr struct {
    const char* OptionName::*name;
    std::string_view assigns;
} interfaces[] = {
    {&OptionName::command_line, " "}, {&OptionName::c, " = "}, {&OptionName::python, "="}};

struct Replacement {
    std::string from, to;
};

std::vector<Replacement> replacements(Interface interface) {
    std::vector<Replacement> out;
    for (const OptionName& name : names)
        if (const char* to = name.*interfaces[static_cast<std::size_t>(interface)].name)
            out.push_back({name.member, to});
    if (interface == Interface::python)
        for (const auto& [words, numpy] : pose_mends::all)
            out.push_back({words, std::string(words).append(" (").append(numpy).append(")")});
    // Of two that begin alike, the longer one.
    std::ranges::stable_sort(out, std::ranges::greater{},
                             [](const Replacement& r) { return r.from.size(); });
    return out;
}

bool in_word(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

// Whether `text` goes on with these words, whole.
bool goes_on(std::string_view text, std::string_view words) {
    return text.starts_with(words) &&
           !(text.size() > words.size() && in_word(words.back()) && in_word(text[words.size()]));
}

}  // namespace

std::span<const OptionName> option_names() {
    return names;
}

std::string in_words_of(Interface interface, std::string_view message) {
    constexpr std::string_view assignment = " = ";
    const std::vector<Replacement> all = replacements(interface);
    std::string out;
    for (std::size_t at = 0; at < message.size();) {
        const std::string_view rest = message.substr(at);
        const bool inside = at > 0 && in_word(message[at - 1]);
        const auto found = std::ranges::find_if(
            all, [&](const Replacement& r) { return !inside && goes_on(rest, r.from); });
        if (found == all.end()) {
            out += message[at++];
            continue;
        }
        out += found->to;
        at += found->from.size();
        if (!message.substr(at).starts_with(assignment)) continue;
        out += interfaces[static_cast<std::size_t>(interface)].assigns;
        at += assignment.size();
    }
    return out;
}

}  // namespace topple

// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <variant>

#include "topple/parse.h"
#include "topple/topple.h"

// The options of a parse that are a number, each declared once: the check of its range, and what C
// and Python take, come from here. The command line's words are in cli/parse_command.cpp.
namespace topple {

// The finest voxel is below the noise of every sensor of rooms, and far above what overflows; the
// coarsest hardly shows a room.
inline constexpr double least_voxel_m = 0.001, largest_voxel_m = 1;
inline constexpr double largest_friction = 10;

struct NumberOption {
    const char* words;  // its name in C++, C and Python, and the command line's
    std::variant<double ParseOptions::*, std::optional<double> ParseOptions::*> member;
    double topple_options::*in_c;  // NaN: none
    double least, most;            // a least of 0 is out of the range itself
    bool may_be_0 = false;         // with a meaning of its own

    std::optional<double> of(const ParseOptions& options) const {
        return std::visit([&](auto m) { return std::optional<double>(options.*m); }, member);
    }
    void to_c(const ParseOptions& from, topple_options& to) const {
        to.*in_c = of(from).value_or(std::numeric_limits<double>::quiet_NaN());
    }
    void from_c(const topple_options& from, ParseOptions& to) const {
        const double value = from.*in_c;
        if (const auto* plain = std::get_if<double ParseOptions::*>(&member))
            to.*(*plain) = value;
        else
            to.*std::get<1>(member) = std::isnan(value) ? std::nullopt : std::optional(value);
    }
};

inline constexpr NumberOption number_options[] = {
    {"voxel_m (--voxel)", &ParseOptions::voxel_m, &topple_options::voxel_m, least_voxel_m,
     largest_voxel_m, true},
    {"unit_m (--unit)", &ParseOptions::unit_m, &topple_options::unit_m, 1e-6, 1e6},
    {"density_kg_m3 (--density)", &ParseOptions::density_kg_m3, &topple_options::density_kg_m3, 0,
     30000},
    {"contents_kg_m3 (--contents)", &ParseOptions::contents_kg_m3, &topple_options::contents_kg_m3,
     0, 30000, true},
    {"friction (--friction)", &ParseOptions::friction, &topple_options::friction, 0,
     largest_friction},
    {"wind_m_s (--wind)", &ParseOptions::wind_m_s, &topple_options::wind_m_s, 0, 150},
    {"wind_from_deg (--wind-from)", &ParseOptions::wind_from_deg, &topple_options::wind_from_deg,
     -360, 360},
    {"pga_m_s2 (--pga)", &ParseOptions::pga_m_s2, &topple_options::pga_m_s2, 0, 50},
    {"floor_amplification (--floor-amplification)", &ParseOptions::floor_amplification,
     &topple_options::floor_amplification, 0, 20},
    {"stability_level (--stability-level)", &ParseOptions::stability_level,
     &topple_options::stability_level, 0, 10, true},
    {"tolerable_J (--tolerable)", &ParseOptions::tolerable_J, &topple_options::tolerable_J, 0, 1e9},
    // Tiles hold at least a block, tiles::block_edge_m.
    {"tile_m (--tile)", &ParseOptions::tile_m, &topple_options::tile_m, 5, 1000, true},
    {"grouping_time_s (--grouping-time)", &ParseOptions::grouping_time_s,
     &topple_options::grouping_time_s, 0, 86400},
};

}  // namespace topple

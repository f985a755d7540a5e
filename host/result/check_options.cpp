// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>

#include "core/short_number.h"
#include "points/voxel_size.h"
#include "safety/disturbances.h"
#include "topple/parse.h"

namespace topple {
namespace {

void check_range(const char* option, double value, double lowest, double highest) {
    if (value > 0 && value >= lowest && value <= highest) return;  // false for NaN
    throw Error(
        ErrorKind::usage,
        std::string(option) + " " + short_number(value) + ": expected a number " +
            (lowest > 0 ? "from " + short_number(lowest) + " to " : "above 0 and at most ") +
            short_number(highest));
}

}  // namespace

void check_options(const ParseOptions& o) {
    if (o.voxel_m != 0)
        check_range("ParseOptions::voxel_m", o.voxel_m, least_voxel_m, largest_voxel_m);
    check_range("ParseOptions::unit_m", o.unit_m, 1e-6, 1e6);
    if (o.up)
        check_range("ParseOptions::up: its length,", std::hypot((*o.up)[0], (*o.up)[1], (*o.up)[2]),
                    1e-6, 1e6);
    check_range("ParseOptions::density_kg_m3", o.density_kg_m3, 0, 30000);
    if (o.contents_kg_m3 && *o.contents_kg_m3 != 0)
        check_range("ParseOptions::contents_kg_m3", *o.contents_kg_m3, 0, 30000);
    check_range("ParseOptions::friction", o.friction, 0, 10);
    check_range("ParseOptions::walks", o.walks, 1, 1e6);
    check_range("ParseOptions::wind_m_s", o.wind_m_s, 0, 150);
    // 0 is north, so the range is none of those that begin above 0.
    if (o.wind_from_deg && !(std::abs(*o.wind_from_deg) <= 360))
        throw Error(ErrorKind::usage,
                    "ParseOptions::wind_from_deg " + short_number(*o.wind_from_deg) +
                        ": expected degrees clockwise from the scene's north, from -360 to 360");
    if (o.pga_m_s2) check_range("ParseOptions::pga_m_s2", *o.pga_m_s2, 0, 50);
    if (o.accelerogram) {
        check_range("ParseOptions::accelerogram: step_s", o.accelerogram->step_s, 1e-5, 0.5);
        double sum = 0;  // not finite if one of them isn't
        for (const auto* component :
             {&o.accelerogram->m_s2, &o.accelerogram->across_m_s2, &o.accelerogram->up_m_s2}) {
            if (!component->empty() && component->size() != o.accelerogram->m_s2.size())
                throw Error(
                    ErrorKind::usage,
                    "ParseOptions::accelerogram: its components have different numbers of samples");
            for (const double a : *component) sum += std::abs(a);
        }
        check_range("ParseOptions::accelerogram: its peak in m/s^2,",
                    std::isfinite(sum) ? o.accelerogram->peak_m_s2() : NAN, 0, 100);
    }
    check_range("ParseOptions::floor_amplification", o.floor_amplification, 0, 20);
    if (o.hazard) {
        if (const auto wrong = o.hazard->fault())
            throw Error(ErrorKind::usage, "ParseOptions::hazard: " + *wrong);
    }
    check_range("ParseOptions::tolerable_J", o.tolerable_J, 0, 1e9);
    if (o.tile_m != 0) check_range("ParseOptions::tile_m", o.tile_m, least_tile_m, 1000);
    if (o.grouping_time_s)
        check_range("ParseOptions::grouping_time_s", *o.grouping_time_s, 0, 86400);
    if (const auto wrong = fault_of(o.corrections))
        throw Error(ErrorKind::usage, "ParseOptions::corrections: " + *wrong);
    for (auto name = o.disturbances.begin(); name != o.disturbances.end(); ++name) {
        safety::disturbance_kind(*name);
        if (std::find(o.disturbances.begin(), name, *name) != name)
            throw Error(ErrorKind::usage,
                        "ParseOptions::disturbances: " + *name + " is given twice; name each once");
    }
    for (std::size_t n = 0; n < o.motions.size(); ++n) {
        if (!o.motions[n])
            throw Error(ErrorKind::usage, "ParseOptions::motions: number " + std::to_string(n) +
                                              " is null; give what read_motion() returns, or leave "
                                              "it out");
    }
}

std::vector<std::string> known_disturbances() {
    std::vector<std::string> names;
    for (const safety::DisturbanceKind* kind : safety::disturbance_kinds())
        names.emplace_back(kind->name);
    return names;
}

}  // namespace topple

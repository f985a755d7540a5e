// SPDX-License-Identifier: MIT
#include "safety/wind/wind_field.h"

namespace topple::safety {

const DisturbanceKind& wind_kind() {
    static const DisturbanceKind kind{
        .name = "wind",
        .words = {.cause = "wind",
                  .event = "gale",
                  .one_event = "one gale",
                  .column = "wind",
                  .doing = "blowing from all sides",
                  .mend = "Fasten it to the wall or to what carries it",
                  .push = "the push of the wind",
                  .arrows = {.strength = DisturbanceWords::Arrows::Strength::mean,
                             .at_tip = true,
                             .below_things = false,
                             .title = "Wind",
                             .says =
                                 "Where gales reach things, and which way they push on average.",
                             .legend = "wind, mean over all gales",
                             .scale = 1,
                             .unit = "m/s"},
                  .figure = {"wind_m_s", " of ", "wind", "m/s"}},
        .field =
            [](device::Device& device, const Surroundings& surroundings,
               std::span<const RiskObject> objects, const ParseOptions& options) {
                WindOptions wind;
                wind.speed_m_s = options.wind_m_s;
                wind.from_deg = options.wind_from_deg;
                wind.friction = options.friction;
                return wind_field(device, surroundings, objects, wind);
            },
        .events =
            [](const ParseOptions& options) {
                std::map<std::string, double> out{{"wind_m_s", options.wind_m_s}};
                if (options.wind_from_deg) out["wind_from_deg"] = *options.wind_from_deg;
                return out;
            },
        // A gale inside takes an open window.
        .below_ceiling =
            "A ceiling was scanned, and the wind is taken to blow as outside: where "
            "windows and doors are closed in gales leave wind out of the disturbances.",
        .left_out_below_none = "Wind was left out, as for a closed room."};
    return kind;
}

}  // namespace topple::safety

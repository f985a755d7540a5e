// SPDX-License-Identifier: MIT
#include "safety/wind/wind_field.h"

namespace topple::safety {
namespace {

// Rather than with all the others.
bool asked_for(const ParseOptions& options) {
    const ParseOptions all;
    return options.disturbances != all.disturbances || options.wind_m_s != all.wind_m_s ||
           options.wind_from_deg;
}

Disturbance no_wind(const Surroundings& surroundings, std::size_t objects) {
    Disturbance out;
    out.name = wind_kind().name;
    out.work.resize(objects);
    out.response.resize(objects);
    out.strongest.resize(objects);
    out.exposure.assign(surroundings.object.size(), 0.0f);
    out.notes.emplace_back(
        "A ceiling was scanned, so no wind is reckoned with. Where windows or doors stay open in "
        "gales, ask for it: wind_from_deg (--wind-from), another wind_m_s (--wind), or "
        "disturbances (--disturbance) that name wind and not all others.");
    return out;
}

}  // namespace

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
        // A gale inside takes an open window.
        .field =
            [](device::Device& device, const Surroundings& surroundings,
               std::span<const RiskObject> objects, const ParseOptions& options) {
                if (surroundings.below_ceiling && !asked_for(options))
                    return no_wind(surroundings, objects.size());
                WindOptions wind;
                wind.speed_m_s = options.wind_m_s;
                wind.from_deg = options.wind_from_deg;
                wind.over_space = options.space_fields;
                return wind_field(device, surroundings, objects, wind);
            },
        .events =
            [](const ParseOptions& options) {
                std::map<std::string, double> out{{"wind_m_s", options.wind_m_s}};
                if (options.wind_from_deg) out["wind_from_deg"] = *options.wind_from_deg;
                return out;
            },
        .left_out_below_none = "Wind was left out, as for a closed room."};
    return kind;
}

}  // namespace topple::safety

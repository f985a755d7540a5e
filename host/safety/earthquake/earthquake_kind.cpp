// SPDX-License-Identifier: MIT
#include "safety/earthquake/earthquake_field.h"
#include "safety/earthquake/intensity.h"

namespace topple::safety {
namespace {

// To the peak that is asked for.
std::optional<Accelerogram> scaled_record(const ParseOptions& options) {
    std::optional<Accelerogram> record = options.accelerogram;
    if (record && options.pga_m_s2) {
        const double scale = *options.pga_m_s2 / record->peak_m_s2();
        for (auto* component : {&record->m_s2, &record->across_m_s2, &record->up_m_s2})
            for (double& a : *component) a *= scale;
    }
    return record;
}

}  // namespace

const DisturbanceKind& earthquake_kind() {
    static const DisturbanceKind kind{
        .name = "earthquake",
        .words = {.cause = "earthquake",
                  .event = "earthquake",
                  .one_event = "one earthquake",
                  .column = "quake",
                  .doing = "shaking the ground",
                  .mend = "Fasten it to the wall or to what carries it",
                  .push = "the shaking of an earthquake",
                  .arrows = {.strength = DisturbanceWords::Arrows::Strength::speed,
                             .at_tip = false,
                             .below_things = true,
                             .title = "Earthquake",
                             .says = "How the ground shakes below things.",
                             .legend = "shaking below things",
                             .scale = 1,
                             .unit = "m/s\u00b2"},
                  .figure = {"pga_m_s2", " of about ", "ground acceleration", "m/s\u00b2"}},
        .field =
            [](device::Device& device, const Surroundings& surroundings,
               std::span<const RiskObject> objects, const ParseOptions& options) {
                EarthquakeOptions earthquake;
                earthquake.seed = options.seed;
                earthquake.pga_m_s2 = options.pga_m_s2.value_or(earthquake.pga_m_s2);
                earthquake.record = scaled_record(options);
                earthquake.floor_amplification = options.floor_amplification;
                earthquake.hazard = options.hazard;
                earthquake.over_space = options.space_fields;
                return earthquake_field(device, surroundings, objects, earthquake);
            },
        .events =
            [](const ParseOptions& options) {
                std::map<std::string, double> events{
                    {"pga_m_s2", options.pga_m_s2.value_or(options.accelerogram
                                                               ? options.accelerogram->peak_m_s2()
                                                               : EarthquakeOptions{}.pga_m_s2)}};
                if (!options.accelerogram) events["pga_spread"] = EarthquakeOptions{}.spread;
                if (options.floor_amplification != 1)
                    events["floor_amplification"] = options.floor_amplification;
                if (options.hazard && !options.hazard->pga_g.empty())
                    events["hazard_from_g"] = options.hazard->pga_g.front();
                return events;
            },
        .doubt =
            [](const ParseOptions& options) {
                return options.pga_m_s2 ? unlikely_peak_note(*options.pga_m_s2) : "";
            }};
    return kind;
}

}  // namespace topple::safety

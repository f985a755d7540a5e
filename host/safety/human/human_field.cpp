// SPDX-License-Identifier: MIT
#include "safety/human/human_field.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/ranked.h"
#include "safety/fields.h"
#include "safety/human/convolution.h"
#include "safety/human/passers_by.h"
#include "safety/human/walkable_map.h"
#include "safety/objects.h"

namespace topple::safety {
namespace {

// Flesh, clothes and the thing give way by so much when a body is stopped.
constexpr double stopping_way_m = 0.05;

void check(const HumanOptions& options) {
    check_option("cell_m", options.cell_m, 1e-3);
    check_option("body_radius_m", options.body_radius_m, 0);
    check_option("body_height_m", options.body_height_m, 0.1);
    check_option("step_height_m", options.step_height_m, 0);
    check_option("largest_hole_m", options.largest_hole_m, 0);
    check_option("body_mass_kg", options.body_mass_kg, 0);
    check_option("walking_speed_m_s", options.walking_speed_m_s, 0);
    check_option("wander_m", options.wander_m, 0);
    check_option("restitution", options.restitution, 0);
}

// Floors at different heights are fields of their own: parts are at heights above the walker's
// floor.
struct Level {
    double floor_m = 0;
    std::vector<bool> component;  // walked at this level
};

std::vector<Level> levels(const WalkableMap& map, double apart_m) {
    std::vector<std::vector<float>> heights(static_cast<std::size_t>(map.components));
    for (const std::uint32_t c : map.walkable) {
        heights[static_cast<std::size_t>(map.component[c])].push_back(map.floor_m[c]);
    }
    std::vector<std::pair<float, std::size_t>> medians;
    for (std::size_t n = 0; n < heights.size(); ++n) {
        medians.emplace_back(upper_median(heights[n]), n);
    }
    // From the largest component down, so that a level lies where most of its floor does.
    std::stable_sort(medians.begin(), medians.end(), [&](const auto& a, const auto& b) {
        return heights[a.second].size() > heights[b.second].size();
    });
    std::vector<Level> out;
    for (const auto& [height, component] : medians) {
        auto level = std::find_if(out.begin(), out.end(), [&, h = height](const Level& l) {
            return std::fabs(l.floor_m - double{h}) <= apart_m;
        });
        if (level == out.end()) {
            out.push_back({double{height}, std::vector<bool>(heights.size())});
            level = out.end() - 1;
        }
        level->component[component] = true;
    }
    return out;
}

// One of the strikes of a walk: of a pass of one level in one direction.
struct Strike {
    WorkSample sample;  // its probability: that this pass meets the object, and there
    double does_J = 0;
    std::size_t pass = 0;
};

bool does_more(const Strike& a, const Strike& b) {
    return a.does_J != b.does_J ? a.does_J > b.does_J : a.sample.W_J > b.sample.W_J;
}

// A pass meets the object in one part of its height, by the share that each has of what passes.
std::vector<Strike> all_strikes(const Strikes& strikes, const SecondaryMotion& motion,
                                const RiskObject& object, const Extent& extent,
                                double restitution) {
    std::vector<Strike> out;
    for (std::size_t level = 0; level < strikes.size(); ++level) {
        const double m = motion.mass_kg[level];
        for (unsigned d = 0; d < direction_count; ++d) {
            const auto& row = strikes[level][d];
            const double most = *std::ranges::max_element(row);
            const double all = std::accumulate(row.begin(), row.end(), 0.0);
            const auto [dx, dy] = direction(d);
            for (std::size_t h = 0; h < row.size(); ++h) {
                if (!(row[h] > 0)) continue;
                Strike strike;
                strike.pass = level * direction_count + d;
                strike.sample.direction = {dx, dy, 0};
                strike.sample.height_m = extent.height_m(h);
                strike.sample.probability = std::min(most, 1.0) * row[h] / all;
                // By conservation of momentum, (1 + e)^2 m M / (m + M)^2 of m v^2 / 2 goes over to
                // the mass M that is met there. A hand hardly moves a wardrobe, a hip does.
                const double M = object.toppling
                                     ? object.toppling->met_mass_kg(strike.sample.direction,
                                                                    strike.sample.height_m)
                                     : object.mass_kg;
                const double share =
                    m + M > 0 ? m * M * std::pow((1 + restitution) / (m + M), 2) : 0;
                strike.sample.W_J = motion.energy_J[level] * share;
                strike.does_J = instability(object, strike.sample);
                out.push_back(strike);
            }
        }
    }
    return out;
}

}  // namespace

// An object falls once, so that one strike of a walk counts. Passes are taken as independent, and
// each meets the object in one of its places: the chance that none of those from the first on has
// come is the product, over the passes, of what is left of each.
std::vector<WorkSample> strongest_strikes(const Strikes& strikes, const SecondaryMotion& motion,
                                          const RiskObject& object, const Extent& extent,
                                          double restitution) {
    std::vector<Strike> all = all_strikes(strikes, motion, object, extent, restitution);
    std::stable_sort(all.begin(), all.end(), does_more);
    std::vector<double> left(strikes.size() * direction_count, 1.0);
    std::vector<WorkSample> out;
    double missed = 1;
    for (std::size_t first = 0; first < all.size();) {
        std::size_t last = first;
        double sum = 0, before = missed;
        // Those that do the same share their probability.
        for (; last < all.size() && !does_more(all[first], all[last]); ++last) {
            double& rest = left[all[last].pass];
            const double p = all[last].sample.probability;
            missed *= rest > p ? (rest - p) / rest : 0.0;
            rest = std::max(rest - p, 0.0);
            sum += p;
        }
        for (; first < last; ++first) {
            WorkSample sample = all[first].sample;
            sample.probability *= (before - missed) / sum;
            if (sample.probability > 0) out.push_back(sample);
        }
    }
    return out;
}

struct HumanField::Parts {
    device::Device& device;
    const Surroundings& surroundings;
    std::span<const RiskObject> objects;
    HumanOptions options;
    std::vector<std::int32_t> object_of_cell;
    std::vector<Extent> extent;  // by object
    WalkableMap map;
    PrimaryMotion primary;
    SecondaryMotion secondary;
    std::unique_ptr<Convolution> convolution;  // none: nobody walks
    std::vector<Level> levels;
};

HumanField::HumanField(device::Device& device, const Surroundings& surroundings,
                       std::span<const RiskObject> objects, const HumanOptions& options)
    : parts_(new Parts{device,
                       surroundings,
                       objects,
                       options,
                       movable_object_of_cells(surroundings, objects),
                       {},
                       {},
                       {},
                       {},
                       {},
                       {}}) {
    check(options);
    Parts& p = *parts_;
    p.extent = extents(*surroundings.cells, p.object_of_cell, objects);
    p.secondary = p.options.motions.empty() ? table_motion(p.options) : recorded_motion(p.options);
    p.map = walkable_map(surroundings, p.options);
    if (p.map.walkable.empty()) return;
    p.primary = primary_motion(p.map, p.options);
    if (p.primary.paths == 0) return;
    p.convolution = std::make_unique<Convolution>(
        device, p.map, p.primary, p.secondary, surroundings, p.object_of_cell, p.extent, p.options);
    p.levels = levels(p.map, 2 * p.convolution->band_m());
}

HumanField::~HumanField() = default;

Disturbance HumanField::disturbance() {
    Parts& p = *parts_;
    Disturbance out;
    out.name = human_kind().name;
    out.work.resize(p.objects.size());
    out.exposure.assign(p.object_of_cell.size(), 0.0f);
    out.notes = p.map.notes;
    out.notes.insert(out.notes.end(), p.secondary.notes.begin(), p.secondary.notes.end());
    if (!p.map.walkable.empty()) out.walks = drawn_walks(p.map, p.primary);
    if (!p.convolution) return out;
    out.draws = p.primary.paths;

    std::vector<Strikes> strikes(p.objects.size(), no_strikes(p.secondary));
    ArrowSample arrows;
    for (const Level& level : p.levels)
        p.convolution->add_level(level.floor_m, level.component, strikes, out.exposure, arrows);
    out.strongest.resize(p.objects.size());
    for (std::size_t o = 0; o < p.objects.size(); ++o) {
        out.work[o] = strongest_strikes(strikes[o], p.secondary, p.objects[o], p.extent[o],
                                        p.options.restitution);
        for (const WorkSample& strike : out.work[o]) {
            const double force = strike.W_J / stopping_way_m;
            if (force > out.strongest[o].force_N) out.strongest[o] = {force, strike.height_m};
        }
    }
    SecondaryMotion strength;  // what of it tells the work
    strength.mass_kg = p.secondary.mass_kg;
    strength.energy_J = p.secondary.energy_J;
    out.work_if = [strikes = std::move(strikes), strength, extent = p.extent,
                   restitution = p.options.restitution](std::span<const RiskObject> changed) {
        std::vector<std::vector<WorkSample>> work;
        for (std::size_t o = 0; o < changed.size(); ++o)
            work.push_back(
                strongest_strikes(strikes[o], strength, changed[o], extent[o], restitution));
        return work;
    };
    out.samples = arrows.take();
    return out;
}

std::vector<Risk> HumanField::risk_at(std::span<const Placement> placements) {
    Parts& p = *parts_;
    std::vector<Risk> out(placements.size());
    if (!p.convolution) return out;
    const auto cells = cells_of_objects(p.object_of_cell, p.objects.size());
    std::vector<Strikes> strikes(placements.size(), no_strikes(p.secondary));
    for (const Level& level : p.levels)
        p.convolution->add_placements(level.floor_m, level.component, cells, placements, strikes);
    for (std::size_t n = 0; n < out.size(); ++n) {
        const auto work = strongest_strikes(strikes[n], p.secondary, placements[n].there,
                                            p.extent[placements[n].object], p.options.restitution);
        out[n] = risk_of(work, placements[n].there, p.primary.paths);
    }
    return out;
}

std::vector<double> HumanField::passing_shares(std::span<const FallZone> zones) {
    const Parts& p = *parts_;
    if (p.map.walkable.empty()) return {};
    return safety::passing_shares(p.map, p.primary, Columns(*p.surroundings.cells), p.options,
                                  zones);
}

Disturbance human_field(device::Device& device, const Surroundings& surroundings,
                        std::span<const RiskObject> objects, const HumanOptions& options) {
    return HumanField(device, surroundings, objects, options).disturbance();
}

}  // namespace topple::safety

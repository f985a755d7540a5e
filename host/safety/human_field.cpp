// SPDX-License-Identifier: MIT
#include "safety/human_field.h"

#include <algorithm>
#include <cmath>

#include "safety/convolution.h"
#include "safety/fields.h"
#include "safety/objects.h"
#include "safety/walkable_map.h"

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

// Of the energies of what strikes, what a free thing of mass M takes over: by conservation of
// momentum, (1 + e)^2 m M / (m + M)^2 of m v^2 / 2, e the restitution. A hand hardly moves a
// wardrobe, a hip does.
std::vector<double> taken_over(const SecondaryMotion& motion, double thing_kg, double restitution) {
    std::vector<double> out;
    for (std::size_t n = 0; n < motion.energy_J.size(); ++n) {
        const double m = motion.mass_kg[n], both = m + thing_kg;
        const double share = both > 0 ? m * thing_kg * std::pow((1 + restitution) / both, 2) : 0;
        out.push_back(motion.energy_J[n] * share);
    }
    return out;
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
        auto& h = heights[n];
        std::nth_element(h.begin(), h.begin() + static_cast<std::ptrdiff_t>(h.size() / 2), h.end());
        medians.emplace_back(h[h.size() / 2], n);
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

// The 16 directions merged by twos until at most max_work_samples are left; probabilities add up.
std::vector<WorkSample> compact(std::vector<std::vector<double>> by_direction,
                                std::span<const double> energy) {
    unsigned merged = 1;
    const auto count = [&] {
        std::size_t n = 0;
        for (const auto& row : by_direction)
            n += static_cast<std::size_t>(
                std::count_if(row.begin(), row.end(), [](double p) { return p > 0; }));
        return n;
    };
    std::vector<std::vector<std::array<double, 2>>> way(
        by_direction.size());  // sums of p * direction
    for (std::size_t w = 0; w < by_direction.size(); ++w) {
        for (unsigned d = 0; d < by_direction[w].size(); ++d) {
            const auto [dx, dy] = direction(d);
            way[w].push_back({by_direction[w][d] * dx, by_direction[w][d] * dy});
        }
    }
    for (; count() > max_work_samples && merged < direction_count; merged *= 2) {
        for (std::size_t w = 0; w < by_direction.size(); ++w) {
            const std::size_t half = by_direction[w].size() / 2;
            for (std::size_t d = 0; d < half; ++d) {
                by_direction[w][d] = by_direction[w][2 * d] + by_direction[w][2 * d + 1];
                way[w][d] = {way[w][2 * d][0] + way[w][2 * d + 1][0],
                             way[w][2 * d][1] + way[w][2 * d + 1][1]};
            }
            by_direction[w].resize(half);
            way[w].resize(half);
        }
    }
    std::vector<WorkSample> out;
    for (std::size_t w = 0; w < by_direction.size(); ++w) {
        for (std::size_t d = 0; d < by_direction[w].size(); ++d) {
            if (by_direction[w][d] <= 0) continue;
            const double length = std::hypot(way[w][d][0], way[w][d][1]);
            const Vec3 along =
                length > 0 ? Vec3{way[w][d][0] / length, way[w][d][1] / length, 0} : Vec3{};
            out.push_back({energy[w], by_direction[w][d], along});
        }
    }
    return out;
}

}  // namespace

// Of all strikes of one walk the strongest counts: an object falls once. Strikes of parts and
// directions are taken as independent, so P(strongest >= W) = 1 - prod (1 - p) over those of energy
// >= W.
std::vector<WorkSample> strongest_strikes(const Strikes& strikes, std::span<const double> energy) {
    std::vector<std::size_t> parts(energy.size());
    for (std::size_t n = 0; n < parts.size(); ++n) parts[n] = n;
    std::stable_sort(parts.begin(), parts.end(),
                     [&](auto a, auto b) { return energy[a] > energy[b]; });
    std::vector<std::vector<double>> share;
    std::vector<double> work;
    double missed = 1;  // by all parts so far
    for (const std::size_t part : parts) {
        double all = 0, miss = 1;
        for (const double p : strikes[part]) {
            all += p;
            miss *= 1 - std::clamp(p, 0.0, 1.0);
        }
        std::vector<double> row(direction_count, 0.0);
        for (unsigned d = 0; d < direction_count && all > 0; ++d) {
            row[d] = missed * (1 - miss) * strikes[part][d] / all;
        }
        missed *= miss;
        share.push_back(std::move(row));
        work.push_back(energy[part]);
    }
    return compact(std::move(share), work);
}

struct HumanField::Parts {
    device::Device& device;
    const Surroundings& surroundings;
    std::span<const RiskObject> objects;
    HumanOptions options;
    std::vector<std::int32_t> object_of_cell;
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
                       {}}) {
    check(options);
    Parts& p = *parts_;
    p.secondary =
        p.options.motion ? recorded_motion(*p.options.motion, p.options) : table_motion(p.options);
    p.map = walkable_map(surroundings, p.options);
    if (p.map.walkable.empty()) return;
    p.primary = primary_motion(p.map, p.options);
    if (p.primary.paths == 0) return;
    p.convolution = std::make_unique<Convolution>(device, p.map, p.primary, p.secondary,
                                                  surroundings, p.object_of_cell, p.options);
    p.levels = levels(p.map, 2 * p.convolution->band_m());
}

HumanField::~HumanField() = default;

Disturbance HumanField::disturbance() {
    Parts& p = *parts_;
    Disturbance out;
    out.name = "human";
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
        out.work[o] = strongest_strikes(
            strikes[o], taken_over(p.secondary, p.objects[o].mass_kg, p.options.restitution));
        for (const WorkSample& strike : out.work[o]) {
            const double force = strike.W_J / stopping_way_m;
            if (force > out.strongest[o].force_N) out.strongest[o] = {force, p.objects[o].height_m};
        }
    }
    out.samples = arrows.take();
    return out;
}

std::vector<std::vector<WorkSample>> HumanField::work_at(std::span<const Placement> placements) {
    Parts& p = *parts_;
    std::vector<std::vector<WorkSample>> out(placements.size());
    if (!p.convolution) return out;
    const auto cells = cells_of_objects(p.object_of_cell, p.objects.size());
    std::vector<Strikes> strikes(placements.size(), no_strikes(p.secondary));
    for (const Level& level : p.levels)
        p.convolution->add_placements(level.floor_m, level.component, cells, placements, strikes);
    for (std::size_t n = 0; n < out.size(); ++n) {
        const double mass = p.objects[placements[n].object].mass_kg;
        out[n] =
            strongest_strikes(strikes[n], taken_over(p.secondary, mass, p.options.restitution));
    }
    return out;
}

Disturbance human_field(device::Device& device, const Surroundings& surroundings,
                        std::span<const RiskObject> objects, const HumanOptions& options) {
    return HumanField(device, surroundings, objects, options).disturbance();
}

}  // namespace topple::safety

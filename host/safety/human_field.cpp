// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "safety/convolution.h"
#include "safety/fields.h"
#include "safety/objects.h"
#include "safety/walkable_map.h"

namespace topple::safety {
namespace {

void check(const HumanOptions& options) {
    check_option("cell_m", options.cell_m, 1e-3);
    check_option("body_radius_m", options.body_radius_m, 0);
    check_option("body_height_m", options.body_height_m, 0.1);
    check_option("step_height_m", options.step_height_m, 0);
    check_option("largest_hole_m", options.largest_hole_m, 0);
    check_option("body_mass_kg", options.body_mass_kg, 0);
    check_option("walking_speed_m_s", options.walking_speed_m_s, 0);
    check_option("wander_m", options.wander_m, 0);
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

Disturbance human_field(device::Device& device, const Surroundings& surroundings,
                        std::span<const RiskObject> objects, double /*friction*/,
                        const HumanOptions& options) {
    check(options);
    Disturbance out;
    out.name = "human";
    out.work.resize(objects.size());
    const auto object_of_cell = movable_object_of_cells(surroundings, objects);
    out.exposure.assign(object_of_cell.size(), 0.0f);
    const WalkableMap map = walkable_map(surroundings, options);
    out.notes = map.notes;
    if (map.walkable.empty()) return out;
    const PrimaryMotion motion = primary_motion(map, options);
    out.walks = drawn_walks(map, motion);
    if (motion.paths == 0) return out;

    out.draws = motion.paths;

    const SecondaryMotion secondary =
        options.motion ? recorded_motion(*options.motion, options) : table_motion(options);
    out.notes.insert(out.notes.end(), secondary.notes.begin(), secondary.notes.end());
    std::vector<Strikes> strikes(objects.size(), no_strikes(secondary));
    ArrowSample arrows;
    Convolution convolution(device, map, motion, secondary, surroundings, object_of_cell, options);
    for (const Level& level : levels(map, 2 * convolution.band_m())) {
        convolution.add_level(level.floor_m, level.component, strikes, out.exposure, arrows);
    }
    for (std::size_t o = 0; o < objects.size(); ++o)
        out.work[o] = strongest_strikes(strikes[o], secondary.energy_J);
    out.samples = arrows.take();
    return out;
}

}  // namespace topple::safety

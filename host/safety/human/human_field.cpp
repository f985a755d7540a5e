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
                // A hand hardly moves a wardrobe, a hip does.
                strike.sample.W_J =
                    motion.energy_J[level] * taken_share(object, m, strike.sample.direction,
                                                         strike.sample.height_m, restitution);
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

namespace {

// All that the field is made from, and answers questions by.
class Walkers {
  public:
    Walkers(device::Device& device, const Surroundings& surroundings,
            std::span<const RiskObject> objects, const HumanOptions& options)
        : surroundings_(surroundings),
          objects_(objects),
          options_(options),
          object_of_cell_(movable_object_of_cells(surroundings, objects)),
          extent_(extents(*surroundings.cells, object_of_cell_, objects)),
          secondary_(options.motions.empty() ? table_motion(options) : recorded_motion(options)),
          map_(walkable_map(surroundings, options)) {
        if (map_.walkable.empty()) return;
        primary_ = primary_motion(map_, options);
        if (primary_.paths == 0) return;
        convolution_ = std::make_unique<Convolution>(
            device, map_, primary_, secondary_, surroundings, object_of_cell_, extent_, options_);
        levels_ = levels(map_, 2 * convolution_->band_m());
    }

    bool any() const { return convolution_ != nullptr; }

    Disturbance disturbance() {
        Disturbance out;
        out.name = human_kind().name;
        out.work.resize(objects_.size());
        out.exposure.assign(object_of_cell_.size(), 0.0f);
        out.notes = map_.notes;
        out.notes.insert(out.notes.end(), secondary_.notes.begin(), secondary_.notes.end());
        if (!map_.walkable.empty()) out.walks = drawn_walks(map_, primary_);
        if (!any()) return out;
        out.draws = primary_.paths;

        strikes_.assign(objects_.size(), no_strikes(secondary_));
        ArrowSample arrows;
        SpaceSums space =
            options_.over_space ? SpaceSums({map_.x0, map_.y0, 0}, map_.cell_m) : SpaceSums();
        for (const Level& level : levels_)
            convolution_->add_level(level.floor_m, level.component, strikes_, out.exposure, arrows,
                                    space);
        out.samples = arrows.take();
        if (space.made()) out.space = space.take();
        out.work = work_if(objects_);
        out.strongest.resize(objects_.size());
        for (std::size_t o = 0; o < objects_.size(); ++o) {
            for (const WorkSample& strike : out.work[o]) {
                const double force = strike.W_J / stopping_way_m;
                if (force > out.strongest[o].force_N) out.strongest[o] = {force, strike.height_m};
            }
        }
        return out;
    }

    std::vector<std::vector<WorkSample>> work_if(std::span<const RiskObject> objects) const {
        std::vector<std::vector<WorkSample>> work;
        for (std::size_t o = 0; o < objects.size(); ++o)
            work.push_back(strongest_strikes(strikes_[o], secondary_, objects[o], extent_[o],
                                             options_.restitution));
        return work;
    }

    std::vector<Risk> risk_at(std::span<const Placement> placements) {
        const auto cells = cells_of_objects(object_of_cell_, objects_.size());
        std::vector<Strikes> strikes(placements.size(), no_strikes(secondary_));
        for (const Level& level : levels_)
            convolution_->add_placements(level.floor_m, level.component, cells, placements,
                                         strikes);
        std::vector<Risk> out;
        for (std::size_t n = 0; n < placements.size(); ++n) {
            const Placement& at = placements[n];
            const auto work = strongest_strikes(strikes[n], secondary_, at.there,
                                                extent_[at.object], options_.restitution);
            out.push_back(risk_of(work, at.there, primary_.paths));
        }
        return out;
    }

    std::vector<double> shares_passing(std::span<const FallZone> zones) const {
        return passing_shares(map_, primary_, Columns(*surroundings_.cells), options_, zones);
    }

  private:
    const Surroundings& surroundings_;
    std::span<const RiskObject> objects_;
    HumanOptions options_;
    std::vector<std::int32_t> object_of_cell_;
    std::vector<Extent> extent_;  // by object
    SecondaryMotion secondary_;
    WalkableMap map_;
    PrimaryMotion primary_;
    std::unique_ptr<Convolution> convolution_;  // none: nobody walks
    std::vector<Level> levels_;
    std::vector<Strikes> strikes_;  // by object
};

}  // namespace

Disturbance human_field(device::Device& device, const Surroundings& surroundings,
                        std::span<const RiskObject> objects, const HumanOptions& options) {
    const auto walkers = std::make_shared<Walkers>(device, surroundings, objects, options);
    Disturbance out = walkers->disturbance();
    if (!walkers->any()) return out;
    out.work_if = [walkers](std::span<const RiskObject> changed) {
        return walkers->work_if(changed);
    };
    out.risk_at = [walkers](std::span<const Placement> placements) {
        return walkers->risk_at(placements);
    };
    out.passing_shares = [walkers](std::span<const FallZone> zones) {
        return walkers->shares_passing(zones);
    };
    return out;
}

}  // namespace topple::safety

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "safety/human/human_field.h"
#include "safety/objects.h"
#include "safety/space_sums.h"

namespace topple::safety {
namespace {

// Fields of one scene, each of as many events as the others.
using KindFields = std::vector<Disturbance>;

// work_of(field): of each object, in one kind's events.
template <class WorkOf>
std::vector<std::vector<WorkSample>> mixed_work(const KindFields& kinds, std::size_t objects,
                                                const WorkOf& work_of) {
    std::vector<std::vector<WorkSample>> out(objects);
    for (const Disturbance& kind : kinds) {
        const std::vector<std::vector<WorkSample>>& work = work_of(kind);
        for (std::size_t o = 0; o < work.size(); ++o) {
            for (WorkSample sample : work[o]) {
                sample.probability /= static_cast<double>(kinds.size());
                out[o].push_back(sample);
            }
        }
    }
    return out;
}

// Their maps are of the same solids, and have the same cells.
Walks mixed_walks(const KindFields& kinds) {
    Walks out;
    for (const Disturbance& d : kinds) {
        const Walks& walks = d.walks;
        if (walks.visits.empty()) continue;
        if (out.visits.empty()) {
            out = walks;
            out.paths.clear();
            std::ranges::fill(out.visits, -1.0f);
        }
        for (std::size_t c = 0; c < out.visits.size(); ++c)
            if (walks.visits[c] >= 0)
                out.visits[c] = std::max(out.visits[c], 0.0f) +
                                walks.visits[c] / static_cast<float>(kinds.size());
        const std::size_t shown = std::min(walks.paths.size(), max_shown_paths / kinds.size());
        out.paths.insert(out.paths.end(), walks.paths.begin(),
                         walks.paths.begin() + static_cast<std::ptrdiff_t>(shown));
    }
    return out;
}

// Each counts as often as it comes; their maps, and so their cells, are the same.
std::optional<SpaceField> mixed_space(const KindFields& kinds) {
    SpaceSums sums;
    for (const Disturbance& d : kinds) {
        if (!d.space) continue;
        if (!sums.made()) sums = SpaceSums(d.space->corner_m, d.space->along_m[0][0]);
        sums.add(*d.space, 1.0f / static_cast<float>(kinds.size()));
    }
    if (!sums.made()) return std::nullopt;
    return sums.take();
}

// Mean risks: as if one of the kinds came at a time.
std::vector<Risk> mixed_risk(const KindFields& kinds, std::span<const Placement> placements) {
    const auto count = static_cast<double>(kinds.size());
    std::vector<Risk> out(placements.size());
    for (const Disturbance& kind : kinds) {
        if (!kind.risk_at) continue;  // nobody of it walks
        const std::vector<Risk> risks = kind.risk_at(placements);
        for (std::size_t n = 0; n < out.size(); ++n) {
            out[n].mean_J += risks[n].mean_J / count;
            out[n].spread_J = std::hypot(out[n].spread_J, risks[n].spread_J / count);
            out[n].chance += risks[n].chance / count;
        }
    }
    return out;
}

}  // namespace

Disturbance people_field(device::Device& device, const Surroundings& surroundings,
                         std::span<const RiskObject> objects, std::span<const HumanOptions> kinds) {
    if (kinds.size() == 1) return human_field(device, surroundings, objects, kinds.front());
    const auto fields = std::make_shared<KindFields>();
    for (const HumanOptions& kind : kinds)
        fields->push_back(human_field(device, surroundings, objects, kind));
    const auto count = static_cast<double>(fields->size());
    Disturbance out;
    out.name = human_kind().name;
    out.walks = mixed_walks(*fields);
    out.work = mixed_work(
        *fields, objects.size(), [](const Disturbance& d) -> const auto& { return d.work; });
    out.exposure.assign(surroundings.object.size(), 0.0f);
    out.space = mixed_space(*fields);
    out.draws = 0;
    ArrowSample arrows;
    for (Disturbance& d : *fields) {
        out.draws += d.draws;
        for (std::size_t c = 0; c < d.exposure.size(); ++c)
            out.exposure[c] += d.exposure[c] / static_cast<float>(count);
        for (std::size_t n = 0; n < d.samples.x.size(); ++n)
            arrows.offer({d.samples.x[n], d.samples.y[n], d.samples.z[n]},
                         {d.samples.vx[n], d.samples.vy[n], d.samples.vz[n]},
                         d.samples.density[n] / count);
        out.strongest.resize(std::max(out.strongest.size(), d.strongest.size()));
        for (std::size_t o = 0; o < d.strongest.size(); ++o)
            if (d.strongest[o].force_N > out.strongest[o].force_N)
                out.strongest[o] = d.strongest[o];
        for (const std::string& note : d.notes)
            if (std::ranges::find(out.notes, note) == out.notes.end()) out.notes.push_back(note);
        d.samples = {};
        d.exposure = {};
        d.walks = {};
        d.space.reset();
    }
    out.samples = arrows.take();
    if (std::ranges::none_of(*fields, [](const Disturbance& d) { return bool{d.work_if}; }))
        return out;
    out.work_if = [fields](std::span<const RiskObject> changed) {
        return mixed_work(*fields, changed.size(), [&](const Disturbance& d) {
            return d.work_if ? d.work_if(changed) : d.work;
        });
    };
    out.risk_at = [fields](std::span<const Placement> placements) {
        return mixed_risk(*fields, placements);
    };
    out.passing_shares = [fields, count](std::span<const FallZone> zones) {
        std::vector<double> shares(zones.size());
        for (const Disturbance& d : *fields) {
            const std::vector<double> own =
                d.passing_shares ? d.passing_shares(zones) : std::vector<double>{};
            for (std::size_t n = 0; n < own.size(); ++n) shares[n] += own[n] / count;
        }
        return shares;
    };
    return out;
}

}  // namespace topple::safety

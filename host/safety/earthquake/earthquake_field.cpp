// SPDX-License-Identifier: MIT
#include "safety/earthquake/earthquake_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numbers>

#include "core/number_text.h"
#include "core/random.h"
#include "core/thread_pool.h"
#include "physics/landscape.h"
#include "safety/columns.h"
#include "safety/earthquake/ground_motion.h"
#include "safety/earthquake/made_up_records.h"
#include "safety/fields.h"
#include "safety/objects.h"
#include "safety/space_sums.h"

namespace topple::safety {
namespace {

using physics::gravity;

constexpr std::size_t made_up_count = 15;  // three of each ground type

// Peaks are log-normal about the median, as ground motions are; two standard deviations bound them.
// Made-up records have peaks of 1 m/s^2.
std::vector<GroundEvent> random_events(const EarthquakeOptions& options) {
    Random random(options.seed);
    std::vector<GroundEvent> events(options.events);
    for (GroundEvent& event : events) {
        const auto [dx, dy] = direction(static_cast<unsigned>(random.below(direction_count)));
        const double radius = std::sqrt(-2 * std::log(1 - random.uniform()));  // Box-Muller
        const double normal = radius * std::cos(random.uniform(0, 2 * std::numbers::pi));
        const double peak =
            options.pga_m_s2 * std::exp(options.spread * std::clamp(normal, -2.0, 2.0));
        event = {static_cast<std::uint32_t>(random.below(made_up_count)), dx, dy,
                 options.floor_amplification * peak};
    }
    return events;
}

// What an event does to an object, wherever it stands.
struct Shaken {
    double energy_J = 0;  // of its turns and slips
    double raised_J = 0;  // of its turns
    // In each plane, each way: whether it overturned, how far it slid, and how far its support goes
    // on there, at least.
    struct Slip {
        Vec3 way{};
        bool overturns = false;
        double way_m = 0, support_m = 0;
    };
    std::array<Slip, 4> slips{};
    double together = 0;  // correlation of the slips in both planes
};

Shaken shaken_by(const ShakenObject& object, double mass_kg, const PlaneMotions& motions) {
    Shaken out;
    out.together = motions.together;
    for (std::size_t p = 0; p < 2; ++p) {
        const Motion& m = motions.in[p];
        const Profile& body = object.body[p];
        const auto [dx, dy] = object.way[p];
        Shaken::Slip &ahead = out.slips[2 * p], &behind = out.slips[2 * p + 1];
        ahead = {{dx, dy, 0}, !object.held};
        behind = {{-dx, -dy, 0}, !object.held};
        if (!object.held) continue;
        ahead = {ahead.way, m.overturned_ahead(), m.slid_ahead_m, body.support_ahead_m};
        behind = {behind.way, m.overturned_behind(), m.slid_behind_m, body.support_behind_m};
        const double slid = std::max(m.slid_ahead_m, m.slid_behind_m);
        out.energy_J = std::max(
            out.energy_J, mass_kg * std::max(m.raised_J_kg(body), body.friction * gravity * slid));
        out.raised_J = std::max(out.raised_J, mass_kg * m.raised_J_kg(body));
    }
    return out;
}

// Where it was when it had slid furthest each way of one plane: in the other it was then, in the
// mean, at its own furthest times the correlation.
std::array<Vec3, 4> furthest_slips(const Shaken& shaken) {
    std::array<Vec3, 4> out;
    for (std::size_t s = 0; s < out.size(); ++s) {
        const std::size_t other = 2 - s / 2 * 2;  // of the other plane, ahead
        const bool ahead = (s % 2 == 0) == (shaken.together > 0);
        const Shaken::Slip &slip = shaken.slips[s], &beside = shaken.slips[other + (ahead ? 0 : 1)];
        const double drawn_m = std::abs(shaken.together) * beside.way_m;
        for (std::size_t c = 0; c < 2; ++c)
            out[s][c] = slip.way_m * slip.way[c] + drawn_m * beside.way[c];
    }
    return out;
}

// Where it goes, of all ways in which it falls the one that takes least; or, where it does not
// fall, of all ways that it was shaken. What the shaking brings an object that overturns is what
// lifts it over that edge, and not what takes it over one that lies beyond: where it comes to rest
// no lower behind it, or leans, it has not fallen.
struct Outcome {
    bool falls = false;
    double energy_J = 0;  // that takes it there: what slips lose to friction lifts nothing
    Vec3 towards{};
    double barrier_J = std::numeric_limits<double>::infinity();
};
Outcome outcome_of(const RiskObject& object, const Shaken& shaken) {
    Outcome fallen{true}, shaken_only;
    const auto weigh = [&](const Vec3& way, double barrier, double energy_J, Outcome& outcome) {
        if (barrier >= outcome.barrier_J) return;
        outcome.barrier_J = barrier;
        outcome.energy_J = energy_J;
        outcome.towards = way;
    };
    for (const Shaken::Slip& slip : shaken.slips) {
        weigh(slip.way, push_barrier_J(object, slip.way), shaken.energy_J, shaken_only);
        const double over_edge = over_edge_J(object, slip.way);
        const WorkSample turned{std::max(shaken.raised_J, over_edge), 1, slip.way};
        if (slip.overturns && instability(object, turned) > 0)
            weigh(slip.way, over_edge, shaken.raised_J, fallen);
        const bool off = !object.toppling && slip.way_m > 0 &&
                         slip.way_m >= slide_towards_m(object, slip.way, slip.support_m);
        if (off) weigh(slip.way, push_barrier_J(object, slip.way), shaken.energy_J, fallen);
    }
    for (const Vec3& slid : furthest_slips(shaken)) {
        const double far = std::hypot(slid[0], slid[1]);
        if (!object.toppling || !(far > 0)) continue;
        const Vec3 way{slid[0] / far, slid[1] / far, 0};
        if (far >= slide_towards_m(object, way, 0))
            weigh(way, push_barrier_J(object, way), shaken.energy_J, fallen);
    }
    return std::isfinite(fallen.barrier_J) ? fallen : shaken_only;
}

// What the ideal body needs to fall and what the landscape says differ by the voxels; and a motion
// may hold more energy than the weakest way takes, and yet not go that way. Where it can't fall,
// its energy brings nothing.
double work_of(const Shaken& shaken, const Outcome& outcome) {
    const double barrier = outcome.barrier_J;
    if (barrier <= 0 || !std::isfinite(barrier)) return shaken.energy_J;
    constexpr double just_below = 1 - 1e-6;
    return outcome.falls ? std::max(outcome.energy_J, barrier)
                         : std::min(shaken.energy_J, just_below * barrier);
}

// Work of all events, from the motions that they make; also where it is 0: what has no barrier
// falls at any shaking.
std::vector<WorkSample> work_of(const std::vector<Shaken>& shaken, const RiskObject& object) {
    std::vector<WorkSample> work;
    for (const Shaken& each : shaken) {
        const Outcome outcome = outcome_of(object, each);
        work.push_back(
            {work_of(each, outcome), 1.0 / static_cast<double>(shaken.size()), outcome.towards});
    }
    return work;
}

std::vector<Shaken> shaken_by_all(const ShakenObject& body, double mass_kg,
                                  const std::vector<PlaneMotions>& motions) {
    std::vector<Shaken> out;
    for (const PlaneMotions& motion : motions) out.push_back(shaken_by(body, mass_kg, motion));
    return out;
}

// Slips on supports that end nowhere near go on for ever.
ShakenObject where_it_stands(const RiskObject& object, ShakenObject shaken) {
    for (Profile& body : shaken.body) {
        for (double* support : {&body.support_ahead_m, &body.support_behind_m}) {
            *support = object.slide_distance_m < 0 ? INFINITY
                                                   : std::max(object.slide_distance_m, *support);
        }
    }
    return shaken;
}

void note_record(const Accelerogram& record, std::vector<std::string>& notes) {
    notes = record.notes;
    notes.push_back("The earthquake is the accelerogram " + record.source + ", " +
                    to_digits(record.duration_s(), 3) + " s with a peak of " +
                    to_digits(record.peak_m_s2(), 3) + " m/s^2.");
}

// The contact surface: calls visit(o, c, place) for the lowest cells c of the objects o.
struct Contacts {
    const SolidCells& solid;
    std::span<const std::size_t> which;
    std::span<const std::vector<std::uint32_t>> cells;  // by object
    std::span<const MassSpread> stances;

    template <class Visit>
    void each(const Visit& visit) const {
        const double h = solid.voxel_m;
        for (const std::size_t o : which) {
            const double bottom_m = stances[o].bottom_m;
            for (const std::uint32_t c : cells[o]) {
                if ((solid.k[c] + 0.5) * h > bottom_m + h) continue;
                visit(o, c, Vec3{(solid.i[c] + 0.5) * h, (solid.j[c] + 0.5) * h, bottom_m});
            }
        }
    }
};

FieldSamples arrows_at(const Contacts& contacts, std::span<const RiskObject> objects,
                       std::span<const GroundEvent> events, std::span<const double> peaks) {
    ArrowSample arrows;
    contacts.each([&](std::size_t o, std::uint32_t c, const Vec3& place) {
        const std::size_t e = c % events.size();
        const double peak = objects[o].floor_shakes * peaks[e];
        arrows.offer(place, {peak * events[e].dx, peak * events[e].dy, 0}, 1);
    });
    return arrows.take();
}

// energy_J_kg: on the ground floor.
SpaceField over_contacts(const Contacts& contacts, std::span<const RiskObject> objects,
                         double energy_J_kg) {
    const double cell_m = std::max(0.05, contacts.solid.voxel_m);
    std::map<std::array<std::int32_t, 3>, double> energies;
    contacts.each([&](std::size_t o, std::uint32_t, const Vec3& place) {
        std::array<std::int32_t, 3> cell{};
        for (std::size_t a = 0; a < 3; ++a)
            cell[a] = static_cast<std::int32_t>(std::floor(place[a] / cell_m));
        double& energy = energies[cell];
        energy = std::max(energy, objects[o].floor_shakes * objects[o].floor_shakes * energy_J_kg);
    });
    SpaceSums sums({}, cell_m);
    for (const auto& [cell, energy] : energies) sums.add(cell, {1, {}, static_cast<float>(energy)});
    SpaceField out = sums.take();
    out.energy_unit = "J/kg";
    return out;
}

}  // namespace

Disturbance earthquake_field(device::Device& device, const Surroundings& surroundings,
                             std::span<const RiskObject> objects,
                             const EarthquakeOptions& options) {
    Disturbance out;
    out.name = earthquake_kind().name;
    out.work.resize(objects.size());
    out.response.resize(objects.size());
    out.strongest.resize(objects.size());
    const auto object_of_cell = movable_object_of_cells(surroundings, objects);
    const auto cells = cells_of_objects(object_of_cell, objects.size());
    out.exposure.assign(object_of_cell.size(), 0.0f);
    for (std::size_t c = 0; c < object_of_cell.size(); ++c)
        if (object_of_cell[c] >= 0) out.exposure[c] = 1;
    const std::vector<Accelerogram> records = options.record
                                                  ? std::vector{*options.record}
                                                  : made_up_records(made_up_count, options.seed);
    const std::vector<GroundEvent> events =
        options.record ? from_all_ways(0, options.floor_amplification) : random_events(options);
    out.draws = events.size();
    if (options.record) note_record(*options.record, out.notes);

    const auto solid_columns = std::make_shared<const Columns>(*surroundings.cells);
    const Columns& columns = *solid_columns;
    std::vector<MassSpread> stances(objects.size());
    std::vector<ShakenObject> bodies(objects.size()), standing(objects.size());
    device.threads().each(objects.size(), 1, [&](std::size_t o) {
        if (cells[o].empty() || objects[o].grounded) return;
        stances[o] = stance(surroundings, cells[o], objects[o]);
        bodies[o] = shaken_object(objects[o], stances[o], columns);
        standing[o] = where_it_stands(objects[o], bodies[o]);
    });
    std::vector<std::size_t> which;
    for (std::size_t o = 0; o < objects.size(); ++o)
        if (!cells[o].empty() && !objects[o].grounded) which.push_back(o);
    std::vector<double> peaks;  // of what they stand on
    for (const GroundEvent& event : events)
        peaks.push_back(event.scale * records[event.record].peak_m_s2());

    const Motions motions = shake_objects(device, bodies, which, records, events, true);
    for (const std::size_t o : which) {
        for (std::size_t e = 0; e < events.size(); ++e) {
            const double force = objects[o].mass_kg * objects[o].floor_shakes * peaks[e];
            if (force > out.strongest[o].force_N)
                out.strongest[o] = {force, bodies[o].body[0].height_m};
        }
        out.response[o] = [shaken = shaken_by_all(bodies[o], objects[o].mass_kg, motions[o])](
                              const RiskObject& object) { return work_of(shaken, object); };
        out.work[o] = out.response[o](objects[o]);
    }
    // What stands on a wider or narrower base moves in another way.
    out.work_if = [&device, solid_columns, stances, which, records,
                   events](std::span<const RiskObject> changed) {
        std::vector<ShakenObject> shaken(changed.size());
        for (const std::size_t o : which)
            shaken[o] = shaken_object(changed[o], stances[o], *solid_columns);
        const Motions moved = shake_objects(device, shaken, which, records, events, true);
        std::vector<std::vector<WorkSample>> work(changed.size());
        for (const std::size_t o : which)
            work[o] = work_of(shaken_by_all(shaken[o], changed[o].mass_kg, moved[o]), changed[o]);
        return work;
    };
    out.fragility = fragilities(device, standing, which, records, options.floor_amplification,
                                options.hazard ? &*options.hazard : nullptr);
    const Contacts contacts{*surroundings.cells, which, cells, stances};
    out.samples = arrows_at(contacts, objects, events, peaks);
    if (options.over_space) {
        double squares = 0;
        for (const GroundEvent& event : events)
            squares += std::pow(event.scale * peak_velocity_m_s(records[event.record]), 2);
        out.space =
            over_contacts(contacts, objects, squares / 2 / static_cast<double>(events.size()));
    }
    return out;
}

}  // namespace topple::safety

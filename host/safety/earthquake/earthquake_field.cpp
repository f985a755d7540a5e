// SPDX-License-Identifier: MIT
#include "safety/earthquake/earthquake_field.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/random.h"
#include "core/thread_pool.h"
#include "physics/landscape.h"
#include "safety/columns.h"
#include "safety/fields.h"
#include "safety/objects.h"

namespace topple::safety {
namespace {

using physics::gravity;

struct Event {
    double peak = 0;  // m/s^2
    double dx = 1, dy = 0;
};

// Peaks are log-normal about the median, as ground motions are; two standard deviations bound them.
std::vector<Event> random_pulses(const EarthquakeOptions& options) {
    Random random(options.seed);
    std::vector<Event> pulses(options.events);
    for (Event& pulse : pulses) {
        const double angle = random.uniform(0, 2 * std::numbers::pi);
        const double radius = std::sqrt(-2 * std::log(1 - random.uniform()));  // Box-Muller
        const double normal = radius * std::cos(random.uniform(0, 2 * std::numbers::pi));
        pulse.peak = options.pga_m_s2 * std::exp(options.spread * std::clamp(normal, -2.0, 2.0));
        pulse.dx = std::cos(angle);
        pulse.dy = std::sin(angle);
    }
    return pulses;
}

std::vector<Event> all_ways(const Accelerogram& record) {
    std::vector<Event> events;
    for (unsigned d = 0; d < direction_count; ++d) {
        const auto [dx, dy] = direction(d);
        events.push_back({record.peak_m_s2(), dx, dy});
    }
    return events;
}

// Work of the pulse on a body that rocks about its edge ahead (linearised: Housner 1963).
double rocking_work(double mass_kg, const Profile& body, double acceleration, double duration_s) {
    const double eta = acceleration * body.height_m / (gravity * body.ahead_m);
    if (eta <= 1) return 0;
    const double radius = std::hypot(body.ahead_m, body.height_m);
    const double p =
        std::sqrt(gravity * radius / (body.gyration_m * body.gyration_m + radius * radius));
    const double growth = std::cosh(std::min(p * duration_s, 50.0)) - 1;
    return tipping_energy(mass_kg, body.height_m, body.ahead_m) * 2 * eta * (eta - 1) * growth;
}

// What an event does to a body, wherever it stands.
struct Shaken {
    double energy_J = 0;
    bool overturns = false;
    Sliding slid{};
    // How far the support goes on, at least, that way and the other.
    double support_ahead_m = 0, support_behind_m = 0;
};

// What the ideal body needs to fall and what the landscape says differ by the voxels; and a motion
// may hold more energy than the weakest way takes, and yet not go that way.
// `towards`: where the object then falls.
double work_of(const RiskObject& object, const Shaken& shaken, const Vec3& way,
               const Vec3& towards) {
    const double barrier = push_barrier_J(object, towards);
    // Where it can't fall, its energy brings nothing.
    if (barrier <= 0 || !std::isfinite(barrier)) return shaken.energy_J;
    const auto beyond = [&](double way_m, const Vec3& along, double support_m) {
        return way_m > 0 && way_m >= slide_towards_m(object, along, support_m);
    };
    const bool slides_off =
        beyond(shaken.slid.ahead_m, way, shaken.support_ahead_m) ||
        beyond(shaken.slid.behind_m, {-way[0], -way[1], 0}, shaken.support_behind_m);
    return shaken.overturns || slides_off ? std::max(shaken.energy_J, barrier)
                                          : std::min(shaken.energy_J, std::nextafter(barrier, 0.0));
}

// A record shakes both ways: that of the two in which it falls more easily.
Vec3 easier(const RiskObject& object, const Vec3& way) {
    const Vec3 back{-way[0], -way[1], 0};
    return push_barrier_J(object, back) < push_barrier_J(object, way) ? back : way;
}

Shaken shaken_by_pulse(double mass_kg, const Profile& body, double acceleration, double friction,
                       double duration_s) {
    if (!(mass_kg > 0) || !(body.height_m > 0)) return {};
    if (body.ahead_m <= 0) return {0, true};  // nothing holds it that way: any push tips it
    if (body.rocks_ahead(friction)) {
        const double work = rocking_work(mass_kg, body, acceleration, duration_s);
        return {work, work >= tipping_energy(mass_kg, body.height_m, body.ahead_m)};
    }
    // It lags behind, then comes to rest by friction.
    const double force = friction * mass_kg * gravity;
    const double excess = acceleration - friction * gravity;
    if (excess <= 0) return {};
    const double work = 0.5 * mass_kg * excess * acceleration * duration_s * duration_s;
    return {work, false, {work / force, 0}, body.support_ahead_m};
}

Shaken shaken_by_record(double mass_kg, const Profile& body, const Accelerogram& record,
                        double friction) {
    if (!(mass_kg > 0) || !(body.height_m > 0)) return {};
    if (body.ahead_m <= 0 || body.behind_m <= 0) return {0, true};
    const Rocking rocking = rock(body, record, friction);
    const Sliding sliding = slide(body, record, friction);
    const double way = std::max(sliding.ahead_m, sliding.behind_m);
    return {mass_kg * std::max(rocking.energy_J_kg, friction * gravity * way), rocking.overturns,
            sliding, body.support_ahead_m, body.support_behind_m};
}

}  // namespace

double pulse_work(const RiskObject& object, const Profile& body, double acceleration,
                  double friction, double duration_s) {
    return work_of(
        object, shaken_by_pulse(object.mass_kg, body, acceleration, friction, duration_s), {}, {});
}

double record_work(const RiskObject& object, const Profile& body, const Accelerogram& record,
                   double friction) {
    return work_of(object, shaken_by_record(object.mass_kg, body, record, friction), {}, {});
}

Disturbance earthquake_field(device::Device& device, const Surroundings& surroundings,
                             std::span<const RiskObject> objects, double friction,
                             const EarthquakeOptions& options) {
    check_option("pga_m_s2", options.pga_m_s2, 0);
    check_option("spread", options.spread, 0);
    check_option("dominant_period_s", options.dominant_period_s, 0);
    check_option("friction", friction, 0);
    if (options.record) check_option("record.step_s", options.record->step_s, 1e-6);
    Disturbance out;
    out.name = "earthquake";
    out.work.resize(objects.size());
    out.response.resize(objects.size());
    out.strongest.resize(objects.size());
    const auto object_of_cell = movable_object_of_cells(surroundings, objects);
    const auto cells = cells_of_objects(object_of_cell, objects.size());
    out.exposure.assign(object_of_cell.size(), 0.0f);
    const std::vector<Event> events =
        options.record ? all_ways(*options.record) : random_pulses(options);
    out.draws = events.size();
    if (options.record) {
        out.notes = options.record->notes;
        char figures[80];
        std::snprintf(figures, sizeof(figures), "%.3g s with a peak of %.3g m/s^2.",
                      options.record->duration_s(), options.record->peak_m_s2());
        out.notes.push_back("The earthquake is the accelerogram " + options.record->source + ", " +
                            figures);
    }
    const SolidCells& solid = *surroundings.cells;

    const Columns columns(solid);
    std::vector<Stance> stances(objects.size());
    device.threads().each(objects.size(), 1, [&](std::size_t o) {
        if (cells[o].empty() || objects[o].grounded) return;
        stances[o] = stance(surroundings, cells[o]);
        std::vector<std::pair<Shaken, Vec3>> shaken;
        for (const Event& event : events) {
            const Profile body = profile(objects[o], stances[o], columns, event.dx, event.dy);
            const double mass = objects[o].mass_kg;
            shaken.emplace_back(options.record
                                    ? shaken_by_record(mass, body, *options.record, friction)
                                    : shaken_by_pulse(mass, body, event.peak, friction,
                                                      options.dominant_period_s / 2),
                                Vec3{event.dx, event.dy, 0});
            const double force = mass * event.peak;
            if (force > out.strongest[o].force_N) out.strongest[o] = {force, body.height_m};
        }
        out.response[o] = [shaken = std::move(shaken),
                           both = options.record.has_value()](const RiskObject& object) {
            std::vector<WorkSample> work;
            // Also where it is 0: what has no barrier falls at any shaking.
            for (const auto& [motion, way] : shaken) {
                const Vec3 towards = both ? easier(object, way) : way;
                work.push_back({work_of(object, motion, way, towards),
                                1.0 / static_cast<double>(shaken.size()), towards});
            }
            return work;
        };
        out.work[o] = out.response[o](objects[o]);
    });
    ArrowSample arrows;
    for (std::size_t o = 0; o < objects.size(); ++o) {
        if (out.work[o].empty()) continue;
        // Arrows at the contact surface: the object's lowest cells.
        const double bottom_m = stances[o].bottom_m;
        for (const std::uint32_t c : cells[o]) {
            out.exposure[c] = 1;
            if ((solid.k[c] + 0.5) * solid.voxel_m > bottom_m + solid.voxel_m) continue;
            const Event& event = events[c % events.size()];
            arrows.offer(
                {(solid.i[c] + 0.5) * solid.voxel_m, (solid.j[c] + 0.5) * solid.voxel_m, bottom_m},
                {event.peak * event.dx, event.peak * event.dy, 0}, 1);
        }
    }
    out.samples = arrows.take();
    if (out.samples.x.empty())
        out.notes.push_back("No object of the scene can be moved by an earthquake.");
    return out;
}

}  // namespace topple::safety

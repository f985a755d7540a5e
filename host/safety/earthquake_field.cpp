// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "physics/landscape.h"
#include "safety/fields.h"
#include "safety/objects.h"

namespace topple::safety {
namespace {

using physics::gravity;

struct Pulse {
    double peak = 0;  // m/s^2
    double dx = 1, dy = 0;
};

// Peaks are log-normal about the median, as ground motions are; two standard deviations bound them.
std::vector<Pulse> random_pulses(const EarthquakeOptions& options) {
    Random random(options.seed);
    std::vector<Pulse> pulses(options.events);
    for (Pulse& pulse : pulses) {
        const double angle = random.uniform(0, 2 * std::numbers::pi);
        const double radius = std::sqrt(-2 * std::log(1 - random.uniform()));  // Box-Muller
        const double normal = radius * std::cos(random.uniform(0, 2 * std::numbers::pi));
        pulse.peak = options.pga_m_s2 * std::exp(options.spread * std::clamp(normal, -2.0, 2.0));
        pulse.dx = std::cos(angle);
        pulse.dy = std::sin(angle);
    }
    return pulses;
}

// Friction turns the pulse into sliding: the object lags behind, then comes to rest by friction.
double sliding_work(double mass_kg, double acceleration, double friction, double duration_s) {
    const double excess = acceleration - friction * gravity;
    if (excess <= 0) return 0;
    return 0.5 * mass_kg * excess * acceleration * duration_s * duration_s;  // mu m g s
}

// Work of the pulse on a block that rocks about its edge (linearised: Housner 1963).
double rocking_work(double mass_kg, double acceleration, double half_base_m, double height_m,
                    double duration_s) {
    const double eta = acceleration * height_m / (gravity * half_base_m);
    if (eta <= 1) return 0;
    const double p = std::sqrt(3 * gravity / (4 * std::hypot(half_base_m, height_m)));
    const double growth = std::cosh(std::min(p * duration_s, 50.0)) - 1;
    return tipping_energy(mass_kg, height_m, half_base_m) * 2 * eta * (eta - 1) * growth;
}

}  // namespace

double earthquake_work(const RiskObject& object, double half_base_m, double height_m,
                       double acceleration, double friction, double duration_s) {
    if (!(object.mass_kg > 0) || !(height_m > 0)) return 0;
    if (half_base_m <= 0) return object.barrier_J;  // nothing holds it that way: any push tips it
    if (half_base_m / height_m >= friction) {
        return sliding_work(object.mass_kg, acceleration, friction, duration_s);
    }
    const double work =
        rocking_work(object.mass_kg, acceleration, half_base_m, height_m, duration_s);
    // What the ideal block needs to overturn and what the landscape says differ by the voxels.
    const bool overturns = work >= tipping_energy(object.mass_kg, height_m, half_base_m);
    return overturns ? std::max(work, object.barrier_J) : work;
}

Disturbance earthquake_field(device::Device&, const Surroundings& surroundings,
                             std::span<const RiskObject> objects, double friction,
                             const EarthquakeOptions& options) {
    check_option("pga_m_s2", options.pga_m_s2, 0);
    check_option("spread", options.spread, 0);
    check_option("dominant_period_s", options.dominant_period_s, 0);
    check_option("friction", friction, 0);
    Disturbance out;
    out.name = "earthquake";
    out.work.resize(objects.size());
    const auto object_of_cell = movable_object_of_cells(surroundings, objects);
    const auto cells = cells_of_objects(object_of_cell, objects.size());
    out.exposure.assign(object_of_cell.size(), 0.0f);
    const std::vector<Pulse> pulses = random_pulses(options);
    out.draws = pulses.size();
    const physics::SolidCells& solid = *surroundings.cells;

    ArrowSample arrows;
    for (std::size_t o = 0; o < objects.size(); ++o) {
        if (cells[o].empty() || objects[o].grounded) continue;
        const Stance stands = stance(surroundings, cells[o]);
        for (const Pulse& pulse : pulses) {
            const double base = half_base(objects[o], stands, pulse.dx, pulse.dy);
            const double work = earthquake_work(objects[o], base, stands.height(), pulse.peak,
                                                friction, options.dominant_period_s / 2);
            // Also where it is 0: what has no barrier falls at any shaking.
            out.work[o].push_back({work, 1.0 / options.events, {pulse.dx, pulse.dy, 0}});
        }
        // Arrows at the contact surface: the object's lowest cells.
        for (const std::uint32_t c : cells[o]) {
            out.exposure[c] = 1;
            if (pulses.empty() ||
                (solid.k[c] + 0.5) * solid.voxel_m > stands.bottom_m + solid.voxel_m) {
                continue;
            }
            const Pulse& pulse = pulses[c % pulses.size()];
            arrows.offer({(solid.i[c] + 0.5) * solid.voxel_m, (solid.j[c] + 0.5) * solid.voxel_m,
                          stands.bottom_m},
                         {pulse.peak * pulse.dx, pulse.peak * pulse.dy, 0}, 1);
        }
    }
    out.samples = arrows.take();
    if (out.samples.x.empty())
        out.notes.push_back("No object of the scene can be moved by an earthquake.");
    return out;
}

}  // namespace topple::safety

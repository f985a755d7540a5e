// SPDX-License-Identifier: MIT
#include "safety/earthquake/made_up_records.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/random.h"

namespace topple::safety {
namespace {

constexpr double record_step_s = 0.01, record_s = 30;
constexpr double vertical_share = 2.0 / 3, vertical_quicker = 1.5;

struct Soil {
    const char* name;
    double ground_rad_s, ground_damping, slow_rad_s, slow_damping;
    double fades_per_s;  // b of t exp(-b t / 2)
};
constexpr std::array<Soil, 5> soils{{{"A", 17.57, 0.54, 2.22, 0.78, 0.47},
                                     {"B", 10.73, 0.78, 2.33, 0.90, 0.58},
                                     {"C", 7.49, 0.84, 2.14, 1.15, 0.50},
                                     {"D", 5.34, 0.88, 2.12, 1.17, 0.50},
                                     {"E", 10.76, 0.77, 2.03, 1.07, 0.50}}};

// Normal, nearly: the sum of twelve uniform numbers, which is the same on every machine.
double normal_number(Random& random) {
    double sum = -6;
    for (int n = 0; n < 12; ++n) sum += random.uniform();
    return sum;
}

// Place and speed of both filters.
using Filters = std::array<double, 4>;

Filters change(const Filters& y, const Soil& soil, double noise) {
    const double thrown = -2 * soil.ground_damping * soil.ground_rad_s * y[1] -
                          soil.ground_rad_s * soil.ground_rad_s * y[0];
    return {y[1], thrown - noise, y[3],
            -thrown - 2 * soil.slow_damping * soil.slow_rad_s * y[3] -
                soil.slow_rad_s * soil.slow_rad_s * y[2]};
}

Filters moved(const Filters& y, const Filters& by, double step) {
    Filters out = y;
    for (std::size_t n = 0; n < out.size(); ++n) out[n] += step * by[n];
    return out;
}

// One component, its peak 1 m/s^2.
std::vector<double> component(const Soil& soil, Random random) {
    std::vector<double> out;
    Filters y{};
    double peak = 0;
    const auto steps = static_cast<std::size_t>(std::lround(record_s / record_step_s));
    for (std::size_t n = 0; n <= steps; ++n) {
        const double t = record_step_s * static_cast<double>(n);
        const double noise = t * std::exp(-soil.fades_per_s * t / 2) * normal_number(random);
        // Runge and Kutta's fourth order, the noise being the same all through the step.
        const Filters k1 = change(y, soil, noise),
                      k2 = change(moved(y, k1, record_step_s / 2), soil, noise),
                      k3 = change(moved(y, k2, record_step_s / 2), soil, noise),
                      k4 = change(moved(y, k3, record_step_s), soil, noise);
        out.push_back(k1[3]);
        peak = std::max(peak, std::fabs(k1[3]));
        for (std::size_t i = 0; i < y.size(); ++i)
            y[i] += record_step_s / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    }
    for (double& a : out) a /= peak;
    return out;
}

}  // namespace

std::vector<Accelerogram> made_up_records(std::size_t count, std::uint64_t seed) {
    std::vector<Accelerogram> out;
    const Random all(seed);
    for (std::size_t n = 0; n < count; ++n) {
        const Soil& soil = soils[n % soils.size()];
        Accelerogram record;
        record.step_s = record_step_s;
        record.m_s2 = component(soil, all.split(3 * n));
        record.across_m_s2 = component(soil, all.split(3 * n + 1));
        Soil quick = soil;
        quick.ground_rad_s *= vertical_quicker;
        quick.slow_rad_s *= vertical_quicker;
        record.up_m_s2 = component(quick, all.split(3 * n + 2));
        for (double& a : record.up_m_s2) a *= vertical_share;
        record.source = std::string("made up, ground type ") + soil.name;
        out.push_back(std::move(record));
    }
    return out;
}

double peak_velocity_m_s(const Accelerogram& record) {
    const auto peak_of = [&](const std::vector<double>& m_s2) {
        double velocity = 0, peak = 0;
        for (std::size_t n = 0; n + 1 < m_s2.size(); ++n) {
            velocity += 0.5 * record.step_s * (m_s2[n] + m_s2[n + 1]);
            peak = std::max(peak, std::fabs(velocity));
        }
        return peak;
    };
    const double along = peak_of(record.m_s2);
    return record.across_m_s2.empty() ? along : std::sqrt(along * peak_of(record.across_m_s2));
}

}  // namespace topple::safety

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "safety/fields.h"

namespace topple::safety {

double instability(std::span<const InstabilityStep> curve, double W_J) {
    double release = 0;
    for (const InstabilityStep& step : curve) {
        if (step.W_J > W_J) break;  // ascending in W
        release = std::max(release, step.S_J);
    }
    return release;
}

namespace {

// What does to the object as it was measured what W does to it; below 0: nothing does. What reaches
// its barrier does so in spite of rounding.
double measured_W_J(const RiskObject& object, double W_J) {
    if (object.root_shift == 0) return W_J;
    const double root = std::sqrt(W_J) * (1 + 1e-9) - object.root_shift;
    return root < 0 ? -1 : root * root;
}

// The other way round: of what does something to the object as it was measured.
double at_end_J(const RiskObject& object, double measured_J) {
    if (object.root_shift == 0) return measured_J;
    const double root = std::max(0.0, std::sqrt(measured_J) + object.root_shift);
    return root * root;
}

}  // namespace

double instability(const RiskObject& object, const WorkSample& event) {
    const double W_J = measured_W_J(object, event.W_J);
    if (!object.toppling) return instability(object.curve, W_J);
    if (std::isnan(event.height_m)) return object.toppling->pushed_J(W_J, event.direction);
    return object.toppling->struck_J(W_J, event.direction, event.height_m);
}

double met_mass_kg(const RiskObject& object, const Vec3& way, double height_m) {
    return object.toppling ? object.toppling->met_mass_kg(way, height_m) : object.mass_kg;
}

double taken_share(const RiskObject& object, double mass_kg, const Vec3& way, double height_m,
                   double restitution) {
    const double met_kg = met_mass_kg(object, way, height_m), both = mass_kg + met_kg;
    return both > 0 ? mass_kg * met_kg * std::pow((1 + restitution) / both, 2) : 0;
}

double push_barrier_J(const RiskObject& object, const Vec3& way) {
    return at_end_J(object,
                    object.toppling ? object.toppling->push_barrier_J(way) : object.barrier_J);
}

double over_edge_J(const RiskObject& object, const Vec3& way) {
    return at_end_J(object, object.toppling ? object.toppling->over_edge_J(way) : object.barrier_J);
}

double slide_towards_m(const RiskObject& object, const Vec3& way, double support_m) {
    if (!object.toppling && object.slide_distance_m < 0)
        return std::numeric_limits<double>::infinity();
    const double measured = object.toppling ? object.toppling->slide_distance_m(way)
                                            : std::max(object.slide_distance_m, support_m);
    return std::max(0.0, measured + object.border_shift_m);
}

Risk risk_of(std::span<const WorkSample> work, const RiskObject& object, std::size_t draws) {
    double mean = 0, square = 0, chance = 0;
    for (const WorkSample& sample : work) {
        const double release = instability(object, sample);
        mean += sample.probability * release;
        square += sample.probability * release * release;
        if (release > 0) chance += sample.probability;
    }
    const double variance = std::max(0.0, square - mean * mean);
    return {mean, std::sqrt(variance / static_cast<double>(std::max<std::size_t>(draws, 1))),
            chance};
}

std::vector<Risk> risk(const Disturbance& disturbance, std::span<const RiskObject> objects) {
    std::vector<Risk> out(objects.size());
    for (std::size_t o = 0; o < objects.size(); ++o) {
        if (objects[o].grounded) continue;
        out[o] = risk_of(disturbance.work[o], objects[o], disturbance.draws);
    }
    return out;
}

std::vector<Risk> risk_if(const Disturbance& disturbance, std::span<const RiskObject> changed) {
    Disturbance there;
    there.draws = disturbance.draws;
    if (disturbance.work_if) {
        there.work = disturbance.work_if(changed);
    } else {
        there.work = disturbance.work;
        for (std::size_t o = 0; o < disturbance.response.size() && o < changed.size(); ++o)
            if (disturbance.response[o]) there.work[o] = disturbance.response[o](changed[o]);
    }
    return risk(there, changed);
}

std::vector<double> unsafety(std::span<const std::vector<Risk>> risks) {
    std::vector<double> worst;
    for (const auto& of_disturbance : risks) {
        worst.resize(std::max(worst.size(), of_disturbance.size()), 0.0);
        for (std::size_t o = 0; o < of_disturbance.size(); ++o) {
            if (std::isfinite(of_disturbance[o].mean_J))
                worst[o] = std::max(worst[o], of_disturbance[o].mean_J);
        }
    }
    const double most = worst.empty() ? 0 : *std::max_element(worst.begin(), worst.end());
    std::vector<double> out(worst.size(), 1.0);
    if (most <= 0) return out;
    for (std::size_t o = 0; o < out.size(); ++o) {
        out[o] = 1 + 9 * std::log1p(999 * (worst[o] / most)) / std::log(1000.0);
    }
    return out;
}

}  // namespace topple::safety

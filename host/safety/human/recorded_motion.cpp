// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <tuple>

#include "safety/directions.h"
#include "safety/human/human_field.h"
#include "safety/human/posed_body.h"
#include "safety/human/secondary_motion.h"
#include "topple/error.h"

namespace topple::safety {
namespace {

using enum BodyJoint;

constexpr unsigned energy_levels = 8;
constexpr double least_energy_J = 0.05;  // what moves with less tips no cup
constexpr unsigned group_bands = 4;      // bands that share a layer: as many as the kernel takes
constexpr double bin_m = 0.05;           // of the offsets around the body
constexpr int half_bins = 24;            // of them to each side
constexpr int bins = 2 * half_bins + 1;
constexpr double fastest_m_s = 15;  // no hand is faster in a room: noise
constexpr double sample_m = 0.025;  // along a segment

struct Segment {
    BodyJoint from, to;
    double mass;  // share of the body's that strikes with it
};
// Winter 2009, Table 4.1: hand .006, forearm .016, upper arm .028, foot .0145, leg .0465, thigh
// .100, head and neck .081; to each limb half of the one that it hangs on.
constexpr std::array<Segment, 13> segments{{
    {neck, head, 0.081},
    {left_shoulder, left_elbow, 0.028},
    {left_elbow, left_wrist, 0.030},
    {left_wrist, left_fingers, 0.014},
    {right_shoulder, right_elbow, 0.028},
    {right_elbow, right_wrist, 0.030},
    {right_wrist, right_fingers, 0.014},
    {left_hip, left_knee, 0.100},
    {left_knee, left_ankle, 0.0965},
    {left_ankle, left_toes, 0.03775},
    {right_hip, right_knee, 0.100},
    {right_knee, right_ankle, 0.0965},
    {right_ankle, right_toes, 0.03775},
}};
constexpr double trunk_mass = 0.142;  // the pelvis, as in body_parts.h

// One place that a segment covers in one frame, with its speed there.
struct Visit {
    int band, ahead, aside;  // bins
    double vx, vy, mass_kg;
};

// Calls visit() for the places that each segment covers in a frame, once for each bin and band.
template <class Visitor>
void visit_frame(const PosedBody& body, std::size_t f, const HumanOptions& options, Visitor visit) {
    const double band_m = options.body_height_m / band_count;
    std::set<std::tuple<int, int, int>> covered;
    const auto mark = [&](const Vec3& p, const Vec3& v, double mass) {
        const int band = static_cast<int>(std::floor(p[2] / band_m));
        const int ahead = static_cast<int>(std::lround(p[0] / bin_m)),
                  aside = static_cast<int>(std::lround(p[1] / bin_m));
        if (band < 0 || band >= static_cast<int>(band_count)) return;
        if (std::abs(ahead) > half_bins || std::abs(aside) > half_bins) return;
        if (!covered.emplace(band, ahead, aside).second) return;
        visit(Visit{band, ahead, aside, v[0], v[1], mass * options.body_mass_kg});
    };
    const auto between = [](const Vec3& a, const Vec3& b, double t) {
        return Vec3{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
    };
    const auto steps = [](const Vec3& a, const Vec3& b) {
        const double length = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
        return std::clamp(static_cast<int>(std::ceil(length / sample_m)), 1, 100);
    };
    for (const Segment& s : segments) {
        if (!body.has(s.from) || !body.has(s.to)) continue;
        covered.clear();
        const Vec3 &a = body.at(s.from, f), &b = body.at(s.to, f);
        const int n = steps(a, b);
        for (int k = 0; k <= n; ++k) {
            const double t = static_cast<double>(k) / n;
            mark(between(a, b, t), between(body.moves(s.from, f), body.moves(s.to, f), t), s.mass);
        }
    }
    // The trunk between hips and shoulders.
    if (!body.has(left_shoulder) || !body.has(right_shoulder)) return;
    covered.clear();
    const bool hips = body.has(left_hip) && body.has(right_hip);
    const auto low = [&](BodyJoint hip, BodyJoint shoulder) { return hips ? hip : shoulder; };
    const BodyJoint ll = low(left_hip, left_shoulder), lr = low(right_hip, right_shoulder);
    const int up = steps(body.at(ll, f), body.at(left_shoulder, f)),
              across = steps(body.at(left_shoulder, f), body.at(right_shoulder, f));
    for (int u = 0; u <= up; ++u) {
        const double t = static_cast<double>(u) / up;
        const Vec3 a = between(body.at(ll, f), body.at(left_shoulder, f), t),
                   b = between(body.at(lr, f), body.at(right_shoulder, f), t),
                   va = between(body.moves(ll, f), body.moves(left_shoulder, f), t),
                   vb = between(body.moves(lr, f), body.moves(right_shoulder, f), t);
        for (int k = 0; k <= across; ++k) {
            const double w = static_cast<double>(k) / across;
            mark(between(a, b, w), between(va, vb, w), trunk_mass);
        }
    }
}

// Passes by offset, of one layer and turn.
struct Histogram {
    std::vector<double> passes = std::vector<double>(static_cast<std::size_t>(bins * bins), 0.0);
    static std::size_t index(int ahead, int aside) {
        return static_cast<std::size_t>((aside + half_bins) * bins + ahead + half_bins);
    }
    // Walkers stray evenly less the further they stray: a triangle, on all bins to either side.
    void stray(double wander_m) {
        const int reach = static_cast<int>(std::ceil(wander_m / bin_m)) - 1;
        if (reach < 1) return;
        std::vector<double> weight;
        double sum = 0;
        for (int k = -reach; k <= reach; ++k)
            sum += weight.emplace_back(1 - std::abs(k) * bin_m / wander_m);
        std::vector<double> out(passes.size(), 0.0);
        for (int aside = -half_bins; aside <= half_bins; ++aside) {
            for (int k = -reach; k <= reach; ++k) {
                const int from = aside + k;
                if (std::abs(from) > half_bins) continue;
                const double share = weight[static_cast<std::size_t>(k + reach)] / sum;
                for (int ahead = -half_bins; ahead <= half_bins; ++ahead)
                    out[index(ahead, aside)] += share * passes[index(ahead, from)];
            }
        }
        passes = std::move(out);
    }
    double reach_m() const {
        double most = 0;
        for (int aside = -half_bins; aside <= half_bins; ++aside) {
            for (int ahead = -half_bins; ahead <= half_bins; ++ahead) {
                if (passes[index(ahead, aside)] > 0)
                    most = std::max(most, std::hypot(ahead, aside));
            }
        }
        return (most + std::numbers::sqrt2) * bin_m;  // to the next bin's middle
    }
    // Between the bins' middles linearly; per bin of the way.
    double at(double ahead_m, double aside_m) const {
        const double a = ahead_m / bin_m, s = aside_m / bin_m;
        const int a0 = static_cast<int>(std::floor(a)), s0 = static_cast<int>(std::floor(s));
        double sum = 0;
        for (const int i : {a0, a0 + 1}) {
            for (const int j : {s0, s0 + 1}) {
                if (std::abs(i) > half_bins || std::abs(j) > half_bins) continue;
                sum += passes[index(i, j)] * (1 - std::abs(a - i)) * (1 - std::abs(s - j));
            }
        }
        return sum;
    }
};

struct LayerSums {
    std::map<unsigned, Histogram> by_turn;
    double passes = 0, speed = 0;
};

}  // namespace

SecondaryMotion recorded_motion(const BodyMotion& motion, const HumanOptions& options) {
    if (!(options.walking_speed_m_s > 0)) {
        throw Error(ErrorKind::usage,
                    "a recorded motion is one of walkers: walking_speed_m_s must be above 0");
    }
    const PosedBody body = posed_body(motion, options);
    const auto energy = [](const Visit& v) {
        return 0.5 * v.mass_kg * (v.vx * v.vx + v.vy * v.vy);
    };
    double most = least_energy_J;
    std::uint64_t visits = 0, noise = 0;
    const auto each = [&](auto use) {
        for (std::size_t f = 0; f < body.frames; ++f) {
            visit_frame(body, f, options, [&](const Visit& v) { use(v, std::hypot(v.vx, v.vy)); });
        }
    };
    each([&](const Visit& v, double speed) {
        ++visits;
        if (speed > fastest_m_s) {
            ++noise;
        } else {
            most = std::max(most, energy(v));
        }
    });
    if (visits == 0) {
        refuse_motion(motion, "no limb was recorded with both of its ends, between the floor and " +
                                  std::to_string(options.body_height_m) + " m above it");
    }

    SecondaryMotion out;
    out.notes = motion.notes;
    if (noise > 0) {
        out.notes.push_back("Of the recorded motion " +
                            std::to_string(std::max<std::uint64_t>(1, 100 * noise / visits)) +
                            " % is faster than 15 m/s and was left out as noise.");
    }
    const double range = std::log(most / least_energy_J);
    std::vector<double> weight(energy_levels, 0.0), energies(energy_levels, 0.0),
        masses(energy_levels, 0.0);
    std::map<std::pair<unsigned, unsigned>, LayerSums> layers;  // by level and group of bands
    each([&](const Visit& v, double speed) {
        const double W = energy(v);
        if (speed > fastest_m_s || W < least_energy_J) return;
        const auto level = static_cast<unsigned>(
            std::min(energy_levels - 1.0,
                     range > 0 ? energy_levels * std::log(W / least_energy_J) / range : 0.0));
        // Half as seen, half in the mirror; alike over the bands of the group.
        const double passes =
            speed / options.walking_speed_m_s / static_cast<double>(body.frames) / group_bands / 2;
        weight[level] += passes;
        energies[level] += passes * W;
        masses[level] += passes * v.mass_kg;
        LayerSums& layer = layers[{level, static_cast<unsigned>(v.band) / group_bands}];
        layer.passes += passes;
        layer.speed += passes * speed;
        const unsigned turn = nearest_direction(v.vx, v.vy);
        layer.by_turn[turn].passes[Histogram::index(v.ahead, v.aside)] += passes;
        layer.by_turn[(direction_count - turn) % direction_count]
            .passes[Histogram::index(v.ahead, -v.aside)] += passes;
    });
    std::vector<std::size_t> kept(energy_levels, 0);
    for (unsigned n = 0; n < energy_levels; ++n) {
        if (weight[n] <= 0) continue;
        kept[n] = out.energy_J.size();
        out.energy_J.push_back(energies[n] / weight[n]);
        out.mass_kg.push_back(masses[n] / weight[n]);
    }
    for (auto& [key, sums] : layers) {
        MotionLayer layer;
        layer.level = kept[key.first];
        layer.bands = {key.second * group_bands, group_bands};
        layer.speed_m_s = sums.speed / sums.passes;
        for (auto& [turn, histogram] : sums.by_turn) {
            histogram.stray(options.wander_m);
            out.reach_m = std::max(out.reach_m, histogram.reach_m());
            const auto shared = std::make_shared<const Histogram>(std::move(histogram));
            layer.ways.push_back({turn, [shared](double ahead, double aside, double spacing) {
                                      return shared->at(ahead, aside) * spacing / bin_m;
                                  }});
        }
        out.layers.push_back(std::move(layer));
    }
    return out;
}

}  // namespace topple::safety

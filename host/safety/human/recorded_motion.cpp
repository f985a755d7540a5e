// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <tuple>

#include "core/short_number.h"
#include "core/vectors.h"
#include "physics/directions.h"
#include "safety/human/body_parts.h"
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
// No hand is faster, but by noise: that of Olympic boxers (Walilko, Viano and Bir 2005,
// Biomechanics of the head for Olympic boxer punches to the face).
constexpr double fastest_m_s = 9.1;
// A recording has hands that reach out where they are beyond the table's other ones for this share
// of the time.
constexpr double reaches_share = 0.01, reaches_m = 0.25;  // of the body's height
constexpr double sample_m = 0.025;                        // along a segment

struct Segment {
    BodyJoint from, to;
    double mass;    // share of the body's that strikes with it
    double radius;  // share of the body's height: it is so wide across its way
};
// Winter 2009, Table 4.1: hand .006, forearm .016, upper arm .028, foot .0145, leg .0465, thigh
// .100, head and neck .081; to each limb half of the one that it hangs on. Radii: girths over 2 pi,
// else half of breadths, over a stature of 1.756 m (Gordon et al., 2012 Anthropometric Survey of
// U.S. Army Personnel, means of men): head .154, biceps .358, forearm .310, hand .088, thigh .625,
// calf .392, foot .102 m.
constexpr std::array<Segment, 13> segments{{
    {neck, head, 0.081, 0.044},
    {left_shoulder, left_elbow, 0.028, 0.032},
    {left_elbow, left_wrist, 0.030, 0.028},
    {left_wrist, left_fingers, 0.014, 0.025},
    {right_shoulder, right_elbow, 0.028, 0.032},
    {right_elbow, right_wrist, 0.030, 0.028},
    {right_wrist, right_fingers, 0.014, 0.025},
    {left_hip, left_knee, 0.100, 0.057},
    {left_knee, left_ankle, 0.0965, 0.036},
    {left_ankle, left_toes, 0.03775, 0.029},
    {right_hip, right_knee, 0.100, 0.057},
    {right_knee, right_ankle, 0.0965, 0.036},
    {right_ankle, right_toes, 0.03775, 0.029},
}};
constexpr double trunk_mass = hip.mass;

// The trunk comes after them.
constexpr std::size_t segment_count = segments.size() + 1;
using Segments = std::array<bool, segment_count>;

Segments recorded(const PosedBody& body) {
    Segments out{};
    for (std::size_t n = 0; n < segments.size(); ++n)
        out[n] = body.has(segments[n].from) && body.has(segments[n].to);
    out.back() = body.has(left_shoulder) && body.has(right_shoulder);
    return out;
}

// One place that a segment covers in one frame, with its speed there.
struct Visit {
    std::size_t segment;
    int band, ahead, aside;  // bins
    double vx, vy, mass_kg;
    double speed() const { return std::hypot(vx, vy); }
    double energy_J() const { return 0.5 * mass_kg * (vx * vx + vy * vy); }
};

// Calls visit() for the places that each segment covers in a frame, once for each bin and band:
// what it passes is as wide as it is across its way, and passes once, however long it is along it.
template <class Visitor>
void visit_frame(const PosedBody& body, std::size_t f, const HumanOptions& options, Visitor visit) {
    const double band_m = options.body_height_m / band_count;
    std::set<std::tuple<int, int, int>> covered;
    const auto mark_at = [&](std::size_t segment, double x, double y, double z, const Vec3& v) {
        const int band = static_cast<int>(std::floor(z / band_m));
        const int ahead = static_cast<int>(std::lround(x / bin_m)),
                  aside = static_cast<int>(std::lround(y / bin_m));
        if (band < 0 || band >= static_cast<int>(band_count)) return;
        if (std::abs(ahead) > half_bins || std::abs(aside) > half_bins) return;
        if (!covered.emplace(band, ahead, aside).second) return;
        const double mass = segment < segments.size() ? segments[segment].mass : trunk_mass;
        visit(Visit{segment, band, ahead, aside, v[0], v[1], mass * options.body_mass_kg});
    };
    // All across its way, to its radius on both sides.
    const auto mark = [&](std::size_t segment, const Vec3& p, const Vec3& v, double radius_m) {
        const double speed = std::hypot(v[0], v[1]);
        const int n = speed > 0 ? static_cast<int>(std::ceil(radius_m / sample_m)) : 0;
        for (int k = -n; k <= n; ++k) {
            const double off = n > 0 ? k * radius_m / n / speed : 0;
            mark_at(segment, p[0] - off * v[1], p[1] + off * v[0], p[2], v);
        }
    };
    const auto between = [](const Vec3& a, const Vec3& b, double t) {
        return along(a, t, minus(b, a));
    };
    const auto steps = [](const Vec3& a, const Vec3& b) {
        const double length = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
        return std::clamp(static_cast<int>(std::ceil(length / sample_m)), 1, 100);
    };
    const Segments has = recorded(body);
    for (std::size_t n = 0; n < segments.size(); ++n) {
        if (!has[n]) continue;
        const Segment& s = segments[n];
        covered.clear();
        const Vec3 &a = body.at(s.from, f), &b = body.at(s.to, f);
        const int count = steps(a, b);
        for (int k = 0; k <= count; ++k) {
            const double t = static_cast<double>(k) / count;
            mark(n, between(a, b, t), between(body.moves(s.from, f), body.moves(s.to, f), t),
                 s.radius * options.body_height_m);
        }
    }
    // The trunk between hips and shoulders.
    if (!has.back()) return;
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
            mark(segments.size(), between(a, b, w), between(va, vb, w), 0);
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

// Whether a hand is out of the way of the body for some of the time, as that of someone who takes
// or puts something.
bool reaches_out(const PosedBody& body, const HumanOptions& options) {
    std::size_t out = 0;
    for (std::size_t f = 0; f < body.frames; ++f) {
        bool far = false;
        for (const BodyJoint hand : {left_wrist, left_fingers, right_wrist, right_fingers}) {
            if (!body.has(hand)) continue;
            const Vec3& p = body.at(hand, f);
            far = far || std::hypot(p[0], p[1]) > reaches_m * options.body_height_m;
        }
        out += far;
    }
    return static_cast<double>(out) >= reaches_share * static_cast<double>(body.frames);
}

// The bodies, and what they have been recorded of together.
struct Recordings {
    double most_J = least_energy_J;  // of all that is no noise
    std::vector<PosedBody> bodies;
    std::array<unsigned, segment_count> with{};  // recordings that have a segment
    // A visit's share of the time.
    double weight(const Visit& v, const PosedBody& body) const {
        return 1.0 / static_cast<double>(body.frames) / with[v.segment];
    }
    template <class Use>
    void each(const HumanOptions& options, const Use& use) const {
        for (const PosedBody& body : bodies)
            for (std::size_t f = 0; f < body.frames; ++f)
                visit_frame(body, f, options, [&](const Visit& v) { use(v, weight(v, body)); });
    }
};

Recordings recordings_of(const HumanOptions& options, std::vector<std::string>& notes) {
    Recordings out;
    for (const auto& motion : options.motions) {
        out.bodies.push_back(posed_body(*motion, options));
        const PosedBody& body = out.bodies.back();
        const Segments has = recorded(body);
        for (std::size_t n = 0; n < segment_count; ++n) out.with[n] += has[n];
        std::uint64_t visits = 0, noise = 0;
        for (std::size_t f = 0; f < body.frames; ++f) {
            visit_frame(body, f, options, [&](const Visit& v) {
                ++visits;
                if (v.speed() > fastest_m_s)
                    ++noise;
                else
                    out.most_J = std::max(out.most_J, v.energy_J());
            });
        }
        if (visits == 0) {
            refuse_motion(*motion,
                          "no limb was recorded with both of its ends, between the floor and " +
                              short_number(options.body_height_m) + " m above it");
        }
        notes.insert(notes.end(), motion->notes.begin(), motion->notes.end());
        if (noise > 0) {
            notes.push_back("Of the recorded motion " +
                            std::to_string(std::max<std::uint64_t>(1, 100 * noise / visits)) +
                            " % is faster than 9.1 m/s, as fast as boxers strike, and was left "
                            "out as noise.");
        }
    }
    return out;
}

}  // namespace

SecondaryMotion recorded_motion(const HumanOptions& options) {
    if (!(options.walking_speed_m_s > 0)) {
        throw Error(ErrorKind::usage,
                    "a recorded motion is one of walkers: walking_speed_m_s must be above 0");
    }
    SecondaryMotion out;
    const Recordings recordings = recordings_of(options, out.notes);
    const double range = std::log(recordings.most_J / least_energy_J);
    std::vector<double> weight(energy_levels, 0.0), energies(energy_levels, 0.0),
        masses(energy_levels, 0.0);
    std::map<std::pair<unsigned, unsigned>, LayerSums> layers;  // by level and group of bands
    recordings.each(options, [&](const Visit& v, double share) {
        const double W = v.energy_J(), speed = v.speed();
        if (speed > fastest_m_s || W < least_energy_J) return;
        const auto level = static_cast<unsigned>(
            std::min(energy_levels - 1.0,
                     range > 0 ? energy_levels * std::log(W / least_energy_J) / range : 0.0));
        // Half as seen, half in the mirror; alike over the bands of the group.
        const double passes = speed / options.walking_speed_m_s * share / group_bands / 2;
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
    if (std::ranges::none_of(recordings.bodies,
                             [&](const PosedBody& body) { return reaches_out(body, options); })) {
        add_part(out, reaching_hand, options);
        out.notes.push_back(
            "Nobody reaches out in the recorded motion: hands that do, in one of 20 walks, are "
            "taken from the table of gait.");
    }
    return out;
}

}  // namespace topple::safety

// SPDX-License-Identifier: MIT
#include "safety/earthquake/ground_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/vectors.h"
#include "physics/directions.h"
#include "physics/landscape.h"
#include "safety/columns.h"
#include "safety/earthquake/fragility.h"
#include "safety/earthquake/made_up_records.h"

namespace topple::safety {
namespace {

constexpr double weakest_g = 0.05, next_g = 1.4, strongest_g = 4;
constexpr double firm_friction = 2;

// Outward normal of the edge of the support nearest to below the centre.
std::array<double, 2> weakest_way(const RiskObject& object, const MassSpread& stance) {
    std::array<double, 2> way{1, 0};
    double least = std::numeric_limits<double>::infinity();
    const auto& polygon = object.support_polygon;
    for (std::size_t e = 0; polygon.size() >= 3 && e < polygon.size(); ++e) {
        const auto& a = polygon[e];
        const auto& b = polygon[(e + 1) % polygon.size()];
        const double nx = b[1] - a[1], ny = a[0] - b[0], length = std::hypot(nx, ny);
        if (length <= 0) continue;
        const double inside =
            ((a[0] - stance.center[0]) * nx + (a[1] - stance.center[1]) * ny) / length;
        if (inside >= least) continue;
        least = inside;
        way = {nx / length, ny / length};
    }
    return way;
}

// Second moments of a record's level components.
class LevelMoments {
  public:
    explicit LevelMoments(const Accelerogram& record) {
        for (std::size_t n = 0; n < record.m_s2.size(); ++n) {
            const double a = record.m_s2[n];
            const double b = n < record.across_m_s2.size() ? record.across_m_s2[n] : 0;
            aa_ += a * a;
            ab_ += a * b;
            bb_ += b * b;
        }
    }
    // Root mean square of the shaking along a unit way, over that of both components together.
    double share(const std::array<double, 2>& way) const {
        return aa_ + bb_ > 0 ? std::sqrt(variance(way) / (aa_ + bb_)) : 1;
    }
    double correlation(const std::array<double, 2>& one, const std::array<double, 2>& other) const {
        const double both = std::sqrt(variance(one) * variance(other));
        return both > 1e-12 * (aa_ + bb_) ? covariance(one, other) / both : 0;
    }

  private:
    double covariance(const std::array<double, 2>& p, const std::array<double, 2>& q) const {
        return p[0] * q[0] * aa_ + (p[0] * q[1] + p[1] * q[0]) * ab_ + p[1] * q[1] * bb_;
    }
    double variance(const std::array<double, 2>& way) const {
        return std::max(0.0, covariance(way, way));
    }
    double aa_ = 0, ab_ = 0, bb_ = 0;
};

// b / h, where it is least.
double slenderness(const ShakenObject& object) {
    double least = std::numeric_limits<double>::infinity();
    for (const Profile& body : object.body)
        if (body.height_m > 0) least = std::min(least, body.slenderness());
    return least;
}

// Whether it releases anything once it is over the edge that lies that way.
bool rests_lower(const RiskObject& object, const Vec3& way) {
    return !object.toppling || instability(object, {over_edge_J(object, way), 1, way}) > 0;
}

// A level way by the record's components.
std::array<double, 2> in_record(const GroundEvent& event, const std::array<double, 2>& way) {
    return {way[0] * event.dx + way[1] * event.dy, way[1] * event.dx - way[0] * event.dy};
}

// An event in one plane of a body.
Shaking shaking_in(const ShakenObject& object, std::size_t plane, std::uint32_t body,
                   const GroundEvent& event, const LevelMoments& moments) {
    const auto in = in_record(event, object.way[plane]);
    const double share = moments.share(in), scale = object.floor_shakes * event.scale;
    // Rounding alone shakes it across the only way that it is shaken.
    const double level = share > 1e-6 ? scale : 0;
    return {body, event.record, level * in[0], level * in[1], scale, share};
}

// Friction is too little to lift its edges, by far more than rounding, and its support ends
// nowhere: it only slides.
bool can_fall(const Profile& body, const Shaking& shaking) {
    const bool endless = std::isinf(body.support_ahead_m) && std::isinf(body.support_behind_m);
    return !endless || 1.001 * body.friction * shaking.grip > body.slenderness();
}

// By object, then event: whether it falls. Of those not in `which` none. Either plane is enough, so
// that the second is shaken only in events that it stands in the first. They rub by
// `least_friction` at least.
std::vector<std::vector<std::uint8_t>> falls_in(device::Device& device,
                                                std::span<const ShakenObject> objects,
                                                std::span<const std::size_t> which,
                                                std::span<const Accelerogram> records,
                                                std::span<const GroundEvent> events,
                                                double least_friction = 0) {
    std::vector<std::vector<std::uint8_t>> out(objects.size());
    for (const std::size_t o : which) out[o].assign(events.size(), objects[o].held ? 0 : 1);
    const std::vector<LevelMoments> moments(records.begin(), records.end());
    for (std::size_t p = 0; p < 2; ++p) {
        std::vector<Profile> bodies;
        std::vector<Shaking> shakings;
        std::vector<std::uint8_t*> fell;  // of each shaking
        for (const std::size_t o : which) {
            Profile body = objects[o].body[p];
            body.friction = std::max(body.friction, least_friction);
            for (std::size_t e = 0; e < events.size(); ++e) {
                if (out[o][e] != 0) continue;
                const Shaking shaking =
                    shaking_in(objects[o], p, static_cast<std::uint32_t>(bodies.size()), events[e],
                               moments[events[e].record]);
                if (!can_fall(body, shaking)) continue;
                shakings.push_back(shaking);
                fell.push_back(&out[o][e]);
            }
            bodies.push_back(body);
        }
        const std::vector<Motion> found = shake(device, bodies, records, shakings);
        for (std::size_t n = 0; n < found.size(); ++n)
            if (falls(objects[which[shakings[n].body]], p, found[n])) *fell[n] = 1;
    }
    return out;
}

}  // namespace

std::vector<GroundEvent> from_all_ways(std::uint32_t record, double scale) {
    std::vector<GroundEvent> out;
    for (unsigned d = 0; d < direction_count; ++d) {
        const auto [dx, dy] = direction(d);
        out.push_back({record, dx, dy, scale});
    }
    return out;
}

ShakenObject shaken_object(const RiskObject& object, const MassSpread& stance,
                           const Columns& columns) {
    ShakenObject out;
    const auto [x, y] = weakest_way(object, stance);
    out.way = {{{x, y}, {-y, x}}};
    out.floor_shakes = object.floor_shakes;
    out.held = object.mass_kg > 0;
    out.base_error_share = object.base_error_share;
    out.friction_error_share = object.friction_error_share;
    for (std::size_t p = 0; p < 2; ++p) {
        out.body[p] = profile(object, stance, columns, out.way[p][0], out.way[p][1]);
        out.body[p].friction = object.friction;
        out.held = out.held && out.body[p].least_base_m() > 0;
        const Vec3 ahead{out.way[p][0], out.way[p][1], 0};
        out.lower[p] = {rests_lower(object, ahead), rests_lower(object, opposite(ahead))};
    }
    return out;
}

bool falls(const ShakenObject& object, std::size_t plane, const Motion& motion) {
    const auto [ahead, behind] = object.lower[plane];
    return (ahead && motion.overturned_ahead()) || (behind && motion.overturned_behind()) ||
           motion.slid_off(object.body[plane]);
}

Motions shake_objects(device::Device& device, std::span<const ShakenObject> objects,
                      std::span<const std::size_t> which, std::span<const Accelerogram> records,
                      std::span<const GroundEvent> events, bool endless) {
    std::vector<Profile> bodies;
    std::vector<Shaking> shakings;
    const std::vector<LevelMoments> moments(records.begin(), records.end());
    for (const std::size_t o : which) {
        for (std::size_t p = 0; p < 2; ++p) {
            Profile body = objects[o].body[p];
            if (endless) body.support_ahead_m = body.support_behind_m = INFINITY;
            bodies.push_back(body);
            const auto last = static_cast<std::uint32_t>(bodies.size() - 1);
            for (const GroundEvent& e : events)
                shakings.push_back(shaking_in(objects[o], p, last, e, moments[e.record]));
        }
    }
    const std::vector<Motion> found = shake(device, bodies, records, shakings);
    Motions out(objects.size());
    for (std::size_t w = 0; w < which.size(); ++w) {
        for (std::size_t e = 0; e < events.size(); ++e) {
            const std::size_t at = 2 * w * events.size() + e;
            const auto& way = objects[which[w]].way;
            const double together = moments[events[e].record].correlation(
                in_record(events[e], way[0]), in_record(events[e], way[1]));
            out[which[w]].push_back({{found[at], found[at + events.size()]}, together});
        }
    }
    return out;
}

std::vector<Fragility> fragilities(device::Device& device, std::span<const ShakenObject> objects,
                                   std::span<const std::size_t> which,
                                   std::span<const Accelerogram> records,
                                   double floor_amplification, const HazardCurve* hazard) {
    std::vector<Fragility> out(objects.size());
    std::vector<GroundEvent> events;
    std::vector<double> levels_g, velocity;
    for (double g = weakest_g; g < strongest_g; g *= next_g) levels_g.push_back(g);
    for (std::size_t r = 0; r < records.size(); ++r) {
        const double peak = records[r].peak_m_s2();
        if (!(peak > 0)) return out;
        velocity.push_back(peak_velocity_m_s(records[r]) / peak * physics::gravity);
        for (const double g : levels_g) {
            const auto ways = from_all_ways(static_cast<std::uint32_t>(r),
                                            floor_amplification * g * physics::gravity / peak);
            events.insert(events.end(), ways.begin(), ways.end());
        }
    }
    struct Counts {
        std::vector<Trials> peaks, speeds;  // over peak acceleration, g, and velocity, m/s
    };
    const auto counts = [&](const std::vector<std::uint8_t>& fell) {
        Counts found;
        for (const double g : levels_g) found.peaks.push_back({g, 0, 0});
        for (std::size_t e = 0; e < events.size(); e += direction_count) {
            const std::size_t level = e / direction_count % levels_g.size();
            unsigned falls = 0;
            for (unsigned d = 0; d < direction_count; ++d) falls += fell[e + d];
            found.peaks[level].falls += falls;
            found.peaks[level].of += direction_count;
            found.speeds.push_back(
                {levels_g[level] * velocity[events[e].record], falls, direction_count});
        }
        return found;
    };
    const auto fell = falls_in(device, objects, which, records, events);
    for (const std::size_t o : which) {
        const Counts counted = counts(fell[o]);
        Fragility& f = out[o];
        f = fragility_of(counted.peaks);
        f.firm_pga_g = f.pga_g;
        if (std::isfinite(f.pga_dispersion)) {
            // What slides goes with its friction, not with b / h.
            const double error = slenderness(objects[o]) < objects[o].body[0].friction
                                     ? objects[o].base_error_share
                                     : objects[o].friction_error_share;
            const auto with_error = [&](double dispersion) {
                return std::min(most_dispersion, std::hypot(dispersion, error));
            };
            f.pga_dispersion = with_error(f.pga_dispersion);
            if (const auto by_speed = fit_lognormal(counted.speeds)) {
                f.pgv_m_s = by_speed->median;
                f.pgv_dispersion = with_error(by_speed->dispersion);
            }
        }
        if (hazard) {
            f.falls_per_year = falls_per_year(*hazard, f);
            f.return_years = f.falls_per_year > 0 ? 1 / f.falls_per_year : Fragility::none;
        }
    }
    // Of what may slide before it rocks, shaken askew.
    std::vector<std::size_t> sliding;
    for (const std::size_t o : which)
        if (objects[o].held && slenderness(objects[o]) > 0.6 * objects[o].body[0].friction)
            sliding.push_back(o);
    const auto fell_firm = falls_in(device, objects, sliding, records, events, firm_friction);
    for (const std::size_t o : sliding)
        out[o].firm_pga_g = fragility_of(counts(fell_firm[o]).peaks).pga_g;
    return out;
}

}  // namespace topple::safety

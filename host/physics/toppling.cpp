// SPDX-License-Identifier: MIT
#include "physics/toppling.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/vectors.h"
#include "physics/blow.h"
#include "physics/infinity.h"
#include "physics/leaning.h"
#include "physics/tipping.h"

namespace topple::physics {
namespace {

constexpr double least_gyration_m = 1e-3;

Eigen::Matrix3d full_matrix(const Symmetric& m) {
    Eigen::Matrix3d out;
    out << m[0], m[3], m[4], m[3], m[1], m[5], m[4], m[5], m[2];
    return out;
}

// Of the angle between a blow and the way square across an edge.
double cosine_of_slant(std::size_t slant) {
    constexpr std::array cosines{1.0, 0.9, 0.7, 0.4};
    return cosines[slant];
}

}  // namespace

// Between the slants by the inverse of the energy, which is 0 where no blow suffices.
double Toppling::Tip::across_m_s(std::size_t part, double cosine) const {
    const auto& row = ahead_m_s[part];
    const auto energy = [](double speed) { return 1 / (speed * speed); };
    std::size_t a = 1;
    while (a + 1 < slants && cosine < cosine_of_slant(a)) ++a;
    const double low = cosine_of_slant(a), high = cosine_of_slant(a - 1);
    const double share = std::clamp((cosine - low) / (high - low), 0.0, 1.0);
    return 1 / std::sqrt(share * energy(row[a - 1]) + (1 - share) * energy(row[a]));
}

Toppling::Toppling(const Candidate& candidate, const Extent& body, const Stability& tipping,
                   std::span<const std::array<double, 2>> ways, const SlideResult& sliding,
                   double friction)
    : mass_kg_(candidate.body.mass_kg),
      center_m_(candidate.body.center[2] - candidate.support_height_m),
      top_m_(std::max(body.top_m - candidate.support_height_m, 1e-3)),
      friction_(friction),
      ways_(ways.begin(), ways.end()) {
    const Eigen::Matrix3d inertia =
        full_matrix(body.inertia_kg_m2) / mass_kg_ +
        least_gyration_m * least_gyration_m * Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d inverse = inertia.inverse();
    turns_m2_ = {inverse(0, 0), inverse(0, 1), inverse(1, 1)};
    const auto upright = [&](const Vec3& way, double ahead) {
        const Eigen::Vector3d across(-way[1], way[0], 0);
        return Upright{ahead, footing_reach(candidate, opposite(way)), center_m_,
                       std::sqrt(across.dot(inertia * across))};
    };
    const double weight = mass_kg_ * gravity;
    for (const TippingWay& way : tipping.ways) {
        // The edge at which it would climb so high.
        Tip tip{way.direction,
                edge_distance_m(way.climb_m, center_m_),
                weight * way.climb_m,
                weight * way.release_m,
                {},
                {}};
        const bool turns = way.direction != Vec3{} && way.climb_m > 0;
        // What hangs below its support swings: nothing but its energy tells.
        for (std::size_t n = 0; turns && center_m_ > 0 && n < heights; ++n) {
            const Upright side = upright(tip.way, tip.beside_m);
            for (std::size_t a = 0; a < slants; ++a) {
                const double c = cosine_of_slant(a), aside = std::sqrt(1 - c * c) / c;
                tip.ahead_m_s[n][a] = tips_ahead_m_s(side, height_m(n), friction, aside);
            }
            const Upright other{side.behind_m, side.ahead_m, side.height_m, side.gyration_m};
            tip.behind_m_s[n] = tips_behind_m_s(other, height_m(n), friction);
        }
        tips_.push_back(tip);
    }
    for (const auto& [x, y] : ways_) {
        const Vec3 way{x, y, 0};
        Slide slide;
        for (std::size_t n = 0; n < heights; ++n) {
            slide.share[n] = center_m_ > 0
                                 ? sliding_share(upright(way, footing_reach(candidate, way)),
                                                 height_m(n), friction)
                                 : 1;
        }
        slides_.push_back(slide);
    }
    lay_out(sliding);
}

Toppling Toppling::elsewhere(const SlideResult& sliding) const {
    Toppling out = *this;
    out.lay_out(sliding);
    return out;
}

void Toppling::lay_out(const SlideResult& sliding) {
    for (std::size_t w = 0; w < slides_.size(); ++w)
        slides_[w].to = w < sliding.straight.size() ? sliding.straight[w] : StraightSlide{};
    shortest_m_ = sliding.found ? sliding.distance_m : infinity;
}

double Toppling::height_m(std::size_t n) const {
    return (static_cast<double>(n) + 0.5) / heights * top_m_;
}

std::size_t Toppling::part(double height) const {
    const double n = std::floor(height / top_m_ * heights);
    return static_cast<std::size_t>(std::clamp(n, 0.0, heights - 1.0));
}

double Toppling::free_share(const Vec3& way, double height) const {
    const double x = -way[1], y = way[0], arm = height - center_m_;
    const auto& [xx, xy, yy] = turns_m2_;
    return 1 + arm * arm * (x * x * xx + 2 * x * y * xy + y * y * yy);
}

double Toppling::met_mass_kg(const Vec3& way, double height) const {
    return mass_kg_ / free_share(way, height_m(part(height)));
}

const Toppling::Slide& Toppling::slide(const Vec3& way) const {
    std::size_t best = 0;
    double most = -infinity;
    for (std::size_t w = 0; w < ways_.size(); ++w) {
        const double aligned = way[0] * ways_[w][0] + way[1] * ways_[w][1];
        if (aligned > most + 1e-9) {
            most = aligned;
            best = w;
        }
    }
    return slides_[best];
}

double Toppling::slide_distance_m(const Vec3& way) const {
    return std::max(slide(way).to.distance_m, shortest_m_);
}

template <class Visit>
void Toppling::of_blow(const Vec3& way, double height, const Visit& visit) const {
    const std::size_t n = part(height);
    const double energy = mass_kg_ * free_share(way, height_m(n)) / 2;  // of the square of P / M
    const Slide& off = slide(way);
    const double distance = slide_distance_m(way), rubs = friction_ * mass_kg_ * gravity;
    const double falls = mass_kg_ * gravity * off.to.drop_m;
    for (const Tip& tip : tips_) {
        const double cosine = dot(way, tip.way);
        // Any push, any way.
        if (tip.way == Vec3{} || !(tip.climb_J > 0)) {
            visit(tip.climb_J, tip.release_J);
            continue;
        }
        if (std::abs(cosine) < 1e-6) continue;
        const double speed = (cosine > 0 ? tip.across_m_s(n, cosine) : tip.behind_m_s[n]) / cosine;
        const double W = std::max(tip.climb_J, energy * speed * speed);
        if (tip.release_J > 0) visit(W, tip.release_J);
        // It lies down as far ahead as it was high, and slides on with what it has left, of the
        // share of the blow that turns it.
        if (cosine <= 0 || !std::isfinite(distance)) continue;
        const double on = rubs * std::max(0.0, distance - tip.beside_m - center_m_);
        visit(std::max(rubs * distance, W * (1 + on / tip.climb_J)), falls);
    }
    if (std::isfinite(distance) && off.share[n] > 0) {
        const double squared = 2 * friction_ * gravity * distance / (off.share[n] * off.share[n]);
        visit(std::max(rubs * distance, energy * squared), falls);
    }
}

const Toppling::Tip* Toppling::met_first(const Vec3& way) const {
    const Tip* first = nullptr;
    double nearest = infinity;
    for (const Tip& tip : tips_) {
        const double cosine = dot(way, tip.way);
        if (cosine < 1e-6 || tip.beside_m / cosine >= nearest) continue;
        nearest = tip.beside_m / cosine;
        first = &tip;
    }
    return first;
}

Toppling::EdgeAhead Toppling::edge_ahead(const Vec3& way) const {
    EdgeAhead out{infinity, 1};
    if (const Tip* const first = met_first(way)) {
        out.cosine = dot(way, first->way);
        out.distance_m = first->beside_m / out.cosine;
    }
    // Any push, any way.
    for (const Tip& tip : tips_) {
        const bool any = tip.way == Vec3{} || !(tip.climb_J > 0);
        if (any && tip.beside_m < out.distance_m) out = {tip.beside_m, 1};
    }
    return out;
}

template <class Visit>
void Toppling::of_push(const Vec3& way, const Visit& visit) const {
    const Tip* const first = met_first(way);
    const double aligned = first ? dot(way, first->way) : 0;
    for (const Tip& tip : tips_) {
        if (!(tip.release_J > 0)) continue;
        const bool any = tip.way == Vec3{} || !(tip.climb_J > 0);
        if (any || dot(way, tip.way) >= std::max(aligned - 1e-6, 1e-6))
            visit(tip.climb_J, tip.release_J);
    }
    const double distance = slide_distance_m(way);
    if (std::isfinite(distance))
        visit(friction_ * mass_kg_ * gravity * distance, mass_kg_ * gravity * slide(way).to.drop_m);
}

double Toppling::struck_J(double W_J, const Vec3& way, double height) const {
    double most = 0;
    of_blow(way, height, [&](double W, double S) { most = W <= W_J ? std::max(most, S) : most; });
    return most;
}

double Toppling::pushed_J(double W_J, const Vec3& way) const {
    double most = 0;
    of_push(way, [&](double W, double S) { most = W <= W_J ? std::max(most, S) : most; });
    return most;
}

double Toppling::blow_barrier_J(const Vec3& way, double height) const {
    double least = infinity;
    of_blow(way, height, [&](double W, double S) { least = S > 0 ? std::min(least, W) : least; });
    return least;
}

double Toppling::impulse_Ns(double W_J, const Vec3& way, double height) const {
    return std::sqrt(2 * met_mass_kg(way, height) * W_J);
}

double Toppling::over_edge_J(const Vec3& way) const {
    const Tip* const first = met_first(way);
    const double barrier = push_barrier_J(way);
    return first ? std::min(first->climb_J, barrier) : barrier;
}

double Toppling::push_barrier_J(const Vec3& way) const {
    double least = infinity;
    of_push(way, [&](double W, double S) { least = S > 0 ? std::min(least, W) : least; });
    return least;
}

}  // namespace topple::physics

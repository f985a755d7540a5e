// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "physics/inertia.h"
#include "physics/landscape.h"
#include "physics/sliding.h"

namespace topple::physics {

// S(W, way, height): what a body releases that is pushed or struck that way. W is, of a push, the
// work that is done slowly, and of a blow the energy that its impulse gives to the body where
// nothing touches it, motion and turning together. A blow is level and meets the line above the
// centre of mass; a way in which the body can leave its pose is an edge to tip over (blow.h), or
// the end of the support to slide off. No blow and no push that way takes less than S(W) says of
// all ways: S(W) is the upper envelope. Grid frame.
class Toppling {
  public:
    static constexpr std::size_t heights = 8;  // blows: equal parts of the body's height

    struct Extent {
        Symmetric inertia_kg_m2{};  // about the centre of mass
        double top_m = 0;           // of its highest point, grid frame
    };
    // tipping: of exact passes. ways: those that `straight` is along.
    Toppling(const Candidate& candidate, const Extent& body, const Stability& tipping,
             std::span<const std::array<double, 2>> ways, const SlideResult& sliding,
             double friction);
    // The same on another place of its support.
    Toppling elsewhere(const SlideResult& sliding) const;

    // Ways are unit and horizontal; heights are above what it stands on.
    double struck_J(double W_J, const Vec3& way, double height_m) const;
    double pushed_J(double W_J, const Vec3& way) const;
    // Least W for which these are above 0; infinite where there is none.
    double blow_barrier_J(const Vec3& way, double height_m) const;
    // The impulse, in newton seconds, of a blow that gives W so.
    double impulse_Ns(double W_J, const Vec3& way, double height_m) const;
    double push_barrier_J(const Vec3& way) const;
    // No more than it takes to turn it over the edge that the line ahead meets first, whatever that
    // releases.
    double over_edge_J(const Vec3& way) const;
    // The edge that the line ahead meets first: how far before the centre of mass it lies along
    // that line, and the cosine of the angle between that and the way square across the edge.
    // Infinity and 1: there is none.
    struct EdgeAhead {
        double distance_m = 0, cosine = 1;
    };
    EdgeAhead edge_ahead(const Vec3& way) const;
    // Straight on to where its support ends.
    double slide_distance_m(const Vec3& way) const;
    // The mass that such a blow meets: less than the body's, where it also turns it.
    double met_mass_kg(const Vec3& way, double height_m) const;
    double height_m(std::size_t n) const;  // the middle of the n-th part of its height

  private:
    static constexpr std::size_t slants = 4;
    struct Tip {
        Vec3 way{};
        double beside_m = 0, climb_J = 0, release_J = 0;
        // Least P / M across its edge of a blow ahead, by height and for `slants` of it, and of one
        // against it.
        std::array<std::array<double, slants>, heights> ahead_m_s{};
        std::array<double, heights> behind_m_s{};
        double across_m_s(std::size_t part, double cosine) const;
    };
    struct Slide {
        StraightSlide to;
        std::array<double, heights> share{};  // of P / M that is left to slide
    };
    std::size_t part(double height_m) const;
    // The edge that a steady push turns it over is the one that the line ahead meets first; null:
    // none.
    const Tip* met_first(const Vec3& way) const;
    double free_share(const Vec3& way, double height_m) const;
    const Slide& slide(const Vec3& way) const;
    void lay_out(const SlideResult& sliding);
    // Calls visit(W, release) for each of its ways to fall.
    template <class Visit>
    void of_blow(const Vec3& way, double height_m, const Visit& visit) const;
    template <class Visit>
    void of_push(const Vec3& way, const Visit& visit) const;

    double mass_kg_ = 0, center_m_ = 0, top_m_ = 0, friction_ = 0;  // heights above its support
    std::array<double, 3> turns_m2_{};  // xx, xy, yy of M times the inverse of its inertia, 1 / m^2
    std::vector<Tip> tips_;
    std::vector<std::array<double, 2>> ways_;
    std::vector<Slide> slides_;  // by way
    double shortest_m_ = 0;      // slide of all
};

}  // namespace topple::physics

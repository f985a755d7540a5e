// SPDX-License-Identifier: MIT
#include "topple/stays.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/vectors.h"
#include "io/length_text.h"
#include "io/text.h"
#include "physics/infinity.h"
#include "physics/landscape.h"
#include "safety/fields.h"
#include "topple/error.h"

namespace topple {
namespace {

[[noreturn]] void refuse(const std::string& what) {
    throw Error(ErrorKind::usage, "stays: " + what);
}

void check_figure(const char* name, double value, const char* unit) {
    if (value >= 0 && std::isfinite(value)) return;  // false for NaN
    refuse(std::string(name) + " " + io::short_number(value) + ": expected " + unit +
           ", a finite number from 0 on");
}

void check(const Scene& scene, const Object& object, const Touch& touch) {
    const auto id = static_cast<std::size_t>(object.id);  // of -1 it is beyond all
    if (id >= scene.objects.size() || scene.objects[id].primitives != object.primitives)
        refuse("object " + std::to_string(object.id) + ": it is none of the scene's " +
               std::to_string(scene.objects.size()) + "; give one of scene.objects");
    const auto finite = [](double x) { return std::isfinite(x); };
    if (!std::ranges::all_of(touch.place_m, finite))
        refuse("place_m " + io::vector_text(touch.place_m) +
               ": expected metres in the frame of the result's points, all finite");
    if (touch.way != Vec3{}) {
        constexpr double unit_within = 1e-3, most_slope = 0.0872;  // sine of 5 degrees
        const double long_as = std::sqrt(dot(touch.way, touch.way)), up = dot(scene.up, touch.way);
        if (!(std::abs(long_as - 1) <= unit_within))  // NaN, too
            refuse("way " + io::vector_text(touch.way) + " is " + io::short_number(long_as) +
                   " long: expected a unit vector, or zeros for any way; divide it by its length");
        if (!(std::abs(up) <= most_slope))
            refuse("way " + io::vector_text(touch.way) + " leads up or down by " +
                   io::short_number(up) +
                   ": expected a level way, to 5 degrees; take its part along scene.up off, and "
                   "divide what is left by its length");
    }
    check_figure("force_N", touch.force_N, "newtons");
    check_figure("impulse_Ns", touch.impulse_Ns, "newton seconds");
    check_figure("slack_m", touch.slack_m, "metres");
}

// aT I^-1 a of a symmetric matrix: what a unit of angular momentum about `a` gives it of turning.
double turning_of(const Mat3& inertia, const Vec3& a) {
    const Vec3 x{inertia[0], inertia[1], inertia[2]}, y{inertia[3], inertia[4], inertia[5]},
        z{inertia[6], inertia[7], inertia[8]};
    const Vec3 yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);
    return (a[0] * dot(yz, a) + a[1] * dot(zx, a) + a[2] * dot(xy, a)) / dot(x, yz);
}

// The lesser of both; NaN where one of them is.
double least_of(double a, double b) {
    return std::isnan(a) || a <= b ? a : b;
}

// A thing that stands free, as its figures tell. Comparisons are such that NaN says no.
class Standing {
  public:
    Standing(const Scene& scene, const Object& object)
        : scene_(scene), o_(object), known_(object.barrier_by_direction) {}

    // What keeps its figures from being those of a thing that rests as scanned, by itself; "":
    // nothing.
    std::string doubt() const {
        if (!o_.seen_enough) return "the scan does not show what holds it";
        if (!(o_.rest_probability >= 0.5))
            return "what holds it is likelier than not something else than was found";
        if (o_.piece_of >= 0)
            return "it is likelier than not a piece of object " + std::to_string(o_.piece_of) +
                   ": ask about that one";
        if (!(o_.joint_probability >= 0.5)) return "it is likelier than not two things";
        if (!(o_.barrier_J > 0))
            return "what was seen to carry it does not hold it: its barrier is 0";
        const std::size_t heights = known_.height_m.size();
        if (heights == 0 || known_.push_N.size() != DirectedBarrier::directions ||
            known_.direction.size() != DirectedBarrier::directions ||
            known_.blow_Ns.size() != DirectedBarrier::directions * heights || !(sure() > 0) ||
            !(least_mass_kg() > 0))
            return "its mass and its foot are not known well enough";
        return {};
    }
    // Above what it stands on.
    double height_m(const Vec3& place) const { return dot(scene_.up, place) - o_.support_height_m; }
    double top_m() const { return height_m(o_.box_middle_m) + o_.size_m[2] / 2; }

    // The least push that sets it sliding.
    double slides_N() const { return o_.overturning.slide_N * least_mass_kg() / o_.mass_kg; }
    // The least one at that height that tips it towards direction n.
    double tips_N(std::size_t n, double height_m) const {
        // Infinite where it has no edge that way: then as over the nearest one.
        const double least_N =
            std::isinf(known_.push_N[n]) ? o_.overturning.hand_push_N : known_.push_N[n];
        const double moment_Nm = sure() * least_N * o_.overturning.hand_height_m;
        return height_m > 0 ? moment_Nm / height_m : physics::infinity;
    }
    // The least bump at that height, or next to it, that makes it fall towards direction n.
    double falls_Ns(std::size_t n, double height_m) const {
        const std::vector<double>& heights = known_.height_m;
        const double at = std::clamp(height_m, heights.front(), heights.back());
        double least = physics::infinity;
        for (std::size_t h = 0; h < heights.size(); ++h) {
            if (std::abs(heights[h] - at) > 2 * heights.front()) continue;  // those next to it
            least = least_of(least, sure() * least_bump_Ns(n, h));
        }
        return least;
    }
    double slides_m(double impulse_Ns) const {
        const double speed = impulse_Ns / least_mass_kg();
        const double friction = o_.friction > 0 ? o_.friction : scene_.friction;
        return speed * speed / (2 * friction * physics::gravity);
    }

  private:
    static constexpr double standard_errors = 2;

    // A mass that goes by what such things weigh is off by factors, another one by differences.
    double least_mass_kg() const {
        const double error = o_.mass_error_kg;
        return o_.mass_model == "kind"
                   ? o_.mass_kg / std::pow(1 + error / o_.mass_kg, standard_errors)
                   : o_.mass_kg - standard_errors * error;
    }
    // What is not known of its mass and foot counts for bumps as for pushes.
    double sure() const {
        return 1 - standard_errors * o_.overturning.push_error_N / o_.overturning.push_N;
    }
    double least_bump_Ns(std::size_t n, std::size_t h) const {
        const double found = known_.blow_Ns[n * known_.height_m.size() + h];
        if (!std::isinf(found)) return found;
        const double arm = known_.height_m[h] - o_.center_height_m;
        const double turning =
            turning_of(o_.inertia_kg_m2, unit(cross(scene_.up, known_.direction[n])));
        return std::sqrt(2 * o_.mass_kg * o_.barrier_J / (1 + arm * arm * o_.mass_kg * turning));
    }

    const Scene& scene_;
    const Object& o_;
    const DirectedBarrier& known_;
};

// The least of all directions next to `way`, of what of(n) says of each; NaN where one of them is,
// or there is none.
template <class Of>
double least_around(const Scene& scene, const Object& object, const Vec3& way, const Of& of) {
    constexpr double beside = 0.92;  // cosine: of directions 22.5 degrees apart, and some more
    const Vec3 level = unit(along(way, -dot(scene.up, way), scene.up));
    double least = physics::infinity;
    bool asked = false;
    for (std::size_t n = 0; n < DirectedBarrier::directions; ++n) {
        if (way != Vec3{} && dot(object.barrier_by_direction.direction[n], level) < beside)
            continue;
        asked = true;
        least = least_of(least, of(n));
    }
    return asked ? least : NAN;
}

// What is not known of a touch at that height; "": nothing.
std::string doubt_at(const Scene& scene, const Standing& standing, double height_m) {
    if (std::string doubt = standing.doubt(); !doubt.empty()) return doubt;
    if (!(height_m >= -scene.voxel_size_m))
        return "the place is lower than what it stands on, by " + io::length_text(-height_m);
    if (!(height_m <= standing.top_m() + scene.voxel_size_m))
        return "the place is above its top, by " + io::length_text(height_m - standing.top_m());
    return {};
}

std::string newtons(double force_N) {
    return io::two_digits(force_N) + " N";
}

}  // namespace

std::string why_moves(const Scene& scene, const Object& object, const Touch& touch) {
    check(scene, object, touch);
    if (object.grounded) return {};
    const Standing standing(scene, object);
    const double height = standing.height_m(touch.place_m);
    if (std::string doubt = doubt_at(scene, standing, height); !doubt.empty()) return doubt;
    const double slides_N = standing.slides_N(),
                 tips_N = least_around(scene, object, touch.way,
                                       [&](std::size_t n) { return standing.tips_N(n, height); });
    const bool slides = !(touch.force_N < slides_N), tips = !(touch.force_N < tips_N);
    if (tips && !(slides && slides_N <= tips_N))  // of both the one that takes less
        return "the push may tip it: at that height, from " + newtons(tips_N) + " on it may";
    if (slides) return "the push may set it sliding: from " + newtons(slides_N) + " on it may";
    if (const double slides_m = standing.slides_m(touch.impulse_Ns); !(slides_m <= touch.slack_m))
        return "the bump may set it sliding by " + io::length_text(slides_m);
    const double falls_Ns = least_around(
        scene, object, touch.way, [&](std::size_t n) { return standing.falls_Ns(n, height); });
    if (!(touch.impulse_Ns < falls_Ns))
        return "the bump may make it fall: there, from " + io::two_digits(falls_Ns) +
               " N s on it may";
    return {};
}

bool stays(const Scene& scene, const Object& object, const Touch& touch) {
    return why_moves(scene, object, touch).empty();
}

double released_J(const Object& object, double W_J) {
    if (!(W_J >= 0)) refuse("W_J " + io::short_number(W_J) + ": expected joules, 0 or more");
    return object.grounded ? 0 : safety::instability(object.instability, W_J);
}

double stays_up_to_N(const Scene& scene, const Object& object, const Vec3& place_m,
                     const Vec3& way) {
    check(scene, object, {place_m, way});
    if (object.grounded) return physics::infinity;
    const Standing standing(scene, object);
    const double height = standing.height_m(place_m);
    if (!doubt_at(scene, standing, height).empty()) return 0;
    const double least =
        least_of(standing.slides_N(), least_around(scene, object, way, [&](std::size_t n) {
                     return standing.tips_N(n, height);
                 }));
    return least > 0 ? least : 0;  // NaN, too
}

}  // namespace topple

// SPDX-License-Identifier: MIT
#include "topple/stays.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/vectors.h"
#include "io/text.h"
#include "physics/landscape.h"
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

// A thing that stands free, as its figures tell. Comparisons are such that NaN says no.
class Standing {
  public:
    Standing(const Scene& scene, const Object& object)
        : scene_(scene), o_(object), known_(object.barrier_by_direction) {}

    // Whether it rests as scanned, by itself, and its figures are there.
    bool known() const {
        const std::size_t heights = known_.height_m.size();
        return o_.seen_enough && o_.rest_probability >= 0.5 && o_.piece_of < 0 &&
               o_.joint_probability >= 0.5 && o_.barrier_J > 0 && heights > 0 &&
               known_.push_N.size() == DirectedBarrier::directions &&
               known_.direction.size() == DirectedBarrier::directions &&
               known_.blow_Ns.size() == DirectedBarrier::directions * heights && sure() > 0 &&
               least_mass_kg() > 0;
    }
    // Above what it stands on.
    double height_m(const Vec3& place) const { return dot(scene_.up, place) - o_.support_height_m; }
    double top_m() const { return height_m(o_.box_middle_m) + o_.size_m[2] / 2; }

    bool holds_push(double force_N) const {
        return force_N < o_.overturning.slide_N * least_mass_kg() / o_.mass_kg;
    }
    // Towards direction n, at that height.
    bool bears_push(std::size_t n, double height_m, double force_N) const {
        // Infinite where it has no edge that way: then as over the nearest one.
        const double least_N =
            std::isinf(known_.push_N[n]) ? o_.overturning.hand_push_N : known_.push_N[n];
        return force_N * height_m < sure() * least_N * o_.overturning.hand_height_m;
    }
    bool bears_bump(std::size_t n, double height_m, double impulse_Ns) const {
        const std::vector<double>& heights = known_.height_m;
        const double at = std::clamp(height_m, heights.front(), heights.back());
        for (std::size_t h = 0; h < heights.size(); ++h) {
            if (std::abs(heights[h] - at) > 2 * heights.front()) continue;  // those next to it
            if (!(impulse_Ns < sure() * least_bump_Ns(n, h))) return false;
        }
        return true;
    }
    double slides_m(double impulse_Ns) const {
        const double speed = impulse_Ns / least_mass_kg();
        return speed * speed / (2 * scene_.friction * physics::gravity);
    }

  private:
    static constexpr double standard_errors = 2;

    double least_mass_kg() const { return o_.mass_kg - standard_errors * o_.mass_error_kg; }
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

}  // namespace

bool stays(const Scene& scene, const Object& object, const Touch& touch) {
    check(scene, object, touch);
    if (object.grounded) return true;
    const Standing standing(scene, object);
    if (!standing.known()) return false;
    const double height = standing.height_m(touch.place_m), voxel = scene.voxel_size_m;
    if (!(height >= -voxel) || !(height <= standing.top_m() + voxel)) return false;
    if (!standing.holds_push(touch.force_N)) return false;
    if (!(standing.slides_m(touch.impulse_Ns) <= touch.slack_m)) return false;
    constexpr double beside = 0.92;  // cosine: of directions 22.5 degrees apart, and some more
    const double up = dot(scene.up, touch.way);
    const Vec3 way = unit(along(touch.way, -up, scene.up));
    bool asked = false;
    for (std::size_t n = 0; n < DirectedBarrier::directions; ++n) {
        if (touch.way != Vec3{} && dot(object.barrier_by_direction.direction[n], way) < beside)
            continue;
        asked = true;
        if (!standing.bears_push(n, height, touch.force_N) ||
            !standing.bears_bump(n, height, touch.impulse_Ns))
            return false;
    }
    return asked;
}

}  // namespace topple

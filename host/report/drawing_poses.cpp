// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/rotation.h"
#include "report/drawing_parts.h"

namespace topple::report {
namespace {

using Style = Drawing::Style;
using Anchor = Drawing::Anchor;

// The lowest pass out of the basin that the object is in, or none.
const Landscape::Pass* lowest_pass(const Landscape& l) {
    for (const Landscape::Pass& pass : l.passes) {
        if (pass.poses[0] == l.now || pass.poses[1] == l.now) return &pass;
    }
    return nullptr;
}

class SphereMap {
  public:
    SphereMap(const Scene& scene, const Object& object)
        : room_from_input_(rotation_of(scene.manhattan_from_input)),
          l_(object.landscape),
          weight_N_(object.mass_kg * 9.80665) {}

    Drawing draw() {
        Drawing::Sphere sphere{middle, radius, {}, std::numeric_limits<double>::infinity(), 0};
        for (const Vec3& corner : l_.hull_m) {
            const Vec3 v = sphere.corners.emplace_back(turned(room_from_input_, corner));
            sphere.highest_m = std::max(sphere.highest_m, std::hypot(v[0], v[1], v[2]));
        }
        for (const Landscape::Pose& pose : l_.poses)
            sphere.lowest_m = std::min(sphere.lowest_m, -lowest_of(l_.hull_m, pose.up));
        out_.sphere = std::move(sphere);
        for (const Landscape::Pass& pass : l_.passes) border(pass);
        // Where it is now, which need not be the bottom of its basin.
        for (const auto& [dx, dy] : {Point{5, 0}, Point{0, 5}}) {
            out_.strokes.push_back(
                {Style::border,
                 {{middle[0] - dx, middle[1] - dy}, {middle[0] + dx, middle[1] + dy}}});
        }
        marks();
        const std::pair<Point, const char*> sides[] = {{{0, -radius - 14}, "N"},
                                                       {{radius + 18, 4}, "E"},
                                                       {{0, radius + 23}, "S"},
                                                       {{-radius - 18, 4}, "W"}};
        for (const auto& [at, text] : sides)
            out_.say({middle[0] + at[0], middle[1] + at[1]}, Anchor::middle, text);
        out_.say({width / 2, out_.height - 24}, Anchor::middle,
                 "middle (+): as it is \xc2\xb7 rim: upside down \xc2\xb7 lines: basins");
        key();
        return std::move(out_);
    }

  private:
    static constexpr double radius = 112;
    static constexpr Point middle{width / 2, radius + 27};

    Point place(const Vec3& up) const {
        const Point at = map_of(turned(room_from_input_, up));
        return {middle[0] + radius * at[0], middle[1] + radius * at[1]};
    }
    static double apart(const Point& a, const Point& b) {
        return std::hypot(a[0] - b[0], a[1] - b[1]);
    }

    void key() {
        constexpr double step = 11;
        const double x = (width - step * bands) / 2, y = out_.height - 14;
        for (int band = 0; band < bands; ++band) {
            out_.swatches.push_back(
                {{x + step * band, y}, step, 9, ramp_colour((band + 0.5) / bands)});
        }
        const Drawing::Sphere& s = *out_.sphere;
        const double now_m = -lowest_of(s.corners, {0, 0, 1});
        const auto energy = [&](double height_m) { return joules(weight_N_ * (height_m - now_m)); };
        out_.say({x - 5, y + 9}, Anchor::end, energy(s.lowest_m));
        out_.say({x + step * bands + 5, y + 9}, Anchor::start, energy(s.highest_m));
    }

    // Arcs of great circles as short strokes. Past the rim's point they go on at its other side.
    void border(const Landscape::Pass& pass) {
        constexpr double step = std::numbers::pi / 24, least = 3;
        Drawing::Stroke stroke{Style::border, {}};
        const auto end = [&] {
            if (stroke.points.size() > 1) out_.strokes.push_back(stroke);
            stroke.points.clear();
        };
        for (std::size_t n = 0; n < pass.border.size(); ++n) {
            const Vec3& to = pass.border[n];
            const Vec3& from = pass.border[n == 0 ? 0 : n - 1];
            const double angle = std::acos(std::clamp(dot(from, to), -1.0, 1.0));
            const int pieces = std::max(1, static_cast<int>(std::ceil(angle / step)));
            for (int p = 1; p <= pieces; ++p) {
                const double t = static_cast<double>(p) / pieces;
                const Point at = place(topple::unit(along(from, t, minus(to, from))));
                const bool last = n + 1 == pass.border.size() && p == pieces;
                if (!stroke.points.empty() && apart(stroke.points.back(), at) > radius / 2) end();
                if (stroke.points.empty() || last || apart(stroke.points.back(), at) >= least)
                    stroke.points.push_back(at);
            }
        }
        end();
    }

    void marks() {
        const std::vector<int> number = numbers_of(l_);
        const Landscape::Pass* const lowest = lowest_pass(l_);
        std::vector<std::array<std::int32_t, 2>> seen;
        for (const Landscape::Pass& pass : l_.passes) {
            const auto pair = std::minmax(pass.poses[0], pass.poses[1]);
            if (!number[pair.first] || !number[pair.second] ||
                std::ranges::find(seen, std::array{pair.first, pair.second}) != seen.end())
                continue;
            seen.push_back({pair.first, pair.second});
            if (&pass != lowest) out_.dots.push_back({Style::pass, place(pass.up), 2.5});
        }
        if (lowest) out_.dots.push_back({Style::lowest, place(lowest->up), 4.5});
        for (std::size_t n = 0; n < l_.poses.size(); ++n) {
            if (!number[n]) continue;
            const Point at = place(l_.poses[n].up);
            const bool now = static_cast<std::int32_t>(n) == l_.now;
            out_.dots.push_back({now ? Style::now : Style::pose, at, 8});
            out_.say({at[0], at[1] + 4}, Anchor::middle, std::to_string(number[n]), now);
        }
    }

    Rotation room_from_input_;
    const Landscape& l_;
    double weight_N_;
    Drawing out_{"Poses: energy of leaning each way", width, 2 * radius + 92};
};

}  // namespace

Drawing draw_poses(const Scene& scene, const Object& object) {
    return SphereMap(scene, object).draw();
}

}  // namespace topple::report

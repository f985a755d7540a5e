// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <numbers>

#include "physics/hull_polytope.h"
#include "physics/infinity.h"

namespace topple::physics {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

using Edge = HullPolytope::Edge;

// Which end of the edge, or which side, is the one asked for.
std::size_t end_of(const Edge& e, std::uint32_t corner) {
    return e.end[0] == corner ? 0 : 1;
}
std::size_t side_of(const Edge& e, std::uint32_t face) {
    return e.face[0] == face ? 0 : 1;
}

// Where a way through the cell of a corner leaves it: over an edge, at a direction.
struct Exit {
    std::uint32_t edge = none;
    Vec3 at{};
};

// From `from` along from + t sign corner, t > 0. Upwards (sign 1) it crosses the edges whose foot
// lies beyond this corner, downwards the others; none where it ends at the corner's own direction.
Exit leave(const HullPolytope& hull, std::uint32_t corner, const Vec3& from, double sign) {
    const Vec3& a = hull.corner[corner];
    Exit exit;
    double nearest = infinity;
    for (const std::uint32_t n : hull.beside[corner]) {
        const Edge& e = hull.edge[n];
        const std::size_t here = end_of(e, corner);
        const double speed = -sign * e.inside[here];
        if (!(speed > 0)) continue;
        const double t = std::max(0.0, dot(minus(a, hull.corner[e.end[1 - here]]), from) / speed);
        if (t >= nearest) continue;
        nearest = t;
        exit.edge = n;
    }
    if (exit.edge != none) exit.at = unit(along(from, sign * nearest, a));
    return exit;
}

// A state of the way down: at a face's direction, or inside the cell of a corner.
struct Place {
    std::uint32_t face = none, corner = none;
    Vec3 at{};
};

// From a face that is no minimum, towards the point of it nearest to its foot: over the edge in
// which that lies, or about that corner.
Place leave_face(const HullPolytope& hull, std::uint32_t face) {
    double nearest = infinity;
    Place next;
    const auto offer = [&](double distance, const Place& place) {
        if (distance >= nearest) return;
        nearest = distance;
        next = place;
    };
    const HullPolytope::Face& f = hull.face[face];
    for (const std::uint32_t n : f.edges) {
        const Edge& e = hull.edge[n];
        const std::size_t side = side_of(e, face);
        if (e.margin[side] <= 0 && e.held()) offer(-e.margin[side], {e.face[1 - side], none, {}});
        for (const std::uint32_t corner : e.end) {
            const Vec3 away = along(hull.corner[corner], -f.height, f.normal);
            offer(std::sqrt(dot(away, away)), {none, corner, f.normal});
        }
    }
    return next;
}

Place leave_corner(const HullPolytope& hull, const Place& place) {
    const Exit exit = leave(hull, place.corner, place.at, -1);
    if (exit.edge == none) return {};
    const Edge& e = hull.edge[exit.edge];
    const std::size_t other = 1 - end_of(e, place.corner);
    if (e.inside[other] < 0) return {none, e.end[other], exit.at};
    // It rolls along the edge's arc, away from the direction of the foot.
    const auto to_first = [&] {
        if (!e.turns()) return e.margin[1] <= 0;
        const Vec3 top = unit(e.foot);
        return dot(minus(exit.at, top),
                   minus(hull.face[e.face[0]].normal, hull.face[e.face[1]].normal)) > 0;
    };
    return {e.face[to_first() ? 0 : 1], none, {}};
}

// Rounding could send a way round in circles where faces are almost one plane: there, the lowest
// seen is as good.
std::uint32_t follow(const HullPolytope& hull, Place place) {
    std::uint32_t lowest = 0;
    double height = infinity;
    for (std::size_t step = 0; step < hull.face.size() + hull.corner.size(); ++step) {
        if (place.face != none) {
            const HullPolytope::Face& f = hull.face[place.face];
            if (f.minimum) return place.face;
            if (f.height < height) {
                height = f.height;
                lowest = place.face;
            }
            place = leave_face(hull, place.face);
        } else if (place.corner != none) {
            place = leave_corner(hull, place);
        } else {
            break;
        }
    }
    return lowest;
}

double signed_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    return 2 * std::atan2(dot(a, cross(b, c)), 1 + dot(a, b) + dot(b, c) + dot(c, a));
}

// Directions of the steepest way up from a pass by the cell of one of its ends, without the pass.
std::vector<Vec3> way_up(const HullPolytope& hull, const Edge& pass, std::size_t end) {
    std::vector<Vec3> way;
    std::uint32_t corner = pass.end[end];
    Vec3 at = unit(pass.foot);
    // Each cell is crossed once at most: within each the height rises to that of its far side.
    for (std::size_t step = 0; step < hull.corner.size(); ++step) {
        const Exit exit = leave(hull, corner, at, 1);
        if (exit.edge == none) break;
        at = exit.at;
        way.push_back(at);
        const Edge& e = hull.edge[exit.edge];
        corner = e.end[1 - end_of(e, corner)];
    }
    way.push_back(unit(hull.corner[corner]));
    return way;
}

}  // namespace

std::uint32_t descend(const HullPolytope& hull, std::uint32_t face) {
    return follow(hull, {face, none, {}});
}

std::uint32_t descend(const HullPolytope& hull, const Vec3& down) {
    const auto lowest =
        std::max_element(hull.corner.begin(), hull.corner.end(),
                         [&](const Vec3& a, const Vec3& b) { return dot(a, down) < dot(b, down); });
    return follow(hull, {none, static_cast<std::uint32_t>(lowest - hull.corner.begin()), down});
}

std::vector<Vec3> border_over(const HullPolytope& hull, const Edge& pass) {
    std::vector<Vec3> border = way_up(hull, pass, 0);
    std::reverse(border.begin(), border.end());
    border.push_back(unit(pass.foot));
    for (const Vec3& n : way_up(hull, pass, 1)) border.push_back(n);
    return border;
}

std::vector<double> basin_angles(const HullPolytope& hull) {
    constexpr double all = 4 * std::numbers::pi;
    std::vector<double> angle(hull.face.size(), 0.0);
    for (const Edge& e : hull.edge) {
        if (!e.pass()) continue;
        const std::array<std::uint32_t, 2> basin{descend(hull, e.face[0]),
                                                 descend(hull, e.face[1])};
        if (basin[0] == basin[1]) continue;
        const std::vector<Vec3> border = border_over(hull, e);
        // face[0] has the ends counter-clockwise, so its side of the border is on the left.
        for (std::size_t side = 0; side < 2; ++side) {
            const Vec3& from = hull.face[basin[side]].normal;
            double sum = 0;
            for (std::size_t n = 0; n + 1 < border.size(); ++n) {
                sum += signed_triangle(from, border[n], border[n + 1]);
            }
            angle[basin[side]] += side == 0 ? sum : -sum;
        }
    }
    for (std::size_t f = 0; f < angle.size(); ++f) {
        if (!hull.face[f].minimum) continue;
        // The sum lacks the whole sphere where the basin holds the minimum's antipode.
        if (angle[f] < -1e-9) angle[f] += all;
        angle[f] = std::max(angle[f], 0.0);
    }
    if (std::count_if(hull.face.begin(), hull.face.end(),
                      [](const auto& f) { return f.minimum; }) == 1) {
        std::transform(hull.face.begin(), hull.face.end(), angle.begin(),
                       [](const auto& f) { return f.minimum ? all : 0.0; });
    }
    return angle;
}

}  // namespace topple::physics

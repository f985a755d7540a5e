// SPDX-License-Identifier: MIT
#include "export/joints.h"

#include <Eigen/Dense>
#include <algorithm>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "core/vectors.h"
#include "export/eigen.h"
#include "export/named_bodies.h"
#include "export/separate.h"
#include "physics/closed_furniture.h"

namespace topple::exports {
namespace {

constexpr double board_m = physics::ClosedBody::board_m;
constexpr double clear_m = 0.002;  // between a front and the next one

// A box with sides along across, out and up.
Box box_of(const Front& front, const Vec3& center, const Vec3& sides_m) {
    return {center,
            {opposite(front.across), front.out, {0, 0, 1}},
            {sides_m[0] / 2, sides_m[1] / 2, sides_m[2] / 2}};
}

// Of a front's frame: across, out, up from the middle of its outer face.
Vec3 place(const Front& front, double across, double out, double up) {
    return along(along(along(front.middle, across, front.across), out, front.out), up, {0, 0, 1});
}

double volume_m3(const Box& box) {
    return 8 * box.half_m[0] * box.half_m[1] * box.half_m[2];
}

// A board, smaller by so much on all sides.
Box board_of(const Front& front, double inset_m) {
    return box_of(front, place(front, 0, -board_m / 2, 0),
                  {front.wide_m - 2 * inset_m, board_m, front.high_m - 2 * inset_m});
}

// A drawer's floor and walls, of such a length behind its board.
std::vector<Box> tray_of(const Front& front, double inset_m, double long_m) {
    constexpr double thin_m = 0.01, beside_m = 0.02, wall_share = 0.7;
    const double high = front.high_m - 2 * inset_m, inner = front.wide_m - 2 * (inset_m + beside_m),
                 middle = -board_m - long_m / 2, floor = -high / 2 + beside_m,
                 walls = wall_share * (high - beside_m), wall_z = floor + thin_m / 2 + walls / 2;
    std::vector<Box> out{box_of(front, place(front, 0, middle, floor), {inner, long_m, thin_m})};
    for (const double side : {-1.0, 1.0})
        out.push_back(box_of(front, place(front, side * (inner - thin_m) / 2, middle, wall_z),
                             {thin_m, long_m, walls}));
    out.push_back(box_of(front, place(front, 0, -board_m - long_m + thin_m / 2, wall_z),
                         {inner - 2 * thin_m, thin_m, walls}));
    return out;
}

// m (|d|^2 1 - d d^T): what a mass adds about a point so far away.
Eigen::Matrix3d point_inertia(double mass_kg, const Eigen::Vector3d& d) {
    return mass_kg * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
}

Eigen::Matrix3d matrix(const Mat3& m) {
    return Eigen::Matrix3d(m.data());  // symmetric: rows or columns
}

Mat3 rows_of(const Eigen::Matrix3d& m) {
    Mat3 out{};
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) out[3 * r + c] = (m(r, c) + m(c, r)) / 2;
    return out;
}

void weigh(JointedFront& front, double density_kg_m3) {
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (const Box& box : front.boxes) {
        const double mass = density_kg_m3 * volume_m3(box);
        front.mass_kg += mass;
        moment += mass * eigen(box.center);
    }
    const Eigen::Vector3d center = moment / front.mass_kg;
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    for (const Box& box : front.boxes) {
        const double mass = density_kg_m3 * volume_m3(box);
        Eigen::Matrix3d axes;
        for (int a = 0; a < 3; ++a) axes.col(a) = eigen(box.axis[a]);
        const Eigen::Vector3d h2 = eigen(box.half_m).cwiseAbs2();
        const Eigen::Vector3d own(h2[1] + h2[2], h2[0] + h2[2], h2[0] + h2[1]);
        inertia += mass / 3 * (axes * own.asDiagonal() * axes.transpose()).eval() +
                   point_inertia(mass, eigen(box.center) - center);
    }
    front.center_m = {center[0], center[1], center[2]};
    front.inertia_kg_m2 = rows_of(inertia);
}

// Takes what a front weighs out of its body, so that both together are what the body was. False
// where the rest would be no rigid body.
bool take_out(const JointedFront& front, Body& body) {
    if (body.fixed) return true;
    if (!has_inertia(body) || front.mass_kg >= body.mass_kg) return false;
    Body rest = body;
    rest.mass_kg -= front.mass_kg;
    const Eigen::Vector3d center =
        (body.mass_kg * eigen(body.center_m) - front.mass_kg * eigen(front.center_m)) /
        rest.mass_kg;
    rest.center_m = {center[0], center[1], center[2]};
    rest.inertia_kg_m2 =
        rows_of(matrix(body.inertia_kg_m2) - matrix(front.inertia_kg_m2) -
                point_inertia(front.mass_kg, eigen(front.center_m) - eigen(body.center_m)) -
                point_inertia(rest.mass_kg, center - eigen(body.center_m)));
    if (!has_inertia(rest)) return false;
    body = std::move(rest);
    return true;
}

void add_axis(double deep_m, JointedFront& front) {
    constexpr double drawn_share = 0.75;
    front.most = std::numbers::pi / 2;
    switch (front.opening) {
        case Opening::slide:
            front.axis = front.out;
            front.at_m = front.middle;
            front.most = drawn_share * deep_m;
            break;
        case Opening::hinge_at_low_u:
            front.axis = {0, 0, -1};
            front.at_m = place(front, -front.wide_m / 2, 0, 0);
            break;
        case Opening::hinge_at_high_u:
            front.axis = {0, 0, 1};
            front.at_m = place(front, front.wide_m / 2, 0, 0);
            break;
        case Opening::hinge_below:
            front.axis = front.across;
            front.at_m = place(front, 0, 0, -front.high_m / 2);
            break;
    }
}

std::optional<ConvexPart> part_of(const Box& box) {
    const std::array<Vec3, 8> corners = box.corners();
    return hull_part(corners);
}

// Whether boxes lie in no other body: where a part of the furniture was cut away, another one's is.
bool are_free(std::span<const Box> boxes, const std::vector<Body>& bodies, std::size_t own) {
    return std::ranges::all_of(boxes, [&](const Box& box) {
        const std::optional<ConvexPart> part = part_of(box);
        return part && !meets(bodies, *part, bodies[own]);
    });
}

// What is left of a part beyond that side of a board's that costs least of what is solid.
std::optional<ConvexPart> beside(const ConvexPart& part, const ConvexPart& board) {
    std::optional<ConvexPart> out;
    for (const HalfSpace& side : board.face) {
        auto left = cut(part, {opposite(side.normal), -side.offset_m});
        if (left && (!out || std::pair(left->solid.size(), left->volume_m3) >
                                 std::pair(out->solid.size(), out->volume_m3)))
            out = std::move(left);
    }
    return out;
}

// Makes room for a board where other bodies' hulls, which bulge, reach into it by little. False,
// with all as it was, where they don't give way.
bool make_room(const Box& board, std::vector<Body>& bodies, std::size_t own) {
    constexpr double most_of_fixed = 0.05, most_of_free = 0.02;  // of what is solid
    const std::optional<ConvexPart> room = part_of(board);
    if (!room) return false;
    std::vector<std::pair<std::size_t, Body>> cut_back;
    for (std::size_t n = 0; n < bodies.size(); ++n) {
        const auto reaches_in = [&](const ConvexPart& part) {
            return near(part, *room, 0) && overlap(part, *room);
        };
        if (n == own || std::ranges::none_of(bodies[n].parts, reaches_in)) continue;
        Body body = bodies[n];
        double lost_m3 = 0;
        for (ConvexPart& part : body.parts) {
            if (!reaches_in(part)) continue;
            auto left = beside(part, *room);
            if (!left) return false;
            const double lost = static_cast<double>(part.solid.size() - left->solid.size());
            lost_m3 += lost * part.solid_each_m3;
            body.lost_m3 += part.volume_m3 - left->volume_m3;
            part = *std::move(left);
        }
        if (lost_m3 > (body.fixed ? most_of_fixed : most_of_free) * body.solid_m3) return false;
        cut_back.emplace_back(n, std::move(body));
    }
    for (auto& [n, body] : cut_back) bodies[n] = std::move(body);
    return true;
}

// Whether a body lies around a front's grip: it is the handle, which was found as a thing.
bool is_handle(const Front& front, const Body& body) {
    constexpr double around_m = 0.03;
    if (body.fixed || body.parts.empty()) return false;
    const Box grip = box_of(front, front.grip, front.grip_m);
    return std::ranges::all_of(body.parts, [&](const ConvexPart& part) {
        for (std::size_t a = 0; a < 3; ++a) {
            const Interval along = extent_along(part, grip.axis[a]);
            const double middle = dot(grip.axis[a], grip.center), half = grip.half_m[a] + around_m;
            if (along.low < middle - half || along.high > middle + half) return false;
        }
        return true;
    });
}

double volume_m3(std::span<const Box> boxes) {
    double out = 0;
    for (const Box& box : boxes) out += volume_m3(box);
    return out;
}

// The boards and the handle, as large as there is room for among the other bodies, which give way a
// little, and no larger than `most_m3`; and where that is not within the furniture, right before
// it; none where there is none for the front's board.
std::vector<Box> boxes_of(Front& front, double deep_m, double most_m3, std::vector<Body>& bodies,
                          std::size_t own) {
    constexpr double least_long_m = 0.1, shorter_m = 0.05;
    const Vec3 face = front.middle;
    for (const auto& [before_m, inset_m] : {std::pair(0.0, clear_m),
                                            {0.0, 0.01},
                                            {board_m, clear_m},
                                            {board_m, 0.01},
                                            {board_m, 0.02}}) {
        front.middle = along(face, before_m, front.out);
        std::vector<Box> out{board_of(front, inset_m)};
        if (volume_m3(out) > most_m3 || !make_room(out[0], bodies, own)) continue;
        for (double long_m = front.opening == Opening::slide ? deep_m - board_m : 0;
             long_m >= least_long_m; long_m -= shorter_m) {
            const std::vector<Box> tray = tray_of(front, inset_m, long_m);
            if (volume_m3(out) + volume_m3(tray) > most_m3 || !are_free(tray, bodies, own))
                continue;
            out.insert(out.end(), tray.begin(), tray.end());
            break;
        }
        const Box grip = box_of(front, front.grip, front.grip_m);
        if (volume_m3(out) + volume_m3(grip) <= most_m3 && are_free({&grip, 1}, bodies, own))
            out.push_back(grip);
        return out;
    }
    return {};
}

}  // namespace

std::vector<JointedFront> place_fronts(std::vector<Body>& bodies,
                                       const std::vector<std::vector<Front>>& of_object,
                                       double density_kg_m3) {
    constexpr double behind_m = 0.05, most_deep_m = 0.6;  // of a drawer, from what is behind it
    constexpr double most_share = 0.3;                    // of what its body still weighs
    std::vector<JointedFront> out;
    for (std::size_t n = 0; n < std::min(bodies.size(), of_object.size()); ++n) {
        if (bodies[n].parts.empty()) continue;
        double left_kg =
            bodies[n].fixed ? std::numeric_limits<double>::infinity() : bodies[n].mass_kg;
        for (const Front& front : of_object[n]) {
            const double deep_m = std::min(most_deep_m, front.deep_m - behind_m);
            JointedFront made;
            static_cast<Front&>(made) = front;
            made.body = n;
            made.middle = plus(front.middle, bodies[n].moved_m);
            made.grip = plus(front.grip, bodies[n].moved_m);
            std::vector<std::pair<std::size_t, std::vector<ConvexPart>>> handles;
            for (std::size_t other = 0; other < bodies.size(); ++other)
                if (other != n && is_handle(made, bodies[other]))
                    handles.emplace_back(other, std::exchange(bodies[other].parts, {}));
            made.boxes = boxes_of(made, deep_m, most_share * left_kg / density_kg_m3, bodies, n);
            if (made.boxes.empty()) {
                for (auto& [other, parts] : handles) bodies[other].parts = std::move(parts);
                continue;
            }
            for (auto& [other, parts] : handles)
                std::ranges::move(parts, std::back_inserter(made.handle));
            weigh(made, density_kg_m3);
            left_kg -= made.mass_kg;
            add_axis(deep_m, made);
            out.push_back(std::move(made));
        }
    }
    return out;
}

void joint_fronts(std::vector<JointedFront>& fronts, std::vector<Body>& bodies) {
    std::vector<std::size_t> number(bodies.size(), 0);
    std::erase_if(fronts, [&](JointedFront& front) {
        Body& body = bodies[front.body];
        if (are_free(front.boxes, bodies, front.body) && take_out(front, body)) {
            front.name =
                body_name(body, front.body) + "_front_" + std::to_string(number[front.body]++);
            return false;
        }
        for (ConvexPart& part : front.handle)
            if (!meets(bodies, part, body)) body.parts.push_back(std::move(part));
        return true;
    });
}

}  // namespace topple::exports

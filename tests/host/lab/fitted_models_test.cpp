// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <vector>

#include "device/devices.h"
#include "lab/evaluation/groupings.h"
#include "lab/scores/relation_score.h"

// What every sensible model says of generated rooms, with wide limits.
namespace topple::evaluation {
namespace {

// How often what is true has a higher value than what is not: the area under the curve.
double area_under_curve(const std::vector<double>& of_true, const std::vector<double>& of_false) {
    double right = 0;
    for (const double t : of_true)
        for (const double f : of_false) right += t > f ? 1 : t == f ? 0.5 : 0;
    return right / static_cast<double>(of_true.size() * of_false.size());
}

double share_above(const std::vector<double>& values, double limit) {
    return static_cast<double>(std::ranges::count_if(values, [&](double v) { return v > limit; })) /
           static_cast<double>(values.size());
}

// The true body of each primitive with at least 50 points, four fifths of which are that body's.
std::vector<std::int32_t> sure_bodies(const RoomParts& room) {
    const std::vector<std::int32_t> body = scenes::true_bodies(room.world);
    std::vector<std::map<std::int32_t, std::size_t>> votes(room.parts.bodies.size());
    std::vector<std::size_t> points(room.parts.bodies.size());
    for (std::size_t n = 0; n < room.part.size(); ++n) {
        if (room.points.primitive[n] < 0) continue;
        const auto p = static_cast<std::size_t>(room.points.primitive[n]);
        ++points[p];
        if (room.part[n] >= 0) ++votes[p][body[room.part[n]]];
    }
    std::vector<std::int32_t> out(votes.size(), -1);
    for (std::size_t p = 0; p < votes.size(); ++p) {
        for (const auto& [b, count] : votes[p])
            if (points[p] >= 50 && 5 * count >= 4 * points[p]) out[p] = b;
    }
    return out;
}

// Chairs' legs and their seats, boxes on tables, walls and wardrobes: plain rooms and varied ones.
TEST(Groupings, TheModelsTellJointsAndTheRoom) {
    std::vector<double> room_odds, thing_odds, one_odds, two_odds;
    for (const bool varied : {false, true}) {
        RoomOptions options;
        options.room.seed = options.camera.seed = 5;
        options.room.varied = varied;
        options.camera.frames = 20;
        options.parse.voxel_m = 0.02;
        options.parse.device = device::open_device("native");
        const RoomParts room = scan_parts(options);
        const std::vector<std::int32_t> body = sure_bodies(room);
        const std::int32_t building = scenes::true_bodies(room.world).front();
        for (std::size_t p = 0; p < body.size(); ++p) {
            if (body[p] >= 0)
                (body[p] == building ? room_odds : thing_odds)
                    .push_back(room.parts.shell.log_odds[p]);
        }
        for (const graph::Joint& joint : room.parts.joints) {
            const std::int32_t a = body[joint.a], b = body[joint.b];
            if (a < 0 || b < 0 || (a == building && b == building)) continue;
            (a == b ? one_odds : two_odds).push_back(joint.log_odds);
        }
    }
    ASSERT_GT(room_odds.size(), 8u);
    ASSERT_GT(thing_odds.size(), 30u);
    ASSERT_GT(one_odds.size(), 20u);
    ASSERT_GT(two_odds.size(), 20u);
    EXPECT_GT(area_under_curve(room_odds, thing_odds), 0.9);
    EXPECT_GT(share_above(room_odds, 0), 0.7);
    EXPECT_LT(share_above(thing_odds, 0), 0.15);
    EXPECT_GT(area_under_curve(one_odds, two_odds), 0.8);
    EXPECT_GT(share_above(one_odds, 0), 0.5);
    EXPECT_LT(share_above(two_odds, 0), 0.3);
    std::printf(
        "shell: AUC %.3f, found %.2f, false %.2f; joints: AUC %.3f, found %.2f, false %.2f\n",
        area_under_curve(room_odds, thing_odds), share_above(room_odds, 0),
        share_above(thing_odds, 0), area_under_curve(one_odds, two_odds), share_above(one_odds, 0),
        share_above(two_odds, 0));
}

}  // namespace
}  // namespace topple::evaluation

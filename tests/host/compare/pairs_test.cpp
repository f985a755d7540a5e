// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>

#include "core/rotation.h"
#include "host/compare/room_pairs.h"
#include "host/pipeline/scan.h"
#include "topple/compare.h"
#include "topple/device.h"
#include "topple/parse.h"

// Generated rooms between whose two scans things were taken away, put there and moved.
namespace topple::test {
namespace {

class SlowPairs : public Files {
  protected:
    static constexpr double turn_deg = 97;
    static constexpr Vec3 shift_m{3, -2, 0.4};

    std::filesystem::path parsed(const std::string& name, const scenes::World& world,
                                 std::uint64_t seed, double by_deg, const Vec3& by_m) const {
        const scenes::Sequence film = filmed(world, seed, by_deg, by_m);
        FramesView frames;
        frames.intrinsics = film.intrinsics;
        frames.source = name;
        for (const DepthFrame& frame : film.frames) {
            frames.camera_to_world.push_back(frame.camera_to_world);
            frames.images.emplace_back().depth = {frame.depth.data(), film.intrinsics.width,
                                                  film.intrinsics.height};
        }
        ParseOptions options = on(device::open_device("native", 2));
        options.disturbances = {"wind"};
        write_outputs(parse(frames, options), path(name));
        return path(name);
    }
    static Vec3 in_b(const Vec3& room) {
        const double c = std::cos(turn_deg * M_PI / 180), s = std::sin(turn_deg * M_PI / 180);
        return plus({c * room[0] - s * room[1], s * room[0] + c * room[1], room[2]}, shift_m);
    }
};

// Whether the middle of a thing is in a true one.
bool is_in(const scenes::World& world, std::int32_t object, const Vec3& middle) {
    return object >= 0 && scenes::overlap(bounds_of(world, object), {middle, middle}, 0.03);
}

TEST_F(SlowPairs, TellWhatWasTakenPutAndMoved) {
    int told = 0, alarms = 0;
    for (const std::uint64_t seed : {1}) {
        const RoomPair pair = room_pair(seed);
        ASSERT_GE(pair.moved, 0);
        const Comparison found = compare(parsed("a", pair.before, seed, 0, {}),
                                         parsed("b", pair.after, seed + 1000, turn_deg, shift_m));
        const Mat4& a_from_b = found.alignment.a_from_b;
        for (const Vec3& corner : {Vec3{}, pair.before.room})
            EXPECT_LT(length(minus(transformed(a_from_b, in_b(corner)), corner)), 0.05);
        EXPECT_GT(found.alignment.agreeing, 0.95);
        EXPECT_LT(found.alignment.next_agreeing, 0.9);
        for (const ComparedThing& thing : found.things) {
            const auto was = [&](std::int32_t object) {
                return thing.a >= 0 &&
                       is_in(pair.before, object,
                             found.a.objects[static_cast<std::size_t>(thing.a)].box_middle_m);
            };
            const auto is = [&](std::int32_t object) {
                return thing.b >= 0 &&
                       is_in(pair.after, object,
                             transformed(
                                 a_from_b,
                                 found.b.objects[static_cast<std::size_t>(thing.b)].box_middle_m));
            };
            const bool went = thing.became == Became::went, came = thing.became == Became::came,
                       moved = thing.became == Became::moved;
            const bool meant = (went && was(pair.taken)) || (came && is(pair.put)) ||
                               (moved && was(pair.moved) && is(pair.moved));
            told += meant;
            // What was moved and looks otherwise now is told as what went and what came.
            alarms += (went && !meant && !was(pair.moved)) || (came && !meant && !is(pair.moved)) ||
                      (moved && !meant);
        }
    }
    EXPECT_EQ(told, 3);
    EXPECT_EQ(alarms, 0);
}

}  // namespace
}  // namespace topple::test

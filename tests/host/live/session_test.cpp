// SPDX-License-Identifier: MIT
#include "topple/session.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>
#include <thread>

#include "core/checksum.h"
#include "host/pipeline/scan.h"
#include "host/pipeline/small_walk.h"
#include "io/text.h"

// A session is a parse of the frames that it has, and knows things again.
namespace topple::test {
namespace {

class Sessions : public Files {
  protected:
    static void SetUpTestSuite() { walk_ = new scenes::Sequence(small_walk()); }
    static void TearDownTestSuite() { delete walk_; }

    static SessionOptions quick() {
        SessionOptions options;
        options.parse = on(device::open_device("native", 2));
        options.parse.disturbances = {"wind"};
        return options;
    }
    static FrameView frame(std::size_t n) { return frames_view_of(*walk_).images.at(n); }
    static const Mat4& pose(std::size_t n) { return walk_->frames.at(n).camera_to_world; }
    // Rounded, as poses come.
    static Mat4 rounded(Mat4 pose) {
        for (std::size_t n = 0; n < 12; ++n) pose[n] = std::round(pose[n] * 3e4) / 3e4;
        return pose;
    }
    static Mat4 shifted(Mat4 pose, double x_m) {
        pose[3] += x_m;
        return pose;
    }
    static void expect_same(const Scene& got, const Scene& expected) {
        EXPECT_EQ(got.points.x, expected.points.x);
        EXPECT_EQ(got.points.object, expected.points.object);
        EXPECT_EQ(got.solid.x, expected.solid.x);
        EXPECT_EQ(got.solid.object, expected.solid.object);
        ASSERT_EQ(got.objects.size(), expected.objects.size());
        for (std::size_t n = 0; n < got.objects.size(); ++n) {
            EXPECT_EQ(got.objects[n].mass_kg, expected.objects[n].mass_kg);
            EXPECT_EQ(got.objects[n].barrier_J, expected.objects[n].barrier_J);
            EXPECT_EQ(got.objects[n].risk_J, expected.objects[n].risk_J);
        }
    }
    static const scenes::Sequence* walk_;
};
const scenes::Sequence* Sessions::walk_ = nullptr;

TEST_F(Sessions, AnUpdateIsAParseOfTheFramesThatAreThere) {
    const SessionOptions options = quick();
    Session session(walk_->intrinsics, {}, options);
    EXPECT_EQ(session.scene(), nullptr);
    // Some drifted, one is of another place.
    for (std::size_t n = 0; n < 5; ++n)
        EXPECT_EQ(session.add(frame(n), shifted(pose(n), n < 2 ? 0 : 0.3)), n);
    session.add(frame(0), shifted(pose(0), 3));
    session.update();
    session.correct({{2, pose(2)}, {3, pose(3)}, {4, pose(4)}});
    session.forget(5);
    session.add(frame(5), pose(5));
    const auto found = session.update();
    EXPECT_EQ(found->frames, (std::vector<FrameId>{0, 1, 2, 3, 4, 6}));
    FramesView same = frames_view_of(*walk_);
    expect_same(found->result->scene, parse(same, options.parse).scene);
    EXPECT_EQ(session.scene(), found);

    std::map<FrameId, Mat4> poses;
    for (std::size_t n = 0; n < 6; ++n)
        same.camera_to_world[n] = poses[found->frames[n]] = rounded(pose(n));
    session.correct(poses);
    expect_same(session.update()->result->scene, parse(same, options.parse).scene);
}

TEST_F(Sessions, AnUpdateKeepsItsBudgetAndTheParseGoesOnBehind) {
    using namespace std::chrono_literals;
    const SessionOptions options = quick();
    Session session(walk_->intrinsics, {}, options);
    expect_input_error([&] { session.update(0ms); }, {"no frames yet"});
    for (std::size_t n = 0; n < 6; ++n) session.add(frame(n), pose(n));
    EXPECT_EQ(session.update(0ms), nullptr);
    const auto found = session.update(std::chrono::milliseconds::max());
    ASSERT_NE(found, nullptr);
    expect_same(found->result->scene, parse(frames_view_of(*walk_), options.parse).scene);
    EXPECT_EQ(found->things.back().change, Change::found);
    EXPECT_TRUE(found->current);
    EXPECT_EQ(found->number, 1u);
    session.forget(0);
    const auto before = session.update(-1ms);
    EXPECT_FALSE(before->current);
    EXPECT_EQ(before->number, 1u);
    EXPECT_EQ(before->result, found->result);
    EXPECT_EQ(before->things.back().change, Change::none);
    FramesView same = frames_view_of(*walk_);
    same.images.erase(same.images.begin());
    same.camera_to_world.erase(same.camera_to_world.begin());
    const auto settled = session.settle();
    expect_same(settled->scene, parse(same, options.parse).scene);
    EXPECT_EQ(session.scene()->frames, (std::vector<FrameId>{1, 2, 3, 4, 5}));
    EXPECT_EQ(session.scene()->result, settled);
    EXPECT_EQ(session.scene()->number, 2u);
}

TEST_F(Sessions, CancellingEndsAnUpdateAndWhatGoesOnBehind) {
    using namespace std::chrono_literals;
    Session session(walk_->intrinsics, {}, quick());
    for (std::size_t n = 0; n < 6; ++n) session.add(frame(n), pose(n));
    EXPECT_EQ(session.update(0ms), nullptr);
    session.cancel();
    EXPECT_EQ(session.scene(), nullptr);
    EXPECT_EQ(session.update()->frames.size(), 6u);
    session.forget(0);
    session.update(0ms);  // left at work: the session's end ends it
}

// Three frames show a thing that three later ones see through.
TEST_F(Sessions, SettlingCountsWhatHasGoneAsAParseDoes) {
    std::vector<std::uint16_t> with = walk_->frames[0].depth;
    for (std::size_t v = 20; v < 50; ++v)
        for (std::size_t u = 30; u < 60; ++u)
            with[96 * v + u] = static_cast<std::uint16_t>(with[96 * v + u] * 6 / 10);
    const SessionOptions options = quick();
    Session session(walk_->intrinsics, {}, options);
    FramesView all = frames_view_of(*walk_);
    for (std::size_t n = 0; n < 6; ++n) {
        all.images[n] = frame(0);
        if (n < 3) all.images[n].depth = {with.data(), 96, 72};
        all.camera_to_world[n] = shifted(pose(0), 0.001 * static_cast<double>(n));
        session.add(all.images[n], all.camera_to_world[n]);
    }
    const Scene expected = parse(all, options.parse).scene;
    const auto settled = session.settle();
    expect_same(settled->scene, expected);
    EXPECT_NE(session.update()->result->scene.points.x, expected.points.x);
    EXPECT_EQ(session.settle(), settled);
}

TEST_F(Sessions, ThingsKeepTheirIdsWhereverTheirFramesGo) {
    Session session(walk_->intrinsics, {}, quick());
    for (std::size_t n = 0; n < 6; ++n) session.add(frame(n), pose(n));
    const auto before = session.update();
    ASSERT_GT(before->things.size(), 3u);
    std::map<FrameId, Mat4> poses;
    for (std::size_t n = 0; n < 6; ++n) poses[n] = shifted(pose(n), 0.7);
    session.correct(poses);
    const auto after = session.update();
    ASSERT_EQ(after->things.size(), before->things.size());
    for (std::size_t n = 0; n < after->things.size(); ++n) {
        EXPECT_EQ(after->things[n].id, before->things[n].id);
        EXPECT_EQ(after->things[n].change, Change::none);
    }
    // Pixels show things by those ids.
    const ThingLabels labels = session.label(frame(1), shifted(pose(1), 0.7));
    ASSERT_EQ(labels.thing.size(), std::size_t{96} * 72);
    EXPECT_GT(std::ranges::count(labels.thing, 0), 500);
    for (const std::int64_t id : labels.thing)
        EXPECT_TRUE(id == -1 || std::ranges::any_of(after->things, [&](const Thing& t) {
                        return static_cast<std::int64_t>(t.id) == id;
                    }));
    // Nothing new: the same scene without changes.
    EXPECT_EQ(session.update()->result, after->result);
}

// A correction that is wrong, as of a false loop closure, is no news of the room.
TEST_F(Sessions, PosesThatBecameWorseChangeNoRoom) {
    scenes::CameraOptions camera;
    camera.intrinsics = walk_->intrinsics;
    camera.frames = 12;
    const scenes::Sequence walk = scenes::walk(scenes::furnished_room({}), camera);
    const FramesView view = frames_view_of(walk);
    Session session(walk.intrinsics, {}, quick());
    for (std::size_t n = 0; n < 12; ++n) session.add(view.images[n], view.camera_to_world[n]);
    session.update();
    for (const double by_m : {0.4, 0.0}) {
        std::map<FrameId, Mat4> poses;
        for (std::size_t n = 4; n < 9; ++n) poses[n] = shifted(view.camera_to_world[n], by_m);
        session.correct(poses);
        for (const Thing& thing : session.update()->things)
            EXPECT_TRUE(thing.change != Change::came && thing.change != Change::moved &&
                        thing.change != Change::gone)
                << by_m << ": thing " << thing.id << " " << to_string(thing.change);
    }
}

TEST_F(Sessions, WhatIsNoFrameIsRefusedAndChangesNothing) {
    Session session(walk_->intrinsics, {}, quick());
    session.add(frame(0), pose(0));
    const auto refused = [&](ErrorKind kind, const char* words, const auto& call) {
        try {
            call();
            ADD_FAILURE() << words;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), kind) << error.what();
            const std::string what = error.what();
            EXPECT_NE(what.find(words), std::string::npos) << what;
        }
    };
    const std::vector<std::uint16_t> dark(std::size_t{96} * 72, 0);
    FrameView empty, small = frame(1);
    empty.depth = {dark.data(), 96, 72};
    small.depth = {dark.data(), 48, 72};
    Mat4 skewed = pose(1);
    skewed[0] = 3;
    refused(ErrorKind::input, "no readings", [&] { session.add(empty, pose(1)); });
    refused(ErrorKind::input, "once more", [&] { session.add(frame(0), pose(0)); });
    refused(ErrorKind::input, "frame 1: depth is 48 x 72", [&] { session.add(small, pose(1)); });
    const char* const of_1 = "frame 1: camera_to_world";
    refused(ErrorKind::input, of_1, [&] { session.add(frame(1), skewed); });
    refused(ErrorKind::input, "frame 0: camera", [&] { session.correct({{0, skewed}}); });
    refused(ErrorKind::usage, "no frame 9", [&] { session.correct({{9, pose(0)}}); });
    refused(ErrorKind::usage, "no frame 9", [&] { session.forget(9); });
    refused(ErrorKind::usage, "before update()", [&] { session.label(frame(0), pose(0)); });
    EXPECT_EQ(session.frames(), std::vector<FrameId>{0});
    session.forget(0);
    EXPECT_EQ(session.frame_bytes(), 0u);
    refused(ErrorKind::input, "no frames", [&] { session.update(); });
    SessionOptions none = quick();
    none.max_frame_bytes = 0;
    refused(ErrorKind::usage, "max_frame_bytes", [&] { Session(walk_->intrinsics, {}, none); });
}

// As if the process had ended: frames, poses, what is known of things, all of it goes on.
TEST_F(Sessions, GoOnFromACheckpoint) {
    const auto file = path("session.checkpoint");
    std::optional<Session> first(std::in_place, walk_->intrinsics, std::nullopt, quick());
    for (std::size_t n = 0; n < 4; ++n) first->add(frame(n), shifted(pose(n), n < 2 ? 0 : 0.3));
    const auto before = first->update();
    first->correct({{2, pose(2)}, {3, pose(3)}});
    first->forget(1);
    first->checkpoint(file);
    const auto more = [&](Session& session) {
        EXPECT_EQ(session.add(frame(4), pose(4)), 4u);
        return session.update();
    };
    const auto expected = more(*first);
    first.reset();

    Session again = Session::resume(file, quick());
    EXPECT_EQ(again.scene(), nullptr);
    EXPECT_EQ(again.frames(), (std::vector<FrameId>{0, 2, 3}));
    EXPECT_EQ(again.intrinsics()->fx, walk_->intrinsics.fx);
    EXPECT_THROW(again.add(frame(3), shifted(pose(3), 0.3)), Error) << "the frame before";
    const auto found = more(again);
    expect_same(found->result->scene, expected->result->scene);
    ASSERT_EQ(found->things.size(), expected->things.size());
    std::size_t known = 0;
    for (std::size_t n = 0; n < found->things.size(); ++n) {
        EXPECT_EQ(found->things[n].id, expected->things[n].id);
        EXPECT_EQ(found->things[n].change, expected->things[n].change);
        known += std::ranges::any_of(before->things, [&](const Thing& thing) {
            return thing.id == found->things[n].id && thing.object >= 0;
        });
    }
    EXPECT_GT(known, 2u);
    // Of less memory: what others stand next to goes.
    SessionOptions small = quick();
    small.max_frame_bytes = again.frame_bytes() / 2;
    EXPECT_LT(Session::resume(file, small).frames().size(), 3u);
    again.checkpoint(file);  // in its place
    EXPECT_EQ(Session::resume(file, quick()).frames().size(), 4u);
}

TEST_F(Sessions, ACheckpointThatIsDamagedIsRefused) {
    const auto file = path("session.checkpoint"), other = write("notes.txt", "mine");
    Session session(walk_->intrinsics, {}, quick());
    for (std::size_t n = 0; n < 3; ++n) session.add(frame(n), pose(n));
    session.update();
    session.checkpoint(file);
    const std::string whole(io::read_file(file).text());
    const auto refused = [&](const std::string& text, const char* words) {
        write("session.checkpoint", text);
        try {
            Session::resume(file, quick());
            ADD_FAILURE() << words;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input);
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
        }
    };
    refused({}, "is empty");
    refused("topple.w", "damaged or cut short");
    refused(whole.substr(0, whole.size() / 2), "damaged or cut short");
    std::string turned = whole;
    turned[turned.size() / 3] ^= 1;
    refused(turned, "damaged or cut short");
    // Whatever the checksum says: each byte before the images, and some after.
    constexpr std::size_t sum_bytes = sizeof(Checksum::Value);
    for (std::size_t at = 8; at + sum_bytes < whole.size(); at += at < 400 ? 1 : 997) {
        turned = whole;
        turned[at] = static_cast<char>(turned[at] ^ 0xFF);
        const Checksum::Value sum = Checksum::of(turned.data(), turned.size() - sum_bytes);
        std::memcpy(turned.data() + turned.size() - sum_bytes, &sum, sum_bytes);
        write("session.checkpoint", turned);
        try {
            Session from = Session::resume(file, quick());
            if (at % 64 == 0) from.update();
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input) << at << ": " << error.what();
        }
    }
    EXPECT_THROW(session.checkpoint(other), Error);
    EXPECT_EQ(io::read_file(other).text(), "mine");
    EXPECT_THROW(session.checkpoint(path("missing") / "file"), Error);
}

TEST_F(Sessions, KeepsToItsMemoryAndLeavesOutFramesThatOthersStandNextTo) {
    SessionOptions options = quick();
    Session all(walk_->intrinsics, {}, options);
    for (std::size_t n = 0; n < 4; ++n) all.add(frame(n), pose(n));
    options.max_frame_bytes = all.frame_bytes() + all.frame_bytes() / 8;
    Session few(walk_->intrinsics, {}, options);
    for (std::size_t n = 0; n < 3; ++n) few.add(frame(n), pose(n));
    for (int n = 0; n < 20; ++n) few.add(frame(3), shifted(pose(3), 1e-3 * n));
    EXPECT_LE(few.frame_bytes(), options.max_frame_bytes);
    const std::vector<FrameId> left = few.frames();
    ASSERT_GE(left.size(), 3u);
    EXPECT_EQ(left[0], 0u);
    EXPECT_EQ(left[1], 1u);
    EXPECT_EQ(left.back(), 22u);
}

TEST_F(Sessions, FramesComeWhileOthersReadAndUpdate) {
    Session session(walk_->intrinsics, {}, quick());
    for (std::size_t n = 0; n < 4; ++n) session.add(frame(n), pose(n));
    std::atomic<bool> done = false;
    std::jthread reader([&] {
        while (!done) {
            const auto scene = session.scene();
            EXPECT_TRUE(!scene || scene->things.size() >= scene->result->scene.objects.size());
            std::this_thread::yield();
        }
    });
    std::jthread keeper([&] {
        while (!done) {
            session.checkpoint(path("session.checkpoint"));
            EXPECT_GE(Session::resume(path("session.checkpoint"), quick()).frames().size(), 4u);
        }
    });
    std::jthread updater([&] {
        session.update();
        session.update();
        done = true;
    });
    for (std::size_t n = 4; n < 6; ++n) session.add(frame(n), pose(n));
    updater.join();
    EXPECT_GE(session.scene()->frames.size(), 4u);
}

}  // namespace
}  // namespace topple::test

// SPDX-License-Identifier: MIT
#include "live/session_stream.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>

#include "core/descriptor.h"
#include "host/pipeline/small_walk.h"
#include "points/caller_frames.h"

// Frames, sweeps and corrections as messages, which a program writes into a pipe.
namespace topple::test {
namespace {

using namespace std::chrono_literals;

std::string pose_text(const Mat4& pose) {
    std::string out;
    char number[32];
    for (const double value : pose) {
        std::snprintf(number, sizeof(number), "%s%.17g", out.empty() ? "[" : ", ", value);
        out += number;
    }
    return out + "]";
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

class SessionStreams : public testing::Test {
  protected:
    SessionStreams() : walk_(small_walk()) {
        std::signal(SIGPIPE, SIG_IGN);
        open();
    }
    ~SessionStreams() override {
        from_ = Descriptor();  // which ends whoever writes
        if (writing_.joinable()) writing_.join();
    }
    // On a thread of its own: a pipe holds little.
    void write(std::string text, bool then_close = true) {
        if (writing_.joinable()) writing_.join();
        writing_ = std::thread([this, text = std::move(text), then_close] {
            for (std::size_t at = 0; at < text.size();) {
                const ssize_t put = ::write(to_.get(), text.data() + at, text.size() - at);
                if (put <= 0) break;
                written_ = at += static_cast<std::size_t>(put);
            }
            if (then_close) close();
        });
    }
    void open() {
        int ends[2];
        EXPECT_EQ(::pipe2(ends, O_CLOEXEC), 0);
        from_ = Descriptor(ends[0]);
        if (writing_.joinable()) writing_.join();
        to_ = Descriptor(ends[1]);
    }
    void close() { to_ = Descriptor(); }
    std::string intrinsics() const {
        const Intrinsics& k = walk_.intrinsics;
        char text[400];
        std::snprintf(text, sizeof(text),
                      R"({"intrinsics": {"width": %u, "height": %u, "fx": %.17g, "fy": %.17g, )"
                      R"("cx": %.17g, "cy": %.17g, "depth_scale": %.17g}})",
                      k.width, k.height, k.fx, k.fy, k.cx, k.cy, k.depth_scale);
        return std::string(text) + "\n";
    }
    std::string frame(std::size_t n, const std::string& rgb = {}) const {
        return R"({"add": "frame", "pose": )" + pose_text(walk_.frames[n].camera_to_world) +
               (rgb.empty() ? "" : R"(, "rgb": true)") + "}\n" + bytes_of(walk_.frames[n].depth) +
               rgb;
    }
    // Reads until it ends. Whatever is left out is told.
    void read_all(live::SessionStream& stream) {
        for (int waits = 0; !stream.ended() && waits < 1000; ++waits) {
            if (!session_) session_ = stream.begin({}, {});
            const bool changed =
                session_ && stream.read(*session_, {.told = [&](const std::string& line) {
                    told_ += line + "\n";
                }});
            if (!changed) std::this_thread::sleep_for(10ms);
        }
        ASSERT_TRUE(stream.ended());
        if (!session_)
            stream.begin({}, {});
        else
            stream.read(*session_, {});
    }

    scenes::Sequence walk_;
    Descriptor from_, to_;
    std::thread writing_;
    std::atomic<std::size_t> written_ = 0;
    std::unique_ptr<Session> session_;
    std::string told_;
};

TEST_F(SessionStreams, AreTheSameSession) {
    Mat4 moved = walk_.frames[1].camera_to_world;
    moved[3] += 0.01;
    write(intrinsics() + frame(0) + "\n" + frame(1) + frame(2) + frame(3) +
          R"({"correct": {"1": )" + pose_text(moved) + "}}\n" + "{\"forget\": 2}\n");
    live::SessionStream stream(from_.get(), "pipe");
    read_all(stream);
    EXPECT_EQ(stream.missing_from("out"), "");
    EXPECT_EQ(told_, "");
    ASSERT_TRUE(session_);
    EXPECT_EQ(session_->frames(), (std::vector<FrameId>{0, 1, 3}));
    Session same(walk_.intrinsics);
    for (const std::size_t n : {0, 1, 3})
        same.add(view_of(walk_.frames[n], walk_.intrinsics),
                 n == 1 ? moved : walk_.frames[n].camera_to_world);
    EXPECT_EQ(session_->update()->result->scene.points.x, same.update()->result->scene.points.x);
}

TEST_F(SessionStreams, OfPointsHaveColours) {
    write(R"({"add": "points", "count": 2, "rgb": true, "pose": )" +
          pose_text({1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}) + "}\n" +
          bytes_of(std::vector<float>{1, 2, 3, 4, 5, 6}) +
          bytes_of(std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6}));
    live::SessionStream stream(from_.get(), "pipe");
    read_all(stream);
    EXPECT_EQ(stream.missing_from("out"), "");
    ASSERT_TRUE(session_);
    EXPECT_FALSE(session_->intrinsics());
    EXPECT_EQ(session_->frames().size(), 1u);
}

// Frames that wait for a session that is busy take only so much memory.
TEST_F(SessionStreams, WhoeverWritesWaitsWhereMuchIsUnread) {
    constexpr std::size_t sweeps = 8, points = 100'000;
    std::string text;
    for (std::size_t n = 0; n < sweeps; ++n)
        text += R"({"add": "points", "count": 100000, "pose": )" +
                pose_text({1, 0, 0, double(n), 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}) + "}\n" +
                bytes_of(std::vector<float>(3 * points, 1));
    write(text);
    live::SessionStream stream(from_.get(), "pipe", 1'000'000);
    std::this_thread::sleep_for(200ms);
    // One sweep waits, one has been read, and some of the next; a pipe holds 64 KiB.
    EXPECT_LT(written_, text.size() / 2);
    read_all(stream);
    EXPECT_EQ(written_, text.size());
    EXPECT_EQ(session_->frames().size(), sweeps) << told_;
}

TEST_F(SessionStreams, WhatIsRefusedIsNamedAndTheOthersStay) {
    const std::string dark = R"({"add": "frame", "pose": )" +
                             pose_text(walk_.frames[1].camera_to_world) + "}\n" +
                             std::string(bytes_of(walk_.frames[1].depth).size(), '\0');
    write(intrinsics() + frame(0) + dark + frame(2) + "{\"forget\": 1}\n{\"forget\": 7}\n");
    live::SessionStream stream(from_.get(), "pipe");
    read_all(stream);
    EXPECT_EQ(told_,
              "pipe: message 2: frame 1: it has no readings; it is left out\n"
              "pipe: message 4: session: there is no frame 1; so the message does nothing\n"
              "pipe: message 5: session: there is no frame 7; so the message does nothing\n");
    EXPECT_EQ(session_->frames(), (std::vector<FrameId>{0, 2}));
    EXPECT_EQ(stream.missing_from("out"), "");
}

TEST_F(SessionStreams, FaultsEndIt) {
    const std::string pose = pose_text(walk_.frames[0].camera_to_world);
    const std::string add = R"({"add": "frame", "pose": )" + pose + "}\n";
    const auto fault = [&](const std::string& text) {
        open();
        session_.reset();
        write(text);
        live::SessionStream stream(from_.get(), "pipe");
        read_all(stream);
        return stream.missing_from("");
    };
    EXPECT_EQ(fault(""), "");
    EXPECT_EQ(fault("{}\n"),
              "pipe: message 0: has none of \"intrinsics\", \"add\", \"correct\" and \"forget\"");
    EXPECT_NE(fault("[1\n").find("pipe: message 0: is no JSON"), std::string::npos);
    EXPECT_EQ(fault("{"), "pipe: ends within a message, which needs its line's end");
    EXPECT_EQ(fault(add), "pipe: message 0: adds a frame, but the first message had no intrinsics");
    EXPECT_EQ(fault(intrinsics() + intrinsics()),
              "pipe: message 1: has intrinsics, which only the first may have");
    EXPECT_EQ(
        fault(intrinsics() + add + "12"),
        "pipe: message 1: is cut short: " + std::to_string(2 * walk_.frames[0].depth.size() - 2) +
            " of " + std::to_string(2 * walk_.frames[0].depth.size()) + " bytes are missing");
    EXPECT_EQ(fault(intrinsics() + "{\"add\": \"frame\", \"pose\": [1, 2]}\n"),
              "pipe: message 1: \"pose\" must be a list of 16 numbers, row by row");
    EXPECT_EQ(fault(intrinsics() + "{\"add\": \"frame\", \"colour\": true}\n"),
              "pipe: message 1: has \"colour\", which it can't have");
    EXPECT_EQ(fault("{\"add\": \"points\", \"count\": 1e9, \"pose\": " + pose + "}\n"),
              "pipe: message 0: \"count\" is 1000000000.0, but must be a whole number up to "
              "10000000");
    EXPECT_EQ(fault("{\"add\": \"points\", \"count\": -1, \"pose\": " + pose + "}\n"),
              "pipe: message 0: \"count\" is -1, but must be a whole number up to 10000000");
    EXPECT_EQ(fault("{\"add\": \"mesh\"}\n"),
              "pipe: message 0: adds \"mesh\", which is neither \"frame\" nor \"points\"");
    EXPECT_EQ(fault("{\"correct\": {\"one\": " + pose + "}}\n"),
              "pipe: message 0: corrects \"one\", which is no frame's number");
    EXPECT_NE(fault("{\"intrinsics\": {\"width\": 0}}\n").find("\"width\" is 0, but must be"),
              std::string::npos);
    EXPECT_EQ(fault(std::string((std::size_t{18} << 20), ' ')),
              "pipe: line 1 is longer than 16 MiB");
    const std::string after = fault(intrinsics() + frame(0) + "12\nx\n");
    EXPECT_NE(after.find("message 2: "), std::string::npos) << after;
    const std::string longer = fault(intrinsics() + frame(0) + "\x01\n");
    EXPECT_NE(longer.find("were the readings of the message before longer than the " +
                          std::to_string(2 * walk_.frames[0].depth.size()) + " bytes"),
              std::string::npos)
        << longer;
    EXPECT_NE(fault("{\"add\": \"frame\", \"pose\": [NaN]}\n").find("NaN is no number of JSON"),
              std::string::npos);
    // A frame before the fault is there.
    EXPECT_NE(fault(intrinsics() + frame(0) + "x\n"), "");
    EXPECT_EQ(session_->frames().size(), 1u);
}

TEST_F(SessionStreams, EndWhileSomebodyStillWrites) {
    write(intrinsics() + R"({"add": "frame")", false);
    live::SessionStream stream(from_.get(), "pipe");
    while (!stream.begin({}, {})) std::this_thread::sleep_for(10ms);
    EXPECT_FALSE(stream.ended());
}

}  // namespace
}  // namespace topple::test

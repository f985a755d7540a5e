// SPDX-License-Identifier: MIT
#include "topple/frames_view.h"

#include <new>

#include "host/pipeline/scan.h"
#include "host/pipeline/small_walk.h"
#include "io/file_writer.h"
#include "lab/scan/files.h"

// Depth frames in the caller's memory: the same as those of a folder.
namespace topple::test {
namespace {

constexpr float nan_m = std::numeric_limits<float>::quiet_NaN();

class FramesViews : public Files {
  protected:
    static void SetUpTestSuite() { walk_ = new scenes::Sequence(small_walk()); }
    static void TearDownTestSuite() { delete walk_; }

    // Pictures of twice the depth images' size.
    FramesViews() : pictures_(walk_->frames.size()) {
        for (std::size_t n = 0; n < pictures_.size(); ++n)
            for (std::size_t p = 0; p < std::size_t{4} * 96 * 72; ++p)
                pictures_[n].push_back({static_cast<std::uint8_t>(40 + p % 192),
                                        static_cast<std::uint8_t>(50 + p / 192),
                                        static_cast<std::uint8_t>(200 - 20 * n)});
    }
    FramesView view() const { return frames_view_of(*walk_); }
    // With the poses as matrices, to their last digit.
    void write_folder(const std::string& name) const {
        scenes::make_folder(path(name + "/depth"));
        scenes::make_folder(path(name + "/color"));
        std::string poses;
        for (std::size_t n = 0; n < walk_->frames.size(); ++n) {
            const std::string image = std::to_string(n) + ".png";
            scenes::write_depth_png(path(name + "/depth/" + image), 96, walk_->frames[n].depth);
            scenes::write_colour_png(path(name + "/color/" + image), 192, pictures_[n]);
            for (std::size_t k = 0; k < 12; ++k) {
                std::array<char, 40> digits{};
                std::snprintf(digits.data(), digits.size(), "%.17g ",
                              walk_->frames[n].camera_to_world[k]);
                poses += digits.data();
            }
            poses += '\n';
        }
        io::write_file(path(name + "/poses.txt"), poses);
        io::write_file(path(name + "/intrinsics.json"), scenes::intrinsics_text(walk_->intrinsics));
    }
    static ParseOptions quick() {
        ParseOptions options = on(device::open_device("native", 2));
        options.disturbances = {"wind"};
        return options;
    }
    static void expect_same(const Scene& got, const Scene& expected) {
        EXPECT_EQ(got.points.x, expected.points.x);
        EXPECT_EQ(got.points.y, expected.points.y);
        EXPECT_EQ(got.points.z, expected.points.z);
        EXPECT_EQ(got.points.red, expected.points.red);
        EXPECT_EQ(got.points.object, expected.points.object);
        EXPECT_EQ(got.up, expected.up);
        ASSERT_EQ(got.objects.size(), expected.objects.size());
        for (std::size_t n = 0; n < got.objects.size(); ++n) {
            EXPECT_EQ(got.objects[n].barrier_J, expected.objects[n].barrier_J);
            EXPECT_EQ(got.objects[n].mass_kg, expected.objects[n].mass_kg);
        }
    }
    static const scenes::Sequence* walk_;
    std::vector<std::vector<Rgb>> pictures_;
};
const scenes::Sequence* FramesViews::walk_ = nullptr;

TEST_F(FramesViews, GiveWhatAFolderOfThemGives) {
    write_folder("walk");
    const Scene expected = parse(path("walk"), quick()).scene;
    ASSERT_GT(expected.points.x.size(), 1000u);
    ASSERT_FALSE(expected.points.red.empty());

    // Rows with something between them, and one image that runs upwards.
    constexpr std::size_t row = 96 + 7;
    std::vector<std::vector<std::uint16_t>> padded;
    std::vector<std::vector<float>> metres;
    FramesView frames = view(), floats = view();
    for (std::size_t n = 0; n < frames.images.size(); ++n) {
        const std::vector<std::uint16_t>& depth = walk_->frames[n].depth;
        std::vector<std::uint16_t>& rows = padded.emplace_back(row * 72, std::uint16_t{9999});
        for (std::size_t v = 0; v < 72; ++v) {
            const std::size_t at = n == 0 ? 71 - v : v;
            std::copy_n(depth.data() + v * 96, 96, rows.data() + at * row);
        }
        const auto stride = static_cast<std::ptrdiff_t>(row * sizeof(std::uint16_t));
        frames.images[n].depth = n == 0 ? ImageView(rows.data() + 71 * row, 96, 72, -stride)
                                        : ImageView(rows.data(), 96, 72, stride);
        frames.images[n].colour = {pictures_[n].data(), 192, 144};

        std::vector<float>& values = metres.emplace_back();
        for (const std::uint16_t stored : depth)
            values.push_back(static_cast<float>(stored) / 1000);
        for (std::size_t p = 0; p < values.size(); ++p)
            if (depth[p] == 0)
                values[p] = std::array{0.0f, nan_m, -1.0f, 1e9f,
                                       std::numeric_limits<float>::infinity()}[p % 5];
        floats.images[n] = {{}, {values.data(), 96, 72}, frames.images[n].colour};
    }
    const ParseResult result = parse(frames, quick());
    expect_same(result.scene, expected);
    EXPECT_EQ(result.scene.source, "frames");
    write_outputs(result, path("out"));
    EXPECT_TRUE(std::filesystem::exists(path("out/report.html")));

    FramesView one_by_one = floats;
    one_by_one.images.clear();
    std::set<std::size_t> asked;
    one_by_one.image = [&](std::size_t n) {
        asked.insert(n);
        return floats.images[n];
    };
    expect_same(parse(one_by_one, quick()).scene, expected);
    EXPECT_EQ(asked.size(), 6u);
}

TEST_F(FramesViews, ASingleOneNeedsNoPose) {
    FramesView one = view();
    one.images.resize(1);
    one.camera_to_world.clear();
    const Scene scene = parse(one, quick()).scene;
    EXPECT_FALSE(scene.objects.empty());
    EXPECT_TRUE(noted(scene, "A single frame"));
}

TEST_F(FramesViews, EndWhereTheyAreCancelledOrWouldTakeTooMuch) {
    ParseOptions options = quick();
    std::vector<std::string> stages;
    options.progress = [&](const std::string& stage, double) {
        if (stages.empty() || stages.back() != stage) stages.push_back(stage);
    };
    int polls = 0;
    options.cancelled = [&] { return ++polls > 4; };
    message_of([&] { parse(view(), options); }, ErrorKind::cancelled);
    EXPECT_EQ(stages, std::vector<std::string>{"ingest"});
    // Before they are fused, while they are, and once they are.
    for (const auto& [bytes, text] :
         {std::pair{1u << 20, "frames: to fuse 6 depth frames takes at least"},
          {63'000'000u,
           "than the 60.1 MiB of max_memory_bytes (--max-memory); allow more, or give"},
          {270u << 20, " of max_memory_bytes (--max-memory): allow that much, or use a larger"}}) {
        options = quick();
        options.max_memory_bytes = bytes;
        EXPECT_THAT(message_of([&] { parse(view(), options); }, ErrorKind::input),
                    testing::HasSubstr(text));
    }
    options = quick();
    options.unit_m = 0.001;
    EXPECT_THROW(parse(view(), options), Error);
    options = quick();
    options.tile_m = 5;
    EXPECT_THROW(parse(view(), options), Error);
}

TEST_F(FramesViews, WhatTheCallersFunctionsThrowComesOutUnchanged) {
    struct Mine {};
    ParseOptions telling = quick(), asking = quick();
    telling.progress = [](const std::string&, double) { throw Mine(); };
    asking.cancelled = []() -> bool { throw Mine(); };
    EXPECT_THROW(parse(view(), telling), Mine);
    EXPECT_THROW(parse(view(), asking), Mine);
    FramesView frames = view();
    frames.images.clear();
    frames.image = [](std::size_t) -> FrameView { throw std::bad_alloc(); };
    telling.progress = nullptr;  // on the device that was in use
    EXPECT_THROW(parse(frames, telling), std::bad_alloc);
}

TEST_F(FramesViews, ThatMakeNoSenseAreRefused) {
    FramesView wrong;
    const auto refused = [&](const char* says, ErrorKind kind = ErrorKind::input) {
        EXPECT_THAT(message_of([&] { parse(wrong, quick()); }, kind), testing::HasSubstr(says));
        wrong = view();
    };
    refused("frames: there are none: images is empty");
    const std::uint16_t* depth = walk_->frames[2].depth.data();
    wrong.source = "head";
    wrong.images[2].depth = {depth, 72, 96};
    refused("head: frame 2: depth is 72 x 96 pixels, but the intrinsics say 96 x 72");
    wrong.images[2].depth = {nullptr, 96, 72};
    refused("frame 2: depth is a null pointer");
    wrong.images[2].depth = {depth, 96, 72, 96};
    refused("frame 2: depth: its rows lie 96 bytes apart, but each takes 192");
    wrong.images[2].depth = {depth, 96, 72, std::numeric_limits<std::ptrdiff_t>::max()};
    refused("bytes apart");
    wrong.images[2] = {};
    refused("frame 2: neither of depth and depth_m given; give one of both");
    const std::vector<float> millimetres(96 * 72, 1500.0f);
    wrong.images[1] = {{}, {millimetres.data(), 96, 72}, {}};
    refused("frame 1: all readings of depth_m lie beyond 65.535 m, the farthest at a depth_scale");
    const std::vector<std::uint16_t> none(96 * 72);
    for (FrameView& image : wrong.images) image.depth = {none.data(), 96, 72};
    refused("no points were found; 6 depth frames without any reading");
    wrong.images[5].colour = {pictures_[5].data(), 144, 192};
    refused("frame 5: colour is 144 x 192 pixels, but the depth images are 96 x 72");
    wrong.camera_to_world[4][3] = std::numeric_limits<double>::quiet_NaN();
    refused("frame 4: camera_to_world: nan is not a finite number");
    for (std::size_t k = 0; k < 3; ++k) wrong.camera_to_world[0][4 * k] *= -1;
    refused("frame 0: camera_to_world: the matrix is no rotation");
    for (Mat4& pose : wrong.camera_to_world)
        for (std::size_t axis = 0; axis < 3; ++axis) pose[4 * axis + 3] *= 1000;
    refused("places of poses are metres; if these are mm, multiply them by 0.001");
    wrong.intrinsics.depth_scale = 1;
    refused("at the depth_scale of the intrinsics, 1, the readings of 6 depth frames lie about");
    wrong.camera_to_world[3][15] = 0;
    refused("the last row");
    wrong.camera_to_world[3][3] = 2e6;
    refused("frame 3: camera_to_world: position 2e+06");
    wrong.camera_to_world.pop_back();
    refused("there are 5 poses for 6 images");
    wrong.camera_to_world.clear();
    refused("6 images but no poses");
    wrong.image = [](std::size_t) { return FrameView{}; };
    refused("give one of both", ErrorKind::usage);
    for (const auto& [member, value] : {std::pair{&Intrinsics::fx, 0.0},
                                        {&Intrinsics::fy, std::nan("")},
                                        {&Intrinsics::cx, 1e4},
                                        {&Intrinsics::cy, -1.0},
                                        {&Intrinsics::depth_scale, 0.0}}) {
        wrong.intrinsics.*member = value;
        refused("frames: intrinsics: ");
        if (member == &Intrinsics::depth_scale) continue;
        wrong.colour_intrinsics = wrong.intrinsics;
        (*wrong.colour_intrinsics).*member = value;
        refused("frames: colour_intrinsics: ");
    }
    wrong.intrinsics.width = 0;
    refused("\"width\" is 0");
    wrong.intrinsics.width = wrong.intrinsics.height = 30000;
    refused("30000 x 30000 pixels, more than");
}

}  // namespace
}  // namespace topple::test

// SPDX-License-Identifier: MIT
#include "points/formats/frame_sequence.h"

#include <cmath>

#include "depth_image.h"
#include "files.h"

namespace topple::io {
namespace {

using test::depth_png;
using test::expect_input_error;

constexpr const char* good_intrinsics =
    R"({"width": 5, "height": 3, "fx": 4.5, "fy": 4.25, "cx": 2, "cy": 1, "depth_scale": 1000})";

class Sequence : public test::Files {
  protected:
    // Frame i is named so that the order of writing is not the order of names.
    void make(int frames, const std::string& trajectory) {
        for (int i = frames - 1; i >= 0; --i) {
            write("depth/000" + std::to_string(i) + ".png",
                  depth_png(5, 3, std::uint16_t(1000 * (i + 1))));
        }
        write("intrinsics.json", good_intrinsics);
        if (!trajectory.empty()) write("trajectory.txt", trajectory);
    }
};

TEST_F(Sequence, frames_in_order_of_name_with_their_poses) {
    make(2,
         "# t x y z qx qy qz qw\n0.0 1 2 3 0 0 0 1\n\n0.1 4 5 6 0 0 2 2 # turned by 90 degrees\n");
    write("depth/._0000.png", "left by another system");
    write("depth/readme.txt", "not an image");
    EXPECT_TRUE(looks_like_sequence(folder_));
    const auto sequence = FrameSequence::open(folder_);
    EXPECT_TRUE(sequence.posed());
    ASSERT_EQ(sequence.size(), 2u);
    EXPECT_EQ(sequence.intrinsics().fx, 4.5);
    EXPECT_EQ(sequence.intrinsics().depth_scale, 1000);
    const auto first = sequence.load(0), second = sequence.load(1);
    ASSERT_EQ(first.depth.size(), 15u);
    for (std::size_t i = 0; i < 15; ++i) {
        EXPECT_EQ(first.depth[i], 1000 + i);
        EXPECT_EQ(second.depth[i], 2000 + i);
    }
    EXPECT_EQ(first.camera_to_world, (Mat4{1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1}));
    const Mat4 turned{0, -1, 0, 4, 1, 0, 0, 5, 0, 0, 1, 6, 0, 0, 0, 1};
    for (std::size_t i = 0; i < 16; ++i)
        EXPECT_NEAR(second.camera_to_world[i], turned[i], 1e-15) << i;
    // -y of the first camera is (0, -1, 0), of the second (1, 0, 0).
    const auto up = sequence.mean_camera_up();
    ASSERT_TRUE(up);
    EXPECT_NEAR((*up)[0], std::sqrt(0.5), 1e-12);
    EXPECT_NEAR((*up)[1], -std::sqrt(0.5), 1e-12);
}

TEST_F(Sequence, rotations_are_rotations_whatever_the_quaternion) {
    const auto poses =
        read_trajectory(write("t.txt", "0 0 0 0 0.1 -0.7 0.3 0.9\n1 0 0 0 -1e-3 2e-3 5e-3 1e-3\n"));
    ASSERT_EQ(poses.size(), 2u);
    for (const auto& m : poses) {
        for (std::size_t a = 0; a < 3; ++a) {
            for (std::size_t b = 0; b < 3; ++b) {
                const double dot =
                    m[a * 4] * m[b * 4] + m[a * 4 + 1] * m[b * 4 + 1] + m[a * 4 + 2] * m[b * 4 + 2];
                EXPECT_NEAR(dot, a == b ? 1 : 0, 1e-12);
            }
        }
    }
}

TEST_F(Sequence, one_image_needs_no_trajectory) {
    make(1, "");
    const auto sequence = FrameSequence::open(folder_);
    EXPECT_FALSE(sequence.posed());
    EXPECT_EQ(sequence.load(0).camera_to_world, DepthFrame{}.camera_to_world);
    EXPECT_EQ(*sequence.mean_camera_up(), (Vec3{0, -1, 0}));
}

TEST_F(Sequence, cameras_that_look_every_way_up_give_no_up) {
    make(2, "0 0 0 0 0 0 0 1\n0 0 0 0 1 0 0 0\n");
    EXPECT_FALSE(FrameSequence::open(folder_).mean_camera_up());
}

TEST_F(Sequence, interlaced_images) {
    const auto file = write("a.png", depth_png(19, 17, 300, PNG_INTERLACE_ADAM7));
    const auto depth = read_depth_png(file, 19, 17);
    for (std::size_t i = 0; i < depth.size(); ++i) EXPECT_EQ(depth[i], 300 + i);
}

TEST_F(Sequence, incomplete_folders) {
    EXPECT_FALSE(looks_like_sequence(folder_));
    EXPECT_FALSE(looks_like_sequence(path("missing")));
    expect_input_error([&] { FrameSequence::open(folder_); },
                       {"no folder depth/", "intrinsics.json"});
    std::filesystem::create_directory(path("depth"));
    EXPECT_TRUE(looks_like_sequence(folder_));
    expect_input_error([&] { FrameSequence::open(folder_); }, {"no .png"});
    write("depth/0.png", depth_png(5, 3, 0));
    expect_input_error([&] { FrameSequence::open(folder_); },
                       {"no intrinsics.json", "depth_scale"});
    write("intrinsics.json", good_intrinsics);
    write("depth/1.png", depth_png(5, 3, 0));
    expect_input_error([&] { FrameSequence::open(folder_); },
                       {"2 depth images", "no trajectory.txt", "add one"});
}

TEST_F(Sequence, bad_intrinsics) {
    const auto with = [](const std::string& key, const std::string& value) {
        std::string text = good_intrinsics;
        const auto at = text.find("\"" + key + "\": ");
        const auto end = text.find_first_of(",}", at);
        return text.replace(at, end - at, "\"" + key + "\": " + value);
    };
    const struct {
        std::string text;
        std::initializer_list<std::string_view> message;
    } cases[] = {
        {"{\"width\": ", {"is no JSON"}},
        {"[1, 2]", {"JSON object", "array"}},
        {"{}", {"no \"width\""}},
        {"{\"width\": 5, \"width\n\": \xff}", {"is no JSON"}},
        {with("width", "\"5\""), {"\"width\"", "number", "string"}},
        {with("width", "0"), {"\"width\" is 0"}},
        {with("height", "2.5"), {"\"height\" is 2.5", "whole"}},
        {with("height", "1e12"), {"\"height\" is 1e+12", "32768"}},
        {R"({"width": 30000, "height": 30000, "fx": 1, "fy": 1, "cx": 1, "cy": 1,
             "depth_scale": 1000})",
         {"30000 x 30000 pixels", "16777216"}},
        {with("fx", "-1"), {"\"fx\" is -1", "above 0"}},
        {with("fy", "null"), {"\"fy\"", "null"}},
        {with("fy", "1e999"), {"intrinsics.json"}},
        {with("cx", "7"), {"(7, 1)", "outside"}},
        {with("cy", "-1"), {"\"cy\" is -1"}},
        {with("depth_scale", "0"), {"\"depth_scale\" is 0"}},
        {with("depth_scale", "1e-5"), {"\"depth_scale\" is 1e-05"}},
        {R"({"width": 5, "height": 3, "fx": 4, "fy": 4, "cx": 2, "cy": 1})",
         {"no \"depth_scale\"", "1000"}},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.text);
        const auto file = write("intrinsics.json", c.text);
        expect_input_error([&] { read_intrinsics(file); }, c.message);
    }
    expect_input_error([&] { read_intrinsics(write("i.json", std::string(200000, '['))); },
                       {"nested", "damaged"});
}

TEST_F(Sequence, bad_trajectories) {
    const struct {
        const char* text;
        std::initializer_list<std::string_view> message;
    } cases[] = {
        {"0 0 0 0 0 0 0 1\n", {"1 pose", "2 depth images"}},
        {"0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n", {"3 poses", "2 depth images"}},
        {"# none\n", {"0 poses"}},
        {"0 0 0 0 0 0 0 1\n1 0 0 0 0 0 1\n", {"line 2", "7 of the 8 numbers"}},
        {"0 0 0 0 0 0 0 1 9\n1 0 0 0 0 0 0 1\n", {"line 1", "9 numbers"}},
        {"0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1 9\n", {"line 2", "more than the 8"}},
        {"0 0 0 0 0 0 0 0\n1 0 0 0 0 0 0 1\n", {"line 1", "quaternion", "length 0"}},
        {"0 0 nan 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", {"line 1", "\"nan\"", "finite"}},
        {"0 0 x 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", {"line 1", "\"x\""}},
        {"0 0 0 0 1e200 1e200 1e200 1e308\n0 0 1e9 0 0 0 0 1\n", {"line 2", "1e+09"}},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.text);
        make(2, c.text);
        expect_input_error([&] { FrameSequence::open(folder_); }, c.message);
    }
    expect_input_error([&] { read_trajectory(write("t.txt", "")); }, {"t.txt", "empty"});
}

TEST_F(Sequence, bad_images) {
    make(1, "");
    const auto sequence = FrameSequence::open(folder_);
    const auto good = depth_png(5, 3, 7);
    auto damaged = good;
    damaged[good.size() / 2] ^= 0x55;
    const struct {
        const char* what;
        std::string bytes;
        std::initializer_list<std::string_view> message;
    } cases[] = {
        {"no PNG", "not a png at all", {"0000.png", "no PNG", "16-bit grey"}},
        {"empty", "", {"0000.png", "empty"}},
        {"wrong size", depth_png(6, 3, 0), {"6 x 3", "5 x 3"}},
        {"8 bit",
         test::png_bytes(5, 3, 8, PNG_COLOR_TYPE_GRAY, std::vector<std::uint8_t>(15)),
         {"8-bit grey"}},
        {"colour",
         test::png_bytes(5, 3, 16, PNG_COLOR_TYPE_RGB, std::vector<std::uint8_t>(90)),
         {"16-bit colour"}},
        {"palette",
         test::png_bytes(5, 3, 8, PNG_COLOR_TYPE_PALETTE, std::vector<std::uint8_t>(15)),
         {"palette"}},
        {"alpha",
         test::png_bytes(5, 3, 16, PNG_COLOR_TYPE_GRAY_ALPHA, std::vector<std::uint8_t>(60)),
         {"alpha"}},
        {"damaged", damaged, {"0000.png", "damaged PNG"}},
        {"cut short", good.substr(0, good.size() - 20), {"0000.png", "cut short"}},
        {"signature only", good.substr(0, 8), {"0000.png", "cut short"}},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.what);
        write("depth/0000.png", c.bytes);
        expect_input_error([&] { sequence.load(0); }, c.message);
    }
    write("depth/0000.png", good);
    EXPECT_EQ(sequence.load(0).depth[14], 21);
    EXPECT_THROW(sequence.load(1), std::out_of_range);
}

}  // namespace
}  // namespace topple::io

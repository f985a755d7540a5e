// SPDX-License-Identifier: MIT
#include "points/formats/frame_sequence.h"

#include "depth_image.h"
#include "files.h"

namespace topple::io {
namespace {

using test::depth_png;
using test::expect_input_error;

constexpr const char* good_intrinsics =
    R"({"width": 5, "height": 3, "fx": 4.5, "fy": 4.25, "cx": 2, "cy": 1, "depth_scale": 1000})";

// Turned by 90 degrees about z, then moved: the same camera in the three formats.
const Mat4 turned_pose{0, -1, 0, 4, 1, 0, 0, 5, 0, 0, 1, 6, 0, 0, 0, 1};
const Mat4 level_pose{1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1};
constexpr const char* tum = "0 1 2 3 0 0 0 1\n0.1 4 5 6 0 0 2 2\n";
constexpr const char* kitti = "# KITTI\n1 0 0 1 0 1 0 2 0 0 1 3\n0 -1 0 4 1 0 0 5 0 0 1 6\n";
constexpr const char* log_backwards =
    "1 1 2\n0 -1 0 4\n1 0 0 5\n0 0 1 6\n0 0 0 1\n"
    "0 0 1\n1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n";

// Whether the first three rows and columns turn and do nothing else.
void expect_rotation(const Mat4& m) {
    for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b) {
            const double dot =
                m[a * 4] * m[b * 4] + m[a * 4 + 1] * m[b * 4 + 1] + m[a * 4 + 2] * m[b * 4 + 2];
            EXPECT_NEAR(dot, a == b ? 1 : 0, 1e-12);
        }
    }
}

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
         "# t x y z qx qy qz qw\n0.0 1 2 3 0 0 0 1\n\n0.1 4 5 6 0 0 2 2 # turned by 90 "
         "degrees\n");
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
    EXPECT_EQ(first.camera_to_world, level_pose);
    for (std::size_t i = 0; i < 16; ++i)
        EXPECT_NEAR(second.camera_to_world[i], turned_pose[i], 1e-15) << i;
    // -y of the first camera is (0, -1, 0), of the second (1, 0, 0).
    const auto up = sequence.mean_camera_up();
    ASSERT_TRUE(up);
    EXPECT_NEAR((*up)[0], std::sqrt(0.5), 1e-12);
    EXPECT_NEAR((*up)[1], -std::sqrt(0.5), 1e-12);
}

TEST_F(Sequence, rotations_are_rotations_whatever_was_written) {
    const auto poses =
        read_trajectory(write("t.txt", "0 0 0 0 0.1 -0.7 0.3 0.9\n1 0 0 0 -1e-3 2e-3 5e-3 1e-3\n"));
    ASSERT_EQ(poses.size(), 2u);
    for (const auto& pose : poses) expect_rotation(pose);
    // And where a matrix was rounded.
    const double c = std::cos(0.3), s = std::sin(0.3);
    char line[200];
    std::snprintf(line, sizeof(line), "%.4f %.4f 0 0 %.4f %.4f 0 0 0 0 1 0\n", c, -s, s, c);
    const auto rounded = read_trajectory(write("poses.txt", line));
    ASSERT_EQ(rounded.size(), 1u);
    EXPECT_NEAR(rounded[0][0], c, 1e-4);
    EXPECT_NEAR(rounded[0][4], s, 1e-4);
    expect_rotation(rounded[0]);
}

TEST_F(Sequence, formats_of_poses_are_told_apart_by_content_whatever_the_name) {
    make(2, "");
    for (const char* name : {"trajectory.txt", "trajectory.log", "poses.txt"}) {
        for (const char* text : {tum, kitti, log_backwards}) {
            SCOPED_TRACE(std::string(name) + "\n" + text);
            const auto file = write(name, text);
            const auto sequence = FrameSequence::open(folder_);
            EXPECT_TRUE(sequence.posed());
            ASSERT_EQ(sequence.size(), 2u);
            for (std::size_t i = 0; i < 16; ++i) {
                EXPECT_NEAR(sequence.poses()[0][i], level_pose[i], 1e-12) << i;
                EXPECT_NEAR(sequence.poses()[1][i], turned_pose[i], 1e-12) << i;
            }
            std::filesystem::remove(file);
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
    write("poses.txt", "1 0 0 1 0 1 0 2 0 0 1 3\n");
    expect_input_error([&] { FrameSequence::open(folder_); },
                       {"poses.txt", "1 pose", "2 depth images"});
    write("trajectory.log", log_backwards);
    expect_input_error([&] { FrameSequence::open(folder_); },
                       {"trajectory.log and poses.txt", "keep the one"});
}

TEST_F(Sequence, bad_intrinsics) {
    const auto with = [](const std::string& key, const std::string& value) {
        std::string text = good_intrinsics;
        const auto at = text.find("\"" + key + "\": ");
        const auto end = text.find_first_of(",}", at);
        return text.replace(at, end - at, "\"" + key + "\": " + value);
    };
    const test::BadFile cases[] = {
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
        {std::string(200000, '['), {"nested", "damaged"}},
    };
    expect_refused("intrinsics.json", cases, [](const auto& file) { read_intrinsics(file); });
}

TEST_F(Sequence, bad_trajectories) {
    const test::BadFile cases[] = {
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
    make(2, tum);
    expect_refused("trajectory.txt", cases, [&](const auto&) { FrameSequence::open(folder_); });
    const test::BadFile other_forms[] = {
        {"", {"empty"}},
        {"1 2 3 4 5\n", {"line 1", "5 numbers", "8", "12"}},
        {"1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1\n", {"line 2", "11 of the 12"}},
        {"1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 0 5\n", {"line 2", "more than the 12"}},
        {"1 0 0 nan 0 1 0 0 0 0 1 0\n", {"line 1", "\"nan\"", "finite"}},
        {"1 0 0 2e6 0 1 0 0 0 0 1 0\n", {"line 1", "2e+06", "metres"}},
        {"1.1 0 0 0 0 1 0 0 0 0 1 0\n", {"line 1", "no rotation", "0.21"}},
        {"1e308 0 0 0 0 1 0 0 0 0 1 0\n", {"line 1", "no rotation"}},
        {"1 0 0 0 0 1 0 0 0 0 -1 0\n", {"line 1", "no rotation", "determinant is -1"}},
        {"0 0 1\n1 0 0 1\n0 1 0 2\n0 0 1 3\n", {"line 1", "3 rows", "cut short"}},
        {"0 0 1\n1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 1 1\n", {"line 5", "0 0 0 1"}},
        {"0 0 1\n1 0 0 1\n0 1 0\n0 0 1 3\n0 0 0 1\n", {"line 3", "3 of the 4"}},
        {"-1 0 1\n1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n", {"line 1", "whole", "-1"}},
        {"7 0 1\n1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n", {"line 1", "image 7", "1 pose"}},
        {"0 0 1\n1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n0 0 1\n1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n",
         {"line 6", "image 0", "line 1"}},
    };
    expect_refused("poses.txt", other_forms, [](const auto& file) { read_trajectory(file); });
}

TEST_F(Sequence, bad_images) {
    make(1, "");
    const auto sequence = FrameSequence::open(folder_);
    const auto good = depth_png(5, 3, 7);
    auto damaged = good;
    damaged[good.size() / 2] ^= 0x55;
    const test::BadFile cases[] = {
        {"not a png at all", {"0000.png", "no PNG", "16-bit grey"}},
        {"", {"0000.png", "empty"}},
        {depth_png(6, 3, 0), {"6 x 3", "5 x 3"}},
        {test::png_bytes(5, 3, 8, PNG_COLOR_TYPE_GRAY, std::vector<std::uint8_t>(15)),
         {"8-bit grey"}},
        {test::png_bytes(5, 3, 16, PNG_COLOR_TYPE_RGB, std::vector<std::uint8_t>(90)),
         {"16-bit colour"}},
        {test::png_bytes(5, 3, 8, PNG_COLOR_TYPE_PALETTE, std::vector<std::uint8_t>(15)),
         {"palette"}},
        {test::png_bytes(5, 3, 16, PNG_COLOR_TYPE_GRAY_ALPHA, std::vector<std::uint8_t>(60)),
         {"alpha"}},
        {damaged, {"0000.png", "damaged PNG"}},
        {good.substr(0, good.size() - 20), {"0000.png", "cut short"}},
        {good.substr(0, 8), {"0000.png", "cut short"}},
    };
    expect_refused("depth/0000.png", cases, [&](const auto&) { sequence.load(0); });
    write("depth/0000.png", good);
    EXPECT_EQ(sequence.load(0).depth[14], 21);
    EXPECT_THROW(sequence.load(1), std::out_of_range);
}

}  // namespace
}  // namespace topple::io

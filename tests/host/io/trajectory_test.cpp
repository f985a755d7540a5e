// SPDX-License-Identifier: MIT
#include <cmath>

#include "depth_image.h"
#include "files.h"
#include "points/formats/frame_sequence.h"

namespace topple::io {
namespace {

using test::expect_input_error;

// Turned by 90 degrees about z, then moved: the same camera in the three formats.
const Mat4 turned{0, -1, 0, 4, 1, 0, 0, 5, 0, 0, 1, 6, 0, 0, 0, 1};
const Mat4 level{1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1};
constexpr const char* tum = "0 1 2 3 0 0 0 1\n0.1 4 5 6 0 0 2 2\n";
constexpr const char* kitti = "# KITTI\n1 0 0 1 0 1 0 2 0 0 1 3\n0 -1 0 4 1 0 0 5 0 0 1 6\n";
constexpr const char* log_backwards =
    "1 1 2\n0 -1 0 4\n1 0 0 5\n0 0 1 6\n0 0 0 1\n"
    "0 0 1\n1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n";

class Trajectory : public test::Files {
  protected:
    void make_images(int count) {
        for (int i = 0; i < count; ++i)
            write("depth/" + std::to_string(i) + ".png", test::depth_png(5, 3, 1000));
        write(
            "intrinsics.json",
            R"({"width": 5, "height": 3, "fx": 4, "fy": 4, "cx": 2, "cy": 1, "depth_scale": 1000})");
    }
};

TEST_F(Trajectory, formats_are_told_apart_by_content_whatever_the_name) {
    make_images(2);
    for (const char* name : {"trajectory.txt", "trajectory.log", "poses.txt"}) {
        for (const char* text : {tum, kitti, log_backwards}) {
            SCOPED_TRACE(std::string(name) + "\n" + text);
            const auto file = write(name, text);
            const auto sequence = FrameSequence::open(folder_);
            EXPECT_TRUE(sequence.posed());
            ASSERT_EQ(sequence.size(), 2u);
            for (std::size_t i = 0; i < 16; ++i) {
                EXPECT_NEAR(sequence.camera_to_world(0)[i], level[i], 1e-12) << i;
                EXPECT_NEAR(sequence.camera_to_world(1)[i], turned[i], 1e-12) << i;
            }
            std::filesystem::remove(file);
        }
    }
}

TEST_F(Trajectory, rounded_matrices_become_rotations) {
    const double c = std::cos(0.3), s = std::sin(0.3);
    char line[200];
    std::snprintf(line, sizeof(line), "%.4f %.4f 0 0 %.4f %.4f 0 0 0 0 1 0\n", c, -s, s, c);
    const auto poses = read_trajectory(write("poses.txt", line));
    ASSERT_EQ(poses.size(), 1u);
    const Mat4& m = poses[0];
    EXPECT_NEAR(m[0], c, 1e-4);
    EXPECT_NEAR(m[4], s, 1e-4);
    for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b) {
            const double dot =
                m[a * 4] * m[b * 4] + m[a * 4 + 1] * m[b * 4 + 1] + m[a * 4 + 2] * m[b * 4 + 2];
            EXPECT_NEAR(dot, a == b ? 1 : 0, 1e-12);
        }
    }
}

TEST_F(Trajectory, bad_files) {
    const struct {
        const char* text;
        std::initializer_list<std::string_view> message;
    } cases[] = {
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
    for (const auto& c : cases) {
        SCOPED_TRACE(c.text);
        expect_input_error([&] { read_trajectory(write("poses.txt", c.text)); }, c.message);
    }
}

TEST_F(Trajectory, counts_and_doubles) {
    make_images(3);
    write("poses.txt", kitti);
    expect_input_error([&] { FrameSequence::open(folder_); },
                       {"poses.txt", "2 poses", "3 depth images"});
    write("trajectory.log", log_backwards);
    expect_input_error([&] { FrameSequence::open(folder_); },
                       {"trajectory.log and poses.txt", "keep the one"});
}

}  // namespace
}  // namespace topple::io

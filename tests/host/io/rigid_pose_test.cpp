// SPDX-License-Identifier: MIT
#include "points/formats/rigid_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "topple/kernel_testing/random.h"

// A pose that was made rigid stays as it is, so that it may be done wherever poses come in.
namespace topple::io {
namespace {

Mat4 pose_of(const Eigen::Matrix3d& turn) {
    Mat4 out{};
    RowMajorPose pose(out.data());
    pose.setIdentity();
    pose.topLeftCorner<3, 3>() = turn;
    return out;
}

TEST(RigidPose, TwiceIsAsOnceBitForBit) {
    test::Random random(5);
    const auto number = [&] { return random.uniform(-1, 1); };
    for (int n = 0; n < 20000; ++n) {
        const Eigen::Quaterniond q(number(), number(), number(), number());
        const Eigen::Matrix3d turn = q.normalized().toRotationMatrix();
        // As quaternions of files come, to all digits.
        Mat4 given = pose_of(turn);
        const Mat4 before = given;
        ASSERT_FALSE(make_rigid(given));
        EXPECT_EQ(given, before);
        // As matrices come: to a number of digits.
        const double digits = std::pow(10.0, 4 + n % 12);
        Mat4 rounded = pose_of((turn * digits).array().round() / digits);
        ASSERT_FALSE(make_rigid(rounded));
        const Mat4 once = rounded;
        ASSERT_FALSE(make_rigid(rounded));
        ASSERT_EQ(rounded, once) << n;
        for (std::size_t k = 0; k < 12; ++k) EXPECT_NEAR(rounded[k], before[k], 2 / digits + 1e-14);
    }
}

}  // namespace
}  // namespace topple::io

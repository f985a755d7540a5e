// SPDX-License-Identifier: MIT
#include "topple/motion.h"

#include <cmath>
#include <numbers>
#include <span>

#include "files.h"
#include "motion_files.h"

namespace topple::io {
namespace {

class Motion : public test::Files {
  protected:
    void refused(const std::string& name, const std::string& text, std::string_view says,
                 const MotionFileOptions& options = {}) {
        const test::BadFile bad{text, {says}};
        expect_refused(name, std::span(&bad, 1),
                       [&](const auto& file) { read_motion(file, options); });
    }
};

TEST_F(Motion, BvhPlacesJointsByTheirChain) {
    const BodyMotion motion = read_motion(write("a.bvh", test::bvh(90, 0.01)));
    EXPECT_EQ(motion.frames(), 90u);
    EXPECT_DOUBLE_EQ(motion.step_s, 0.01);
    // The file is in centimetres and y up: hip 90 cm, knee 45 cm, ankle 5 cm below.
    ASSERT_FALSE(motion.of(BodyJoint::left_ankle).empty());
    const Vec3 hip = motion.of(BodyJoint::left_hip)[0], knee = motion.of(BodyJoint::left_knee)[0],
               ankle = motion.of(BodyJoint::left_ankle)[0];
    EXPECT_NEAR(hip[2] - knee[2], 0.45, 1e-12);
    // The knee is bent by 90 degrees in the last frame: the ankle is as high as the knee.
    EXPECT_NEAR(knee[2] - ankle[2], 0.40, 1e-12);
    const Vec3 last_knee = motion.of(BodyJoint::left_knee)[89],
               last_ankle = motion.of(BodyJoint::left_ankle)[89];
    EXPECT_NEAR(last_knee[2] - last_ankle[2], 0, 1e-9);
    EXPECT_NEAR(std::hypot(last_knee[0] - last_ankle[0], last_knee[1] - last_ankle[1]), 0.40, 1e-9);
    ASSERT_EQ(motion.notes.size(), 1u);
    EXPECT_THAT(motion.notes[0], testing::HasSubstr("centimetres"));
    EXPECT_NEAR(motion.stature_m(), 0.85 / 0.491, 1e-9);
}

TEST_F(Motion, TableOfNamedJoints) {
    std::string text =
        "time,ShoulderLeft.x,ShoulderLeft.y,ShoulderLeft.z,ElbowLeft.x,ElbowLeft.y,ElbowLeft.z,"
        "HandLeft.x,HandLeft.y,HandLeft.z,note\n";
    for (int f = 0; f < 40; ++f)
        text += std::to_string(f * 0.033) + ",0,0.2,1.4,0,0.2,1.1,0,0.2,0.83,1\n";
    const BodyMotion motion = read_motion(write("arm.csv", text));
    EXPECT_EQ(motion.frames(), 40u);
    EXPECT_NEAR(motion.step_s, 0.033, 1e-9);
    EXPECT_EQ(motion.of(BodyJoint::left_wrist)[0], (Vec3{0, 0.2, 0.83}));
    EXPECT_TRUE(motion.of(BodyJoint::left_fingers).empty());
    EXPECT_EQ(motion.notes.size(), 1u) << "that z was taken for up";
}

TEST_F(Motion, UnitsAreFoundOrCheckedByTheSizeOfTheBody) {
    const auto file = write("a.bvh", test::bvh(90, 0.01));
    MotionFileOptions options;
    options.unit_m = 0.01;
    EXPECT_NEAR(read_motion(file, options).stature_m(), 0.85 / 0.491, 1e-9);
    options.unit_m = 1;
    refused("a.bvh", test::bvh(90, 0.01), "173.12 m tall", options);
    // 0.0564 m to the unit: none that anyone uses, so that the body gets a usual size.
    const BodyMotion odd = read_motion(write("b.bvh", test::bvh(90, 0.01, 0.177)));
    EXPECT_NEAR(odd.stature_m(), 1.75, 1e-9);
    EXPECT_THAT(odd.notes.at(0), testing::HasSubstr("no usual unit"));
}

TEST_F(Motion, SaysWhatIsWrong) {
    const std::string good = test::bvh(90, 0.01);
    refused("a.bvh", test::bvh(90, 0.5), "0.5 s apart");
    refused("a.bvh", test::bvh(2, 0.01), "2 frames");
    refused("a.bvh", good.substr(0, good.size() - 20), "ends too early");
    auto many = good;
    many.replace(many.find("Frames: 90"), 10, "Frames: 900000000000");
    refused("a.bvh", many, "can't be");
    refused("a.csv", "0.1 0.2 0.3\n0.1 0.2 0.3\n", "first line must name");
    refused("a.csv", "time,a.x,a.y,a.z\n0,1,1,1\n0,1,1,1\n", "line 3: its time");
    refused("a.csv", "a.x,a.y,a.z\n1,1,1\n1,nan,1\n", "line 3: column 2");
    refused("a.csv", "a.x,a.y,a.z\n1,1,1\n1,1\n", "2 columns");
    std::string still = "l_hip.x l_hip.y l_hip.z\n";
    for (int f = 0; f < 99; ++f) still += "1 1 1\n";
    refused("a.csv", still, "MotionFileOptions::rate_hz");
    MotionFileOptions options;
    options.rate_hz = 100;
    refused("a.csv", still, "size of the body", options);
}

TEST_F(Motion, OptionsThatMakeNoSenseAreRefusedByName) {
    const auto file = write("a.bvh", test::bvh(90, 0.01));
    const auto wrong = [&](const MotionFileOptions& options) {
        return test::message_of([&] { read_motion(file, options); }, ErrorKind::usage);
    };
    EXPECT_EQ(wrong({0, {}, {}}), "MotionFileOptions::unit_m 0: expected a number above 0");
    EXPECT_EQ(wrong({{}, HUGE_VAL, {}}),
              "MotionFileOptions::rate_hz inf: expected a number above 0");
    EXPECT_EQ(wrong({{}, {}, Vec3{0, 0, 0}}),
              "MotionFileOptions::up: expected three numbers, not all zero");
}

}  // namespace
}  // namespace topple::io

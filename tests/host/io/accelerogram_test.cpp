// SPDX-License-Identifier: MIT
#include "files.h"
#include "motion_files.h"
#include "topple/input.h"
#include "topple/motion.h"

namespace topple {
namespace {

using test::expect_input_error;

class Accelerograms : public test::Files {
  protected:
    Accelerogram read(std::string_view bytes, std::optional<double> unit = {}) {
        return read_accelerogram(write("record", bytes), unit);
    }
    template <class Bad>
    void refused(const Bad& files) {
        expect_refused("record", files, [](const auto& file) { read_accelerogram(file); });
    }
};

TEST_F(Accelerograms, JsonAsSimulationToolsWriteIt) {
    const Accelerogram plain =
        read(R"({"name": "a", "numPoints": 3, "dT": 0.02, "accel_data": [0, -0.5, 0.25]})");
    EXPECT_EQ(plain.step_s, 0.02);
    EXPECT_EQ(plain.m_s2, (std::vector<double>{0, -0.5 * 9.80665, 0.25 * 9.80665}));
    EXPECT_DOUBLE_EQ(plain.peak_m_s2(), 0.5 * 9.80665);
    EXPECT_DOUBLE_EQ(plain.duration_s(), 0.04);
    ASSERT_EQ(plain.notes.size(), 1u);
    EXPECT_THAT(plain.notes[0], testing::HasSubstr("in g"));

    const Accelerogram nested = read(
        R"({"timeSeries": [{"dt": 0.01, "data": [1, 2], "factor": 2, "units": "m/s^2"}], "x": 1})");
    EXPECT_EQ(nested.m_s2, (std::vector<double>{2, 4}));
    EXPECT_TRUE(nested.notes.empty());
}

TEST_F(Accelerograms, ComponentsOfOneRecordBeginTogether) {
    const auto along = write("along", "# m/s2\n0 1\n0.01 2\n0.02 3\n");
    const auto across = write("across", "# m/s2\n0 4\n0.01 5\n");
    const auto up = write("up", "# m/s2\n0 6\n0.01 7\n0.02 8\n0.03 9\n");
    const auto slow = write("slow", "# m/s2\n0 6\n0.02 7\n");
    const Accelerogram record = read_accelerogram(along, across, up);
    EXPECT_EQ(record.m_s2, (std::vector<double>{1, 2, 3}));
    EXPECT_EQ(record.across_m_s2, (std::vector<double>{4, 5, 0})) << "shorter";
    EXPECT_EQ(record.up_m_s2, (std::vector<double>{6, 7, 8})) << "longer";
    EXPECT_DOUBLE_EQ(record.peak_m_s2(), std::sqrt(15.0));
    EXPECT_TRUE(read_accelerogram(along, {}, up).across_m_s2.empty());
    EXPECT_TRUE(read_accelerogram(along, std::nullopt, std::nullopt).up_m_s2.empty());
    EXPECT_EQ(read_accelerogram(along, across, {}, 0.5).across_m_s2[0], 2);
    expect_input_error([&] { read_accelerogram(along, {}, slow); },
                       {slow.native(), along.native(), "components of one record"});
}

TEST_F(Accelerograms, UnitsOfTheHeaderAndOfTheOption) {
    const std::string rows = "0 0.1\n0.01 -0.2\n0.02 0\n";
    for (const auto& [header, scale] :
         std::vector<std::pair<std::string, double>>{{"# time s, acceleration m/s^2\n", 1},
                                                     {"Time (sec), Acc. (cm/s2)\n", 0.01},
                                                     {"t_s\ta_g\n", 9.80665},
                                                     {"station X\n# units: gal\n", 0.01},
                                                     {"\xEF\xBB\xBF% [M/S2]\n", 1}}) {
        const Accelerogram record = read(header + rows);
        ASSERT_EQ(record.m_s2.size(), 3u) << header;
        EXPECT_DOUBLE_EQ(record.m_s2[1], -0.2 * scale) << header;
        EXPECT_NEAR(record.step_s, 0.01, 1e-15);
        EXPECT_TRUE(record.notes.empty());
        EXPECT_DOUBLE_EQ(read(header + rows, 0.5).m_s2[1], -0.1) << "the option wins";
    }
    EXPECT_EQ(read(rows).notes.size(), 1u);
    EXPECT_DOUBLE_EQ(read(rows).m_s2[0], 0.980665);
    refused(
        std::vector<test::BadFile>{{"# cm/s2, 1 g = 980.665 cm/s2\n" + rows,
                                    {"several units", "accelerogram_unit (--accelerogram-unit)"}}});
    EXPECT_EQ(read("# cm/s2, not g\n" + rows, 0.01).notes.size(), 0u);
}

TEST_F(Accelerograms, TextWithFewDigitsOrMoreColumns) {
    const Accelerogram coarse = read("0.00 1 9\n0.01,0.5,9\n0.01667;0;9\n0.03 0 9\r\n\n", 1.0);
    EXPECT_EQ(coarse.m_s2, (std::vector<double>{1, 0.5, 0, 0}));
    EXPECT_DOUBLE_EQ(coarse.step_s, 0.01);
}

TEST_F(Accelerograms, PeersRecordsInBothForms) {
    const Accelerogram now = read(
        "PEER NGA STRONG MOTION DATABASE RECORD\n"
        "Nowhere-01, 1/2/2003, Station #5, 140\n"
        "ACCELERATION TIME SERIES IN UNITS OF G\n"
        "NPTS=      7, DT=   .0050 SEC,\n"
        "  .1000000E-02  -.2000000E-02   .3000000E-02   0   .5\r\n"
        "  1.0E-01 -0.25\n");
    EXPECT_EQ(now.step_s, 0.005);
    ASSERT_EQ(now.m_s2.size(), 7u);
    EXPECT_DOUBLE_EQ(now.m_s2[1], -0.002 * 9.80665);
    EXPECT_DOUBLE_EQ(now.m_s2[6], -0.25 * 9.80665);
    EXPECT_TRUE(now.notes.empty());
    const Accelerogram before = read(
        "PACIFIC ENGINEERING AND ANALYSIS STRONG-MOTION DATA\n"
        "NOWHERE 01/02/03, STATION, 140\n"
        "ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=40.0 Hz\n"
        "    3    0.0100    NPTS, DT\n"
        " 0.1 0.2\n 0.3\n");
    EXPECT_EQ(before.step_s, 0.01);
    EXPECT_DOUBLE_EQ(before.m_s2[2], 0.3 * 9.80665);
    EXPECT_DOUBLE_EQ(read("NPTS=2, DT=.01\n1 2\n", 1.0).m_s2[1], 2) << "the option's unit";
    EXPECT_EQ(read("NPTS=2, DT=.01\n1 2\n").notes.size(), 1u) << "no unit";

    const test::BadFile cases[] = {
        {"IN UNITS OF G\nNPTS= 3, DT= .01\n0.1 0.2\n", {"NPTS 3", "2 samples", "cut short"}},
        {"IN UNITS OF G\nNPTS= 1, DT= .01\n0.1 0.2\n", {"line 3", "more samples", "1"}},
        {"IN UNITS OF G\nNPTS= 2, DT= .01\n0.1 x\n", {"line 3", "\"x\"", "not a number"}},
        {"IN UNITS OF G\nNPTS= 2, DT= .01\n0.1 inf\n", {"line 3", "finite"}},
        {"IN UNITS OF G\nNPTS= -2, DT= .01\n", {"line 2", "NPTS is -2"}},
        {"IN UNITS OF G\nNPTS= 1e30, DT= .01\n1\n", {"NPTS is 1e+30"}},
        {"IN UNITS OF G\nNPTS= 2, DT= 5\n1 2\n", {"5 s apart"}},
        {"IN UNITS OF CM/S2\nIN UNITS OF G\nNPTS= 2, DT= .01\n1 2\n", {"several units"}},
    };
    refused(cases);
}

TEST_F(Accelerograms, FaultsAreNamedWithTheirPlaceAndMend) {
    std::string endless = "{\"dT\": 0.5, \"accel_data\": [1";
    for (int n = 0; n < 7300; ++n) endless += ",0";
    const test::BadFile cases[] = {
        {"", {"empty"}},
        {"hello\n", {"0 samples"}},
        {"0 0.1\n", {"1 sample", "2"}},
        {"0 0.1\n0.01 nan\n", {"line 2", "nan", "finite"}},
        {"0 0.1\n0.01 x\n", {"line 2", "\"x\""}},
        {"0 0.1\n\n0.01\n", {"line 3", "one value"}},
        {"0 0.1\n0.02 0.1\n0.02 0.3\n", {"line 3", "0.02", "rise"}},
        {"0 0.1\n0.01 0.1\n0.02 0.3\n0.09 0.1\n0.1 0\n", {"line 4", "0.09", "0.07 s", "equally"}},
        {"0 0\n0.01 0\n", {"no acceleration"}},
        {"0 0.1\n10 0\n", {"10 s apart", "0.5 s", "seconds"}},
        {"# gal\n0 20000\n0.01 0\n",
         {"20.39", "limit of 10 g", "accelerogram_unit (--accelerogram-unit)"}},
        {"0 3.13\n0.01 0\n", {"3.13 g", "no unit", "limit of 3 g", "m/s2"}},
        {std::string("0 1\0 1", 6), {"neither JSON nor text"}},
        {"{\"dT\": 0.1", {"no JSON"}},
        {"[1, 2]", {"object", "array"}},
        {R"({"accel_data": [1, 2]})", {"no \"dT\"", "seconds"}},
        {R"({"dT": "x", "accel_data": [1, 2]})", {"\"dT\"", "number", "string"}},
        {R"({"dT": 0.1})", {"no \"accel_data\"", "list"}},
        {R"({"dT": 0.1, "accel_data": 3})", {"\"accel_data\"", "list", "number"}},
        {R"({"dT": 0.1, "accel_data": [1, null]})", {"\"accel_data\"[1]", "null"}},
        {R"({"dT": 0, "accel_data": [1, 2]})", {"0 s apart"}},
        {R"({"dT": -0.1, "accel_data": [1, 2]})", {"-0.1 s apart"}},
        {R"({"dT": 0.1, "numPoints": 3, "accel_data": [1, 2]})", {"3", "2 numbers"}},
        {R"({"dT": 0.1, "accel_data": [1, 2], "unit": "ft"})", {"\"ft\"", "m/s^2"}},
        {R"({"timeSeries": [{}, {}]})", {"one record"}},
        {endless + "]}", {"3650 s", "3600 s"}},
    };
    refused(cases);
    EXPECT_EQ(read("0 3.13\n0.01 0\n", 1.0).m_s2[0], 3.13);
}

class HazardCurves : public test::Files {
  protected:
    HazardCurve hazard(std::string_view bytes) { return read_hazard_curve(write("hazard", bytes)); }
};

TEST_F(HazardCurves, OfLinesAndOfJson) {
    const std::vector<double> peaks{0.05, 0.2, 1}, rates{0.02, 0.002, 0.0001};
    for (const char* text :
         {"0.05 0.02\n0.2 0.002\n1 1e-4\n", "pga_g,per_year\n0.05,0.02\n0.2,0.002\n1,1e-4",
          "# site 7\nPGA rate\r\n0.05\t0.02\r\n\r\n0.2 0.002 # a note\r\n1 1e-4\r\n",
          R"({"per_year": [0.02, 0.002, 0.0001], "pga_g": [0.05, 0.2, 1], "site": "7"})"}) {
        const HazardCurve curve = hazard(text);
        EXPECT_EQ(curve.pga_g, peaks) << text;
        EXPECT_EQ(curve.per_year, rates) << text;
        EXPECT_FALSE(curve.fault());
    }
}

TEST_F(HazardCurves, WhatIsNone) {
    const test::BadFile cases[] = {
        {"0.05 0.02\n", {"at least 2"}},
        {"only words\n", {"at least 2"}},
        {"0.05 0.02\n0.2\n", {"line 2"}},
        {"0.05 0.02\nmore 3\n", {"line 2"}},
        {"0.2 0.02\n0.1 0.002\n", {"point 2", "rise"}},
        {"0.1 0.02\n0.2 0.03\n", {"point 2", "fall"}},
        {"0 0.02\n0.2 0.01\n", {"point 1", "above 0"}},
        {"0.1 0.02\n50 0.01\n", {"point 2", "10 g"}},
        {"0.1 nan\n0.2 0.01\n", {"point 1"}},
        {R"({"pga_g": [0.1, 0.2]})", {"per_year"}},
        {R"({"pga_g": [0.1, 0.2], "per_year": [0.1]})", {"2 peaks", "1 rate"}},
        {R"({"pga_g": [0.1, "0.2"], "per_year": [0.1, 0.01]})", {"pga_g", "string"}},
        {R"({"pga_g": [0.1)", {"line 1"}},
    };
    expect_refused("hazard", cases, [](const auto& file) { read_hazard_curve(file); });
    test::expect_input_error([] { read_hazard_curve("/no/such/file"); }, {"/no/such/file"});
}

}  // namespace
}  // namespace topple

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
    refused("a.csv", still, "motion_rate (--motion-rate)");
    MotionFileOptions options;
    options.rate_hz = 100;
    refused("a.csv", still, "size of the body", options);
}

TEST_F(Motion, OptionsThatMakeNoSenseAreRefusedByName) {
    const auto file = write("a.bvh", test::bvh(90, 0.01));
    const auto wrong = [&](const MotionFileOptions& options) {
        return test::message_of([&] { read_motion(file, options); }, ErrorKind::usage);
    };
    EXPECT_EQ(wrong({0, {}, {}}), "motion_unit (--motion-unit) 0: expected a number above 0");
    EXPECT_EQ(wrong({{}, HUGE_VAL, {}}),
              "motion_rate (--motion-rate) inf: expected a number above 0");
    EXPECT_EQ(wrong({{}, {}, Vec3{0, 0, 0}}),
              "motion_up (--motion-up): expected three numbers, not all zero");
}

}  // namespace
}  // namespace topple::io

// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "host/io/files.h"
#include "host/pipeline/scan.h"
#include "host/pipeline/small_room.h"
#include "scale/estimate.h"
#include "topple/frame_labels.h"
#include "topple/parse.h"

// Options that make no sense are told before anything is parsed, and doubtful ones with the result.
namespace topple::test {
namespace {

template <class Call>
std::string refusal_of(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        return error.what();
    }
    return "taken";
}

// `began`: what would show that a stage had begun.
template <class Input>
std::string refusal_before(const Input& input, ParseOptions options) {
    bool began = false;
    options.progress = [&](const std::string&, double) { began = true; };
    const std::string refused = refusal_of([&] { parse(input, options); });
    EXPECT_FALSE(began) << refused;
    return refused;
}

TEST(Options, AMotionThatIsNullIsRefused) {
    ParseOptions options;
    options.motions = {std::make_shared<BodyMotion>(), nullptr};
    EXPECT_EQ(refusal_before(SmallRoom::scattered().cloud, options),
              "ParseOptions::motions: number 1 is null; give what read_motion() returns, or leave "
              "it out");
}

TEST(Options, ADisturbanceThatIsGivenTwiceIsRefused) {
    ParseOptions options;
    options.disturbances = {"human", "wind", "human"};
    EXPECT_EQ(refusal_before(SmallRoom::scattered().cloud, options),
              "ParseOptions::disturbances: human is given twice; name each once");
    EXPECT_EQ(refusal_of([&] { check_options(options); }),
              "ParseOptions::disturbances: human is given twice; name each once");
}

TEST(Options, AnEmptyPathIsNamed) {
    const std::string expected =
        "the path of the input is empty; give that of a file, or of a folder of depth frames";
    EXPECT_EQ(refusal_before(std::filesystem::path(), {}), expected);
    EXPECT_EQ(refusal_of([] { estimate("", {}); }), expected);
    EXPECT_EQ(refusal_of([] { FrameLabeller(ParseResult{}).label(std::filesystem::path(), 0); }),
              expected);
}

TEST(Options, AResultOfNoParseIsRefused) {
    EXPECT_EQ(refusal_of([] { write_outputs(ParseResult{}, "out"); }),
              "write_outputs: the result was read from a folder, which has no voxel grids, or no "
              "parse returned it: "
              "parse the scan again, or copy that folder");
}

TEST(Options, WhatIsForFilesIsRefusedOfWhatIsInMemory) {
    ParseOptions options;
    options.work_folder = "work";
    const std::string expected =
        "work_folder work: only clouds in files are parsed in blocks, which are kept there, and "
        "the "
        "scan is in memory; leave it out";
    EXPECT_EQ(refusal_before(FramesView{}, options), expected);
    EXPECT_EQ(refusal_before(CloudView{}, options), expected);
}

// Once, and of what is reckoned with alone. A peak of 0.3 m/s^2 was meant in g, perhaps.
TEST(Options, APeakInAnotherUnitIsAskedAbout) {
    const SmallRoom room = SmallRoom::scattered();
    ParseOptions options = on(device::open_device("native"));
    options.walks = 10;
    const auto notes = [&](double pga_m_s2) {
        options.pga_m_s2 = pga_m_s2;
        return parse(room.cloud, options).scene.notes;
    };
    const auto asked = testing::HasSubstr("pga_m_s2");
    options.disturbances = {"wind"};
    EXPECT_THAT(notes(0.3), testing::Each(testing::Not(asked)));
    options.disturbances = {"earthquake"};
    const std::vector<std::string> weak = notes(0.3);
    ASSERT_FALSE(weak.empty());
    EXPECT_EQ(
        weak.front(),
        "ParseOptions::pga_m_s2 = 0.3 is 0.031 g (light shaking, intensity IV): for 0.3 g give "
        "ParseOptions::pga_m_s2 = 2.94.");
    EXPECT_THAT(std::vector(weak.begin() + 1, weak.end()), testing::Each(testing::Not(asked)));
    EXPECT_EQ(
        notes(30).front(),
        "ParseOptions::pga_m_s2 = 30 is 3.1 g (extreme shaking, intensity X or more), stronger "
        "than nearly all that were recorded; for 30 % of g give ParseOptions::pga_m_s2 = 2.94.");
    EXPECT_THAT(notes(3), testing::Each(testing::Not(asked)));
}

class OptionsOfFiles : public Files {};

TEST_F(OptionsOfFiles, APeakIsAskedAboutOfAFile) {
    const SmallRoom room = SmallRoom::scattered();
    std::string text;
    for (std::size_t i = 0; i < room.cloud.size(); ++i)
        text += std::to_string(room.cloud.x[i]) + " " + std::to_string(room.cloud.y[i]) + " " +
                std::to_string(room.cloud.z[i]) + "\n";
    ParseOptions options = on(device::open_device("native"));
    options.disturbances = {"earthquake"};
    options.pga_m_s2 = 0.3;
    const Scene scene = parse(write("room.xyz", text), options).scene;
    EXPECT_THAT(scene.notes.front(),
                testing::HasSubstr("for 0.3 g give ParseOptions::pga_m_s2 = 2.94."));
}

}  // namespace
}  // namespace topple::test

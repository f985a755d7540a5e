// SPDX-License-Identifier: MIT
#include "topple/option_names.h"

#include <gtest/gtest.h>

#include <array>

#include "core/pose_mends.h"

namespace topple {
namespace {

TEST(OptionNames, AreThoseOfEachInterface) {
    const struct {
        const char *message, *command_line, *c, *python;
    } cases[] = {
        {"ParseOptions::voxel_m -1: expected a number", "--voxel -1: expected a number",
         "voxel_m -1: expected a number", "voxel_m -1: expected a number"},
        {"use ParseOptions::voxel_m = 0.025 or larger", "use --voxel 0.025 or larger",
         "use voxel_m = 0.025 or larger", "use voxel_m=0.025 or larger"},
        {"say ParseOptions::unit_m = 0.001 or ParseOptions::unit_m = 0.0254.",
         "say --unit mm or --unit in.", "say unit_m = 0.001 or unit_m = 0.0254.",
         "say unit_m=0.001 or unit_m=0.0254."},
        {"(ParseOptions::unit_m = 0.0015)", "(--unit 0.0015)", "(unit_m = 0.0015)",
         "(unit_m=0.0015)"},
        {"say ParseOptions::isolate = false", "say --no-isolate", "say without_isolation = 1",
         "say isolate=False"},
        {"MotionFileOptions::unit_m 0, ParseOptions::up", "--motion-unit 0, --up",
         "MotionFileOptions::unit_m 0, up", "motion_unit 0, up"},
        {"acceleration_unit_m_s2() x", "--accelerogram-unit x", "acceleration_unit_m_s2() x",
         "accelerogram_unit x"},
        {"", "", "", ""},
    };
    for (const auto& c : cases) {
        EXPECT_EQ(in_words_of(Interface::command_line, c.message), c.command_line);
        EXPECT_EQ(in_words_of(Interface::c, c.message), c.c);
        EXPECT_EQ(in_words_of(Interface::python, c.message), c.python);
    }
}

TEST(OptionNames, LeaveOtherTextAsItIs) {
    for (const char* text : {"nowhere--up.ply: what is up", "MyParseOptions::up", "a = 1",
                             "ParseOptions::upper", "ParseOptions::", "unit_m = 0.001"}) {
        for (const Interface interface : {Interface::command_line, Interface::c, Interface::python})
            EXPECT_EQ(in_words_of(interface, text), text);
    }
}

// What is said of poses is what NumPy makes of them, which Python adds to each, whole.
TEST(OptionNames, PosesHaveNumPysFormInPythonAlone) {
    for (const auto& [words, numpy] : pose_mends::all) {
        const std::string said = std::string("write ").append(words).append(".");
        EXPECT_EQ(in_words_of(Interface::command_line, said), said);
        EXPECT_EQ(in_words_of(Interface::c, said), said);
        EXPECT_EQ(in_words_of(Interface::python, said),
                  std::string("write ").append(words).append(" (").append(numpy).append(")."));
    }
}

}  // namespace
}  // namespace topple

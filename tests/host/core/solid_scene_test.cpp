// SPDX-License-Identifier: MIT
#include "core/solid_scene.h"

#include "core/pose_mends.h"
#include "testing.h"
#include "topple/error.h"
#include "topple/option_names.h"

namespace topple {
namespace {

SolidCells cells_at(const std::vector<std::array<std::int32_t, 3>>& places,
                    std::int32_t primitive = 0) {
    SolidCells cells;
    cells.voxel_m = 0.02;
    for (const auto& [i, j, k] : places) {
        cells.i.push_back(i);
        cells.j.push_back(j);
        cells.k.push_back(k);
        cells.primitive.push_back(primitive);
        cells.basis.push_back(Basis::surface);
    }
    return cells;
}

TEST(SolidScene, HoldsCellsByColumnAndRolesByPrimitive) {
    const SolidScene scene(cells_at({{0, 0, 0}, {0, 0, 1}, {0, 2, 5}, {3, -1, 7}}),
                           {Role::floor, Role::none, Role::wall});
    EXPECT_EQ(scene.columns().at(0, 0), std::pair(std::size_t{0}, std::size_t{2}));
    EXPECT_EQ(scene.columns().at(3, -1), std::pair(std::size_t{3}, std::size_t{4}));
    EXPECT_EQ(scene.columns().at(1, 0).first, scene.columns().at(1, 0).second);
    EXPECT_EQ(scene.role(0), Role::floor);
    EXPECT_EQ(scene.role(-1), Role::none);
    EXPECT_EQ(scene.shell(), (std::vector<bool>{true, false, true}));
}

TEST(SolidScene, StraysAreShownButNoCells) {
    const SolidScene scene(cells_at({{0, 0, 0}, {5, 0, 0}}), {Role::none},
                           cells_at({{-900, 0, 0}, {2, 900, 0}, {900, 0, 0}}, -1));
    EXPECT_EQ(scene.cells().size(), 2u);
    const SolidCells all = scene.with_strays();
    EXPECT_EQ(all.i, (std::vector<std::int32_t>{-900, 0, 2, 5, 900}));
    EXPECT_EQ(all.primitive, (std::vector<std::int32_t>{-1, 0, -1, 0, -1}));
}

TEST(SolidScene, RefusesWhatIsNoScene) {
    EXPECT_THROW(SolidScene(cells_at({{0, 0, 1}, {0, 0, 0}}), {Role::none}), Error);
    EXPECT_THROW(SolidScene(cells_at({{0, 0, 0}, {0, 0, 0}}), {Role::none}), Error);
    EXPECT_THROW(SolidScene(cells_at({{0, 0, 0}}, 1), {Role::none}), Error);
    SolidCells short_of_one = cells_at({{0, 0, 0}});
    short_of_one.basis.clear();
    EXPECT_THROW(SolidScene(std::move(short_of_one), {Role::none}), Error);
}

// More votes are surer, and nothing is certain, nor as good as chance.
TEST(Basis, IsAProbability) {
    for (std::uint8_t b = 0; b < basis_count; ++b) {
        const double p = probability_solid(static_cast<Basis>(b));
        EXPECT_GT(p, 0.5);
        EXPECT_LT(p, 1.0);
    }
    EXPECT_GT(probability_solid(Basis::three_votes), probability_solid(Basis::two_votes));
}

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

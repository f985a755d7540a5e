// SPDX-License-Identifier: MIT
#include "topple/corrections.h"

#include "files.h"
#include "result/check_scene.h"

namespace topple {
namespace {

using Kind = Correction::Kind;

std::string file_of(const std::string& entries) {
    return R"({"schema": "topple.corrections/1", "corrections": [)" + entries + "]}";
}

class Corrections : public test::Files {
  protected:
    template <class Bad>
    void refused(const Bad& files) {
        expect_refused("corrections.json", files, [](const auto& file) { read_corrections(file); });
        for (const auto& bad : files)
            test::expect_input_error([&] { corrections_of(bad.bytes); }, bad.says);
    }
};

TEST_F(Corrections, OfEachKind) {
    const auto all = read_corrections(write("corrections.json", "\xEF\xBB\xBF" + file_of(R"(
        {"do": "one_thing", "at_m": [[1, 2, 3], [4.5, 0, -1e-1]]},
        {"do": "apart", "at_m": [[1, 2, 3]], "from_m": [[0, 0, 0], [1, 1, 1]]},
        {"do": "fixed", "at_m": [[1, 2, 3]], "said_by": "me", "was": "object 16"},
        {"do": "not_there", "at_m": [[1, 2, 3]]},
        {"do": "hollow", "at_m": [[1, 2, 3]], "wall_m": 0.02},
        {"do": "mass", "at_m": [[1, 2, 3]], "kg": 12},
        {"name": "K\u00fchlschrank", "at_m": [[1, 2, 3]], "do": "name"},
        {"do": "friction", "at_m": [[1, 2, 3]], "coefficient": 0.6})")));
    ASSERT_EQ(all.size(), 8u);
    for (std::size_t n = 0; n < all.size(); ++n) {
        EXPECT_EQ(all[n].kind, static_cast<Kind>(n));
        EXPECT_EQ(all[n].at_m.front(), (Vec3{1, 2, 3}));
    }
    EXPECT_EQ(all[0].at_m[1], (Vec3{4.5, 0, -0.1}));
    EXPECT_EQ(all[1].from_m.size(), 2u);
    EXPECT_EQ(all[4].wall_m, 0.02);
    EXPECT_EQ(all[5].mass_kg, 12);
    EXPECT_EQ(all[2].was, "object 16");
    EXPECT_EQ(all[6].name, "K\u00fchlschrank");
    EXPECT_EQ(all[7].coefficient, 0.6);
    EXPECT_FALSE(fault_of(all));
    EXPECT_TRUE(corrections_of(file_of("")).empty());
}

TEST_F(Corrections, FilesThatAreNone) {
    const std::string fixed = R"({"do": "fixed", "at_m": [[0, 0, 0]]})";
    std::string many = fixed;
    for (int n = 0; n < 1000; ++n) many += "," + fixed;
    const test::BadFile cases[] = {
        {"", {}},
        {"[]", {"schema", "topple.corrections/1"}},
        {"{", {"is no JSON"}},
        {R"({"corrections": []})", {"schema"}},
        {R"({"schema": "topple.scene/1", "corrections": []})", {"schema"}},
        {R"({"schema": 1, "corrections": []})", {"schema"}},
        {R"({"schema": "topple.corrections/1"})", {"no list \"corrections\""}},
        {R"({"schema": "topple.corrections/1", "corrections": {}})", {"no list"}},
        {std::string(200'000, '['), {"nested"}},
        {file_of(R"({"do": "fixed", "at_m": [[1e999, 0, 0]]})"), {}},
        {file_of(R"({"do": "fixed", "at_m": [[0, 0, 0]], "was": 16})"), {"was", "text is due"}},
        {file_of(R"({"do": "fixed", "at_m": [[0, 0, 0]], "was": "a\nb"})"),
         {"\"was\"", "control character"}},
        {file_of(many), {"1001", "limit of 1000"}},
    };
    refused(cases);
    test::expect_input_error([&] { read_corrections(write("huge", std::string(10'000'001, ' '))); },
                             {"huge"});
    test::expect_input_error([&] { read_corrections(path("none")); }, {"none"});
}

TEST_F(Corrections, EntriesThatSayNothing) {
    // What is done where, and more.
    const auto entry = [](const char* what, const char* at_m, const std::string& more = "") {
        return std::string(R"({"do": ")") + what + R"(", "at_m": )" + at_m + more + "}";
    };
    std::string spots = "[[0, 0, 0]";
    for (int n = 0; n < 100; ++n) spots += ", [0, 0, 0]";
    spots += "]";
    const char* one = "[[0, 0, 1]]";
    std::vector<test::BadFile> cases{
        {"7", {"number"}},
        {"{}", {"\"do\""}},
        {R"({"do": 3})", {"\"do\"", "text"}},
        {entry("glue", one), {"glue", "one_thing", "name"}},
        {R"({"do": "fixed"})", {"(fixed)", "no \"at_m\""}},
        {entry("fixed", "[[0, 0, 1e300]]"), {"spot 1", "1e+300"}},
        {entry("fixed", spots.c_str()), {"101", "limit of 100"}},
        {entry("one_thing", one), {"1 spot", "2 spots"}},
        {entry("apart", one), {"no \"from_m\""}},
        {entry("apart", one, R"(, "from_m": [])"), {"from_m", "0 spots"}},
        {entry("hollow", one), {"no \"wall_m\""}},
        {entry("hollow", one, R"(, "wall_m": "0.02")"), {"wall_m", "number"}},
        {entry("hollow", one, R"(, "wall_m": 0)"), {"wall_m", "above 0"}},
        {entry("mass", one, R"(, "kg": -1)"), {"kg", "-1"}},
        {entry("mass", one, R"(, "kg": 1e12)"), {"kg", "1e+06"}},
        {entry("friction", one), {"no \"coefficient\""}},
        {entry("friction", one, R"(, "coefficient": 0)"),
         {"coefficient", "above 0 and at most 10"}},
        {entry("name", one, R"(, "name": " ")"), {"name", "empty"}},
        {entry("name", one, R"(, "name": "a\nb")"), {"name", "control"}},
        {entry("name", one, R"(, "name": ")" + std::string(201, 'x') + "\""), {"name", "201"}},
    };
    for (const char* at_m : {"3", "[]", "[3]", "[[0, 0]]", "[[0, 0, 0, 0]]", "[[0, 0, \"1\"]]",
                             "[[0, 0, null]]", "{\"a\": [0, 0, 0]}"})
        cases.push_back({entry("fixed", at_m), {"(fixed)", "\"at_m\""}});
    for (auto& bad : cases) {
        bad.bytes = file_of(entry("fixed", "[[0, 0, 0]]") + ", " + bad.bytes);
        bad.says.push_back("correction 2");
    }
    refused(cases);
}

// Programs may say what no file can.
TEST(CorrectionsInMemory, AreCheckedToo) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Correction mass{Kind::mass, {{0, 0, 0}}, {}, 0, 1, ""};
    EXPECT_FALSE(fault_of({mass}));
    mass.mass_kg = nan;
    EXPECT_EQ(fault_of({mass}).value_or("").find("correction 1 (mass): mass_kg is nan kg"), 0u);
    const Correction fixed{Kind::fixed, {{0, nan, 0}}, {}, 0, 0, ""};
    EXPECT_NE(fault_of({fixed, fixed}).value_or("").find("correction 1 (fixed)"),
              std::string::npos);
    const Correction apart{Kind::apart, {{0, 0, 0}}, {}, 0, 0, ""};
    EXPECT_TRUE(fault_of({apart}));
}

}  // namespace
}  // namespace topple

namespace topple::io {
namespace {

TEST(CheckScene, BarriersAreOneForEachDirectionAndHeight) {
    Scene scene;
    scene.primitives.resize(1);
    scene.primitives[0].id = scene.primitives[0].object = 0;
    scene.objects.resize(1);
    scene.objects[0].id = 0;
    DirectedBarrier& barriers = scene.objects[0].barrier_by_direction;
    constexpr std::size_t directions = DirectedBarrier::directions;
    barriers.height_m = {0.1, 0.2};
    barriers.direction.resize(directions);
    barriers.push_J.resize(directions);
    barriers.blow_J.resize(2 * directions);
    barriers.blow_Ns.resize(2 * directions);
    EXPECT_NO_THROW(check_scene(scene, "scene.json")) << "what hangs has no pushes over an edge";
    barriers.push_N.resize(directions);
    barriers.push_error_N.resize(directions);
    EXPECT_NO_THROW(check_scene(scene, "scene.json"));
    barriers.push_N.pop_back();
    EXPECT_THROW(check_scene(scene, "scene.json"), Error);
    barriers.push_error_N.pop_back();
    EXPECT_THROW(check_scene(scene, "scene.json"), Error);
}

TEST(CheckScene, NamesTheField) {
    Scene scene;
    scene.manhattan_from_input[0] = NAN;
    EXPECT_THAT(test::message_of([&] { check_scene(scene, "scene.json"); }, std::nullopt),
                testing::HasSubstr("manhattan_from_input"));
}

}  // namespace
}  // namespace topple::io

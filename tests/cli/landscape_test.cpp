// SPDX-License-Identifier: MIT
#include <array>
#include <cctype>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "cli/program.h"

// The command that draws one object's landscapes.
namespace topple::test {
namespace {

using DrawLandscape = Program;

TEST_F(DrawLandscape, refuses_what_has_none) {
    expect_failure(2, {"landscape"}, {"OUT"});
    expect_failure(1, {"landscape", "nowhere"}, {"nowhere"});
    put("other/notes.txt", "");
    expect_failure(1, {"landscape", "other"}, {"other: holds no output of topple"});
    put("mine/scene.json", "{}");
    expect_failure(1, {"landscape", "mine"}, {"scene.json"});
    put_plane("plane.xyz");
    ASSERT_EQ(run({"parse", "plane.xyz", "-o", "out", "--quiet"}).code, 0);
    expect_failure(1, {"landscape", "out"}, {"no object that can move"});
    expect_failure(2, {"landscape", "out", "--object", "0"}, {"--object 0", "building"});
    expect_failure(2, {"landscape", "out", "--object", "99"}, {"--object 99"});
    expect_failure(2, {"landscape", "out", "--object", "-1"}, {"--object"});
    for (const char* name : {"one.jpg", "one", ".png", "one.PNG.txt"})
        expect_failure(2, {"landscape", "out", "-o", name}, {name, ".png or .svg"});
}

// What stands below the table is of the objects whose barrier the table doesn't give from 0, and
// says how many those are; each row says what its object rests on.
void expect_told_summary(const std::string& out) {
    std::istringstream lines(out);
    std::set<std::string> uncertain;
    std::size_t rows = 0, told = 0;
    for (std::string line; std::getline(lines, line);) {
        char id[16], barrier[16], carriers[64];
        char risk[16];  // by wind alone
        if (std::sscanf(line.c_str(), " %15[0-9] %*s %*f %*f %15s %*f %*s %15s %63s", id, barrier,
                        risk, carriers) == 4) {
            ++rows;
            EXPECT_TRUE(std::isdigit(risk[0]) || std::string(risk) == "-") << line;
            if (std::string(barrier).starts_with("0-")) uncertain.insert(id);
            EXPECT_TRUE(std::isdigit(carriers[0]) || std::string(carriers) == "-") << line;
        } else if (std::sscanf(line.c_str(), "Object %15[0-9], ", id) == 1) {
            ++told;
            EXPECT_FALSE(uncertain.contains(id)) << line;
        }
    }
    EXPECT_EQ(rows, 12u) << out;
    EXPECT_EQ(told, 3u) << out;
    EXPECT_FALSE(uncertain.empty()) << out;
    // By category the third comes before some with a risk, and has none itself.
    EXPECT_THAT(out, HasSubstr("\nThe first 3 to look at of the "));
    EXPECT_THAT(
        out,
        HasSubstr(" Nothing upsets it as measured; if its foot is one error smaller, it falls"));
    EXPECT_THAT(out, HasSubstr(" whose barrier is above its error; that of "));
}

// Of all files, the cache among them.
void expect_told_size(const std::string& estimate, const std::filesystem::path& out) {
    std::uintmax_t taken = 0;
    for (const auto& file : std::filesystem::directory_iterator(out)) taken += file.file_size();
    const double told = nlohmann::json::parse(estimate).at("output_bytes");
    EXPECT_GT(told, 0.8 * static_cast<double>(taken));
    EXPECT_LT(told, 1.25 * static_cast<double>(taken));
}

TEST_F(DrawLandscape, makes_pictures_of_the_worst_or_the_chosen_object) {
    ASSERT_EQ(run({"generate", "room", "--seed", "2", "--frames", "10"}).code, 0);
    const Finished parsed = run({"parse", "room", "-o", "out", "--voxel", "0.04", "--disturbance",
                                 "wind", "--backend", "native"});
    ASSERT_EQ(parsed.code, 0) << parsed.err;
    expect_told_summary(parsed.out);
    expect_told_size(
        run({"estimate", "room", "--voxel", "0.04", "--backend", "native", "--json"}).out,
        in("out"));
    const Finished worst = run({"landscape", "out"});
    ASSERT_EQ(worst.code, 0) << worst.err;
    EXPECT_THAT(worst.out, HasSubstr(".png"));
    EXPECT_THAT(worst.out, HasSubstr("Object "));
    const Finished chosen = run({"landscape", "out", "--object", "1", "-o", "one.svg"});
    ASSERT_EQ(chosen.code, 0) << chosen.err;
    const std::string svg = bytes_of_file(in("one.svg"));
    EXPECT_NE(svg.find("</svg>"), std::string::npos);
    std::size_t pictures = 0;
    for (const std::string& name : everything()) {
        if (name.find("object-") == std::string::npos) continue;
        ++pictures;
        EXPECT_TRUE(bytes_of_file(in(name)).starts_with("\x89PNG")) << name;
    }
    EXPECT_EQ(pictures, 1u);
    expect_failure(1, {"landscape", "out", "-o", "none/x.png"}, {"none: can't be written to"});
}

}  // namespace
}  // namespace topple::test

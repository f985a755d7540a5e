// SPDX-License-Identifier: MIT
#include <cctype>
#include <nlohmann/json.hpp>

#include "cli/program.h"

// Exports by the commands, and what `verify` makes of them.
namespace topple::test {
namespace {

class Exports : public Program {
  protected:
    // A crate on a floor, as a point cloud; and its parse.
    void put_crate(const std::string& name) const {
        std::string text;
        const auto add = [&](double x, double y, double z) {
            text += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
        };
        Random random(5);
        const auto noise = [&] { return 1e-6 * static_cast<double>(random.below(2000)); };
        constexpr int floor = 80, side = 20, high = 25;
        for (int i = 0; i < floor; ++i)
            for (int j = 0; j < floor; ++j)
                if (i <= 30 || i >= 50 || j <= 30 || j >= 50) add(0.02 * i, 0.02 * j, noise());
        for (int i = 0; i <= side; ++i) {
            const double along = 0.6 + 0.02 * i;
            for (int j = 0; j <= side; ++j) add(along, 0.6 + 0.02 * j, 0.5 + noise());
            for (int k = 1; k < high; ++k) {
                const double z = 0.02 * k;
                add(along, 0.6 - noise(), z);
                add(along, 1.0 + noise(), z);
                add(0.6 - noise(), along, z);
                add(1.0 + noise(), along, z);
            }
        }
        put(name, text);
    }
    nlohmann::json json_of(const std::string& name) const {
        return nlohmann::json::parse(bytes_of_file(in(name)));
    }
};

TEST_F(Exports, are_refused_where_there_is_nothing_to_export) {
    fails(2, "export nowhere", {"say what to write", "--mjcf"});
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"export", "nowhere", "--mjcf", "to"}, {"verify", "nowhere"}})
        expect_failure(1, command, {"nowhere: No such file"});
    put("other/notes.txt", "");
    fails(1, "export other --mjcf to", {"other: holds no output of topple"});
    fails(1, "verify other", {"other: holds no output of topple"});
    put("mine/scene.json", "{}");
    fails(1, "export mine --mjcf to", {"scene.json"});
    fails(1, "verify mine", {"scene.json"});
    fails(2, "verify mine --seconds 0", {"--seconds"});
    fails(2, "verify mine --seconds nan", {"--seconds"});
    fails(2, "verify mine --time-limit -1", {"--time-limit"});
}

TEST_F(Exports, are_checked_before_a_long_parse) {
    put_plane("plane.xyz");
    put("others/scene.xml", "<mujoco/>");
    fails(1, "parse plane.xyz -o out --mjcf others",
          {"others/scene.xml: exists and is no export of topple"});
    fails(2, "parse plane.xyz -o out --mjcf to --tile 5", {"--tile", "blocks"});
    expect_failure(2, {"parse", "plane.xyz", "-o", "out", "--mjcf", ""}, {"--mjcf"});
}

TEST_F(Exports, of_a_parse_and_of_its_output_are_the_same_and_stand) {
    put_crate("crate.xyz");
    const Finished parsed =
        succeeds("parse crate.xyz -o out --backend native --disturbance wind --mjcf direct");
    EXPECT_THAT(parsed.out, HasSubstr("1 free bodies"));
    const Finished exported = succeeds("export out --mjcf read");
    for (const char* name : {"scene.xml", "bodies.json"})
        EXPECT_EQ(bytes_of_file(in("direct") / name), bytes_of_file(in("read") / name));

    const Finished verified = succeeds("verify out --seconds 1");
    EXPECT_THAT(verified.out, HasSubstr(": 1 of 1 objects stay within 1 cm"));
    const auto verdict = json_of("out/verify.json");
    EXPECT_EQ(verdict.at("schema"), "topple.verify/1");
    EXPECT_EQ(verdict.at("objects").size(), 1u);
    EXPECT_TRUE(verdict.at("objects").at(0).at("stays").get<bool>());
    EXPECT_GE(verdict.at("simulated_s").get<double>(), 1);
    const std::string report = bytes_of_file(in("out/report.html"));
    EXPECT_NE(report.find("id=\"verified\">{"), std::string::npos);

    // Once more, over the first, as JSON.
    const Finished again = succeeds("verify out --seconds 0.1 --json");
    EXPECT_EQ(again.out, bytes_of_file(in("out/verify.json")));
    EXPECT_EQ(again.err, "");
    // What verify adds does not keep the next parse from replacing the folder.
    succeeds("parse crate.xyz -o out --quiet --disturbance wind");
    EXPECT_FALSE(std::filesystem::exists(in("out/verify.json")));

    put("others/scene.xml", "<mujoco/>");
    fails(1, "export out --mjcf others", {"others/scene.xml: exists and is no export of topple"});
    std::filesystem::resize_file(in("out/solids.bin"), 200);
    fails(1, "export out --mjcf to", {"solids.bin"});
    const Finished damaged = topple("verify out");
    EXPECT_EQ(damaged.code, 1);
    EXPECT_THAT(damaged.err, HasSubstr("topple: out/solids.bin: is damaged"));
    EXPECT_FALSE(std::filesystem::exists(in("out/verify.json")));
    std::filesystem::remove(in("out/solids.bin"));
    fails(1, "export out --mjcf to", {"solids.bin: is missing"});
}

TEST_F(Exports, are_not_verified_without_the_simulator) {
    put_crate("crate.xyz");
    succeeds("parse crate.xyz -o out --quiet --disturbance wind");
    ::setenv("TOPPLE_READERS", in("").c_str(), 1);
    const Finished finished = topple("verify out");
    ::unsetenv("TOPPLE_READERS");
    EXPECT_EQ(finished.code, 2);
    EXPECT_THAT(finished.err, HasSubstr("no program topple-mujoco"));
    // One that does not run, as where MuJoCo's library has gone.
    const std::filesystem::path broken = put("topple-mujoco", "#!/bin/sh\nexit 127\n");
    std::filesystem::permissions(broken, std::filesystem::perms::owner_all);
    ::setenv("TOPPLE_READERS", in("").c_str(), 1);
    const Finished crashed = topple("verify out");
    ::unsetenv("TOPPLE_READERS");
    EXPECT_EQ(crashed.code, 3);
    EXPECT_THAT(crashed.err, HasSubstr("exit code 127"));
    EXPECT_THAT(crashed.err, HasSubstr("apt-get install libmujoco-dev"));
}

// The command that draws one object's landscapes.

using DrawLandscape = Program;

TEST_F(DrawLandscape, refuses_what_has_none) {
    fails(2, "landscape", {"OUT"});
    fails(1, "landscape nowhere", {"nowhere"});
    put("other/notes.txt", "");
    fails(1, "landscape other", {"other: holds no output of topple"});
    put("mine/scene.json", "{}");
    fails(1, "landscape mine", {"scene.json"});
    put_plane("plane.xyz");
    succeeds("parse plane.xyz -o out --quiet");
    fails(1, "landscape out", {"no object that can move"});
    fails(2, "landscape out --object 0", {"--object 0", "building"});
    fails(2, "landscape out --object 99", {"--object 99"});
    fails(2, "landscape out --object -1", {"--object"});
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
    EXPECT_THAT(out, HasSubstr("\nThe 3 riskiest of the "));
    EXPECT_THAT(out, HasSubstr(" Its risk is below the 0.1 J per event that this run tolerates: "));
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
    succeeds("generate room --seed 2 --frames 10");
    const Finished parsed =
        succeeds("parse room -o out --voxel 0.04 --disturbance wind --backend native");
    expect_told_summary(parsed.out);
    expect_told_size(topple("estimate room --voxel 0.04 --backend native --json").out, in("out"));
    const Finished worst = succeeds("landscape out");
    EXPECT_THAT(worst.out, HasSubstr(".png"));
    EXPECT_THAT(worst.out, HasSubstr("Object "));
    const Finished chosen = succeeds("landscape out --object 1 -o one.svg");
    const std::string svg = bytes_of_file(in("one.svg"));
    EXPECT_NE(svg.find("</svg>"), std::string::npos);
    std::size_t pictures = 0;
    for (const std::string& name : everything()) {
        if (name.find("object-") == std::string::npos) continue;
        ++pictures;
        EXPECT_TRUE(bytes_of_file(in(name)).starts_with("\x89PNG")) << name;
    }
    EXPECT_EQ(pictures, 1u);
    fails(1, "landscape out -o none/x.png", {"none: can't be written to"});
}

}  // namespace
}  // namespace topple::test

// SPDX-License-Identifier: MIT
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
    expect_failure(2, {"export", "nowhere"}, {"say what to write", "--mjcf"});
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"export", "nowhere", "--mjcf", "to"}, {"verify", "nowhere"}})
        expect_failure(1, command, {"nowhere: No such file"});
    put("other/notes.txt", "");
    expect_failure(1, {"export", "other", "--mjcf", "to"}, {"other: holds no output of topple"});
    expect_failure(1, {"verify", "other"}, {"other: holds no output of topple"});
    put("mine/scene.json", "{}");
    expect_failure(1, {"export", "mine", "--mjcf", "to"}, {"scene.json"});
    expect_failure(1, {"verify", "mine"}, {"scene.json"});
    expect_failure(2, {"verify", "mine", "--seconds", "0"}, {"--seconds"});
    expect_failure(2, {"verify", "mine", "--seconds", "nan"}, {"--seconds"});
    expect_failure(2, {"verify", "mine", "--time-limit", "-1"}, {"--time-limit"});
}

TEST_F(Exports, are_checked_before_a_long_parse) {
    put_plane("plane.xyz");
    put("others/scene.xml", "<mujoco/>");
    expect_failure(1, {"parse", "plane.xyz", "-o", "out", "--mjcf", "others"},
                   {"others/scene.xml: exists and is no export of topple"});
    expect_failure(2, {"parse", "plane.xyz", "-o", "out", "--mjcf", "to", "--tile", "5"},
                   {"--tile", "blocks"});
    expect_failure(2, {"parse", "plane.xyz", "-o", "out", "--mjcf", ""}, {"--mjcf"});
}

TEST_F(Exports, of_a_parse_and_of_its_output_are_the_same_and_stand) {
    put_crate("crate.xyz");
    const Finished parsed = run({"parse", "crate.xyz", "-o", "out", "--backend", "native",
                                 "--disturbance", "wind", "--mjcf", "direct"});
    ASSERT_EQ(parsed.code, 0) << parsed.err;
    EXPECT_THAT(parsed.out, HasSubstr("1 free bodies"));
    const Finished exported = run({"export", "out", "--mjcf", "read"});
    ASSERT_EQ(exported.code, 0) << exported.err;
    for (const char* name : {"scene.xml", "bodies.json"})
        EXPECT_EQ(bytes_of_file(in("direct") / name), bytes_of_file(in("read") / name));

    const Finished verified = run({"verify", "out", "--seconds", "1"});
    ASSERT_EQ(verified.code, 0) << verified.err;
    EXPECT_THAT(verified.out, HasSubstr(": 1 of 1 objects stay within 1 cm"));
    const auto verdict = json_of("out/verify.json");
    EXPECT_EQ(verdict.at("schema"), "topple.verify/1");
    EXPECT_EQ(verdict.at("objects").size(), 1u);
    EXPECT_TRUE(verdict.at("objects").at(0).at("stays").get<bool>());
    EXPECT_GE(verdict.at("simulated_s").get<double>(), 1);
    const std::string report = bytes_of_file(in("out/report.html"));
    EXPECT_NE(report.find("id=\"verified\">{"), std::string::npos);

    // Once more, over the first, as JSON.
    const Finished again = run({"verify", "out", "--seconds", "0.1", "--json"});
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(again.out, bytes_of_file(in("out/verify.json")));
    EXPECT_EQ(again.err, "");
    // What verify adds does not keep the next parse from replacing the folder.
    EXPECT_EQ(run({"parse", "crate.xyz", "-o", "out", "--quiet", "--disturbance", "wind"}).code, 0);
    EXPECT_FALSE(std::filesystem::exists(in("out/verify.json")));

    put("others/scene.xml", "<mujoco/>");
    expect_failure(1, {"export", "out", "--mjcf", "others"},
                   {"others/scene.xml: exists and is no export of topple"});
    std::filesystem::resize_file(in("out/solids.bin"), 200);
    expect_failure(1, {"export", "out", "--mjcf", "to"}, {"solids.bin"});
    const Finished damaged = run({"verify", "out"});
    EXPECT_EQ(damaged.code, 1);
    EXPECT_THAT(damaged.err, HasSubstr("topple: out/solids.bin: is damaged"));
    EXPECT_FALSE(std::filesystem::exists(in("out/verify.json")));
    std::filesystem::remove(in("out/solids.bin"));
    expect_failure(1, {"export", "out", "--mjcf", "to"}, {"solids.bin: is missing"});
}

TEST_F(Exports, are_not_verified_without_the_simulator) {
    put_crate("crate.xyz");
    ASSERT_EQ(run({"parse", "crate.xyz", "-o", "out", "--quiet", "--disturbance", "wind"}).code, 0);
    ::setenv("TOPPLE_READERS", in("").c_str(), 1);
    const Finished finished = run({"verify", "out"});
    ::unsetenv("TOPPLE_READERS");
    EXPECT_EQ(finished.code, 2);
    EXPECT_THAT(finished.err, HasSubstr("no program topple-mujoco"));
    // One that does not run, as where MuJoCo's library has gone.
    const std::filesystem::path broken = put("topple-mujoco", "#!/bin/sh\nexit 127\n");
    std::filesystem::permissions(broken, std::filesystem::perms::owner_all);
    ::setenv("TOPPLE_READERS", in("").c_str(), 1);
    const Finished crashed = run({"verify", "out"});
    ::unsetenv("TOPPLE_READERS");
    EXPECT_EQ(crashed.code, 3);
    EXPECT_THAT(crashed.err, HasSubstr("exit code 127"));
    EXPECT_THAT(crashed.err, HasSubstr("apt-get install libmujoco-dev"));
}

}  // namespace
}  // namespace topple::test

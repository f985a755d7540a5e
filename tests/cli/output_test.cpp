// SPDX-License-Identifier: MIT
#include <sys/resource.h>

#include "cli/program.h"
#include "lab/rooms/furnished_room.h"
#include "lab/scan/depth_camera.h"

// Where results go, and what is left where there are none.
namespace topple::test {
namespace {

using Output = Program;

const std::set<std::string> whole_output{"out",
                                         "out/landscapes.json",
                                         "out/parse.cache",
                                         "out/points.ply",
                                         "out/report.html",
                                         "out/scene.json",
                                         "out/solid.ply",
                                         "out/solids.bin",
                                         "out/volume.vdb",
                                         "plane.xyz"};

// Not quiet: an output that can't be written is told before the parse begins.
TEST_F(Output, refused_before_the_parse) {
    put_plane("plane.xyz");
    put("file", "mine");
    fails(1, "parse plane.xyz -o file/out", {"file"});
    fails(1, "parse plane.xyz -o file", {"file", "no folder"});
    put("mine/notes.txt", "mine");
    fails(1, "parse plane.xyz -o mine", {"mine", "notes.txt"});
    expect_failure(2, {"parse", "plane.xyz", "-o", ""}, {"--output", "empty"});
    EXPECT_EQ(bytes_of_file(in("mine/notes.txt")), "mine");
    EXPECT_EQ(bytes_of_file(in("file")), "mine");
}

// The input would be gone with the earlier output.
TEST_F(Output, never_in_the_place_of_the_input) {
    put_plane("plane.xyz");
    succeeds("parse plane.xyz -o out --quiet");
    const std::string points = bytes_of_file(in("out/points.ply"));
    std::filesystem::create_symlink("out/points.ply", in("link.ply"));
    for (const char* input : {"out/points.ply", "./out/../out/points.ply", "link.ply", "out"})
        expect_failure(2, {"parse", input, "-o", "out"}, {"output folder out"});
    EXPECT_EQ(bytes_of_file(in("out/points.ply")), points);
}

// A signal would end the program without a word.
TEST_F(Output, beyond_the_limit_of_a_file) {
    put_plane("plane.xyz");
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    for (const rlim_t bytes : {1000u, 100'000u, 300'000u}) {
        const rlimit limit{bytes, before.rlim_max};
        ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
        fails(1, "parse plane.xyz -o out --quiet",
              {".topple-", "can't be written: File too large"});
        ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
    }
}

// Two runs give the same bytes: all but what holds their times.
TEST_F(Output, is_the_same_again) {
    put_plane("plane.xyz");
    for (const char* out : {"a", "b"})
        ASSERT_EQ(run({"parse", "plane.xyz", "-o", out, "--quiet", "--glb", "--octomap", "--fields",
                       "--threads", out[0] == 'a' ? "1" : "2"})
                      .code,
                  0);
    succeeds("parse plane.xyz -o a --quiet");  // over all of these
    EXPECT_FALSE(std::filesystem::exists(in("a/fields.vdb")));
    succeeds("parse plane.xyz -o a --quiet --glb --octomap --fields --threads 1");
    for (const std::string name : {"points.ply", "solid.ply", "volume.vdb", "objects.glb", "map.bt",
                                   "landscapes.json", "fields.vdb", "field-wind.png"})
        EXPECT_TRUE(bytes_of_file(in("a/" + name)) == bytes_of_file(in("b/" + name))) << name;
}

// 0.3 of m/s^2 that was meant in g would make a room look safe, and 30 of hundredths of g unsafe.
TEST_F(Output, says_so_where_a_peak_is_meant_in_another_unit) {
    put_plane("plane.xyz");
    const auto parse = [&](const char* pga, const char* out) {
        return run({"parse", "plane.xyz", "--disturbance", "earthquake", "--pga", pga, "-o", out})
            .out;
    };
    EXPECT_THAT(parse("0.3", "weak"),
                HasSubstr("Note: pga_m_s2 (--pga) = 0.3 is 0.031 g (light shaking, intensity "
                          "IV): for 0.3 g give pga_m_s2 (--pga) = 2.94."));
    for (const char* pga : {"0.3g", "0.05g", "3g"})  // who writes a unit means it
        EXPECT_THAT(parse(pga, pga), Not(HasSubstr("give pga_m_s2"))) << pga;
    EXPECT_THAT(
        parse("30", "stronger"),
        HasSubstr("Note: pga_m_s2 (--pga) = 30 is 3.1 g (extreme shaking, intensity X or more), "
                  "stronger than nearly all that were recorded; for 30 % of g give"));
    EXPECT_NE(bytes_of_file(in("0.3g/scene.json")).find("\"pga_m_s2\": 2.941995"),
              std::string::npos);
}

TEST_F(Output, a_folder_that_may_not_be_written) {
    if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
    put_plane("plane.xyz");
    std::filesystem::create_directory(in("locked"));
    std::filesystem::permissions(
        in("locked"), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    fails(1, "parse plane.xyz -o locked/out", {"locked"});
}

TEST_F(Output, stages_then_the_summary_unless_quiet) {
    put_plane("plane.xyz");
    const Finished loud = succeeds("parse plane.xyz -o out");
    // What each stage does, and its seconds.
    EXPECT_TRUE(loud.err.starts_with("ingest: reading the scan ... ")) << loud.err;
    EXPECT_THAT(loud.err, HasSubstr("\noutput: writing the files ... "));
    std::istringstream lines(loud.err);
    for (std::string line; std::getline(lines, line);) {
        double seconds = -1;
        int end = 0;
        std::sscanf(line.c_str(), "%*[a-z ]: %*[a-z' ] ... %lf s%n", &seconds, &end);
        EXPECT_EQ(static_cast<std::size_t>(end), line.size()) << line;
        EXPECT_GE(seconds, 0) << line;
    }
    EXPECT_THAT(loud.err, Not(HasSubstr("\r"))) << "that is for terminals";
    EXPECT_THAT(loud.out, HasSubstr("10000 points"));
    EXPECT_THAT(loud.out, HasSubstr("out/report.html"));
    EXPECT_EQ(everything(), whole_output);

    const Finished quiet = succeeds("parse plane.xyz -o out --quiet");
    EXPECT_EQ(quiet.out, "");
    EXPECT_EQ(quiet.err, "");
    EXPECT_EQ(everything(), whole_output);
}

// For parsing once more: what was typed, and no more than that.
TEST_F(Output, the_report_knows_the_command_and_the_notes_of_the_scan) {
    put_plane("plane.xyz");
    put("plane.xyz.topple-notes.txt", "The phone's poses drift.\n");
    const Finished loud = succeeds("parse plane.xyz -o out --voxel 0.05");
    EXPECT_THAT(loud.out, HasSubstr("\nNote: The phone's poses drift.\n"));
    const std::string report = bytes_of_file(in("out/report.html"));
    EXPECT_NE(report.find(R"(","parse","plane.xyz","-o","out","--voxel","0.05"])"),
              std::string::npos);
    EXPECT_NE(report.find(R"("The phone's poses drift.")"), std::string::npos);
    EXPECT_EQ(report.find(in("plane.xyz").string()), std::string::npos) << "nobody gave that path";
}

TEST_F(Output, pictures_where_they_are_asked_for) {
    put_plane("plane.xyz");
    succeeds("parse plane.xyz -o out --png --quiet");
    for (const char* name : {"out/view-objects.png", "out/view-risk.png"}) {
        EXPECT_TRUE(everything().contains(name)) << name;
        EXPECT_TRUE(bytes_of_file(in(name)).starts_with("\x89PNG")) << name;
    }
    // A later run without them replaces the folder as a whole.
    succeeds("parse plane.xyz -o out --quiet");
    EXPECT_EQ(everything(), whole_output);
}

TEST_F(Output, is_named_after_the_input_where_no_name_is_given) {
    put_plane("scans/my plane.xyz");
    EXPECT_EQ(run({"parse", "scans/my plane.xyz", "--quiet"}).code, 0);
    EXPECT_TRUE(std::filesystem::exists(in("my plane-parsed/scene.json")));
}

TEST_F(Output, an_earlier_one_outlives_a_failure) {
    put_plane("plane.xyz");
    succeeds("parse plane.xyz -o out --quiet");
    const auto earlier = bytes_of_file(in("out/scene.json"));
    fails(1, "parse missing.xyz -o out --quiet", {"missing.xyz"});
    EXPECT_EQ(bytes_of_file(in("out/scene.json")), earlier);
}

// One signal in an early, a middle and a late stage.
class Interrupted : public Program,
                    public ::testing::WithParamInterface<std::pair<const char*, int>> {};

TEST_P(Interrupted, leaves_nothing) {
    scenes::CameraOptions camera;
    camera.frames = 12;
    const auto world = scenes::furnished_room({});
    scenes::write_sequence(in("scan"), world, scenes::walk(world, camera));
    const auto before = everything();
    const auto [stage, expected] = GetParam();
    std::chrono::steady_clock::time_point sent;
    const Finished finished =
        topple("parse scan -o made/for/out --backend native",
               [&, name = std::string(stage) + ": ", number = expected](const std::string& err) {
                   if (err.find(name) == std::string::npos) return 0;
                   sent = std::chrono::steady_clock::now();
                   return number;
               });
    EXPECT_EQ(finished.code, 128 + expected) << finished.err;
    EXPECT_TRUE(finished.err.ends_with("topple: interrupted; nothing was written\n"))
        << finished.err;
    EXPECT_THAT(finished.err, Not(HasSubstr("output: ")));
    EXPECT_EQ(everything(), before);
    EXPECT_LT(std::chrono::steady_clock::now() - sent, std::chrono::seconds(30));
}

INSTANTIATE_TEST_SUITE_P(At, Interrupted,
                         ::testing::Values(std::pair("ingest", SIGINT),
                                           std::pair("splitting", SIGINT),
                                           std::pair("supports", SIGTERM)),
                         [](const auto& at) { return std::string(at.param.first); });

}  // namespace
}  // namespace topple::test

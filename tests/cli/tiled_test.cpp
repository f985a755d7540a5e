// SPDX-License-Identifier: MIT
#include "cli/program.h"

// Clouds in blocks, and what is said about a parse before it.
namespace topple::test {
namespace {

using Tiled = Program;

TEST_F(Tiled, says_what_is_wrong_with_a_cloud) {
    put("few.xyz", "0 0 0\n1 0 0\n0 1 0\n");
    fails(1, "parse few.xyz --tile 5 -o out --quiet", {"few.xyz"});
    put("none.xyz", "nan nan nan\n");
    fails(1, "parse none.xyz --tile 5 -o out --quiet", {"none.xyz"});
    put("cut.ply",
        "ply\nformat binary_little_endian 1.0\nelement vertex 100\nproperty float x\n"
        "property float y\nproperty float z\nend_header\nabc");
    fails(1, "parse cut.ply --tile 5 -o out --quiet", {"cut.ply"});
    put("far.xyz", "1e9 0 0\n");
    fails(1, "parse far.xyz --tile 5 -o out --quiet", {"1e+09"});
    std::filesystem::create_directories(in("frames/depth"));
    fails(2, "parse frames --tile 5 -o out --quiet", {"tile_m (--tile) 5", "leave it out"});
    fails(1, "parse away.ply --tile 5 -o out --quiet", {"away.ply"});
}

TEST_F(Tiled, a_plane_has_nothing_to_fall) {
    put_plane("plane.xyz");
    const Finished finished =
        succeeds("parse plane.xyz --tile 5 -o out --quiet --disturbance wind");
    EXPECT_TRUE(std::filesystem::exists(in("out") / "scene.json"));
    for (const auto& entry : std::filesystem::directory_iterator(in("")))
        EXPECT_THAT(entry.path().filename().string(), Not(HasSubstr("topple-work"))) << entry;
}

TEST_F(Tiled, a_stopped_parse_says_what_stays_and_the_next_one_goes_on) {
    succeeds("generate b.ply --building --points 200000 --spacing 0.03");
    const auto stopped = [&] {
        return topple("parse b.ply --tile 5 --voxel 0.06 -o out", [](const std::string& err) {
            return err.find("blocks: ") == std::string::npos ? 0 : SIGINT;
        });
    };
    const Finished first = stopped();
    EXPECT_EQ(first.code, 128 + SIGINT) << first.err;
    EXPECT_THAT(first.err, Not(HasSubstr("going on")));
    const std::string said =
        "topple: interrupted; nothing was written but .out.topple-work, which holds ";
    EXPECT_THAT(first.err, HasSubstr(said));
    EXPECT_THAT(first.err, HasSubstr("the same command goes on from there"));
    EXPECT_TRUE(std::filesystem::exists(in(".out.topple-work")));
    const Finished second = stopped();
    EXPECT_TRUE(second.err.starts_with("going on with ")) << second.err;
    EXPECT_THAT(second.err, HasSubstr(" blocks from .out.topple-work\n"));
    // Stopped before there was anything to go on from.
    std::filesystem::remove_all(in(".out.topple-work"));
    const Finished early = topple("parse b.ply --tile 5 -o out",
                                  [](const std::string& err) { return err.empty() ? 0 : SIGINT; });
    EXPECT_TRUE(early.err.ends_with("topple: interrupted; nothing was written\n")) << early.err;
    EXPECT_FALSE(std::filesystem::exists(in(".out.topple-work")));
}

TEST_F(Tiled, estimates_without_parsing) {
    put_plane("plane.xyz");
    const Finished finished = succeeds("estimate plane.xyz");
    for (const char* word : {"points", "surface", "time", "memory", "results"})
        EXPECT_THAT(finished.out, HasSubstr(word));
    EXPECT_THAT(finished.out, Not(HasSubstr("limit")));
    // As the note of its parse.
    EXPECT_THAT(finished.out, HasSubstr(", points about 20 mm apart\n"));
    const auto limit = [&](const char* size) {
        const Finished limited = run({"estimate", "plane.xyz", "--quiet", "--max-memory", size});
        EXPECT_EQ(limited.code, 0) << limited.err;
        return limited.out;
    };
    EXPECT_THAT(limit("4G"), HasSubstr("4 GiB of --max-memory suffice"));
    EXPECT_THAT(limit("1M"), HasSubstr("1 MiB of --max-memory are too few"));
    fails(1, "estimate away.ply --quiet", {"away.ply"});
    fails(1, "parse plane.xyz --unit mm --quiet", {"plane.xyz", "check unit_m (--unit)"});
    fails(2, "estimate plane.xyz --voxel -1", {"--voxel -1: expected"});
}

}  // namespace
}  // namespace topple::test

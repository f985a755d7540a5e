// SPDX-License-Identifier: MIT
#include <fstream>

#include "cli/program.h"

// Clouds in blocks, and what is said about a parse before it.
namespace topple::test {
namespace {

class Tiled : public Program {
  protected:
    void put(const std::string& name, const std::string& text) const {
        std::ofstream(in(name), std::ios::binary) << text;
    }
};

TEST_F(Tiled, says_what_is_wrong_with_a_cloud) {
    put("few.xyz", "0 0 0\n1 0 0\n0 1 0\n");
    expect_failure(1, {"parse", "few.xyz", "--tile", "5", "-o", "out", "--quiet"}, {"few.xyz"});
    put("none.xyz", "nan nan nan\n");
    expect_failure(1, {"parse", "none.xyz", "--tile", "5", "-o", "out", "--quiet"}, {"none.xyz"});
    put("cut.ply",
        "ply\nformat binary_little_endian 1.0\nelement vertex 100\nproperty float x\n"
        "property float y\nproperty float z\nend_header\nabc");
    expect_failure(1, {"parse", "cut.ply", "--tile", "5", "-o", "out", "--quiet"}, {"cut.ply"});
    put("far.xyz", "1e9 0 0\n");
    expect_failure(1, {"parse", "far.xyz", "--tile", "5", "-o", "out", "--quiet"}, {"1e+09"});
    expect_failure(1, {"parse", "away.ply", "--tile", "5", "-o", "out", "--quiet"}, {"away.ply"});
}

TEST_F(Tiled, a_plane_has_nothing_to_fall) {
    put_plane("plane.xyz");
    const Finished finished =
        run({"parse", "plane.xyz", "--tile", "5", "-o", "out", "--quiet", "--disturbance", "wind"});
    EXPECT_EQ(finished.code, 0) << finished.err;
    EXPECT_TRUE(std::filesystem::exists(in("out") / "scene.json"));
    for (const auto& entry : std::filesystem::directory_iterator(in("")))
        EXPECT_EQ(entry.path().filename().string().find("topple-work"), std::string::npos) << entry;
}

TEST_F(Tiled, estimates_without_parsing) {
    put_plane("plane.xyz");
    const Finished finished = run({"estimate", "plane.xyz"});
    EXPECT_EQ(finished.code, 0) << finished.err;
    for (const char* word : {"points", "surface", "time", "memory", "results"})
        EXPECT_NE(finished.out.find(word), std::string::npos) << finished.out;
    expect_failure(1, {"estimate", "away.ply", "--quiet"}, {"away.ply"});
    expect_failure(2, {"estimate", "plane.xyz", "--voxel", "-1"}, {"--voxel"});
}

}  // namespace
}  // namespace topple::test

// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "cli/program.h"

// topple compare: what became of things between two parses.
namespace topple::test {
namespace {

using Compare = Program;

TEST_F(Compare, tells_people_and_writes_json) {
    put_plane("plane.xyz");
    succeeds("parse plane.xyz -o a --quiet");
    const Finished done = succeeds("compare a a -o changes.json");
    EXPECT_TRUE(done.out.starts_with(
        "plane.xyz to plane.xyz, in one frame: 100 % of surfaces that both saw agree"))
        << done.out;
    EXPECT_THAT(done.out, HasSubstr("\n  nothing came, went or moved\n"));
    const auto json = nlohmann::json::parse(bytes_of_file(in("changes.json")));
    EXPECT_EQ(json["schema"], "topple.comparison/1");
    EXPECT_EQ(json["alignment"]["same_frame"], true);
    EXPECT_NEAR(json["alignment"]["a_from_b"][0][0].get<double>(), 1, 1e-6);
    EXPECT_TRUE(json["things"].empty());
    succeeds("compare a a -o changes.json");
}

TEST_F(Compare, refuses_what_is_no_output_and_files_of_others) {
    put_plane("plane.xyz");
    succeeds("parse plane.xyz -o a --quiet");
    fails(1, "compare a missing", {"missing", "No such file or folder"});
    fails(2, "compare a", {"B is required"});
    put("mine.json", "{}");
    fails(1, "compare a a -o mine.json", {"mine.json", "no comparison of topple"});
    std::filesystem::copy(in("a"), in("b"));
    put("b/volume.vdb", "mine");
    fails(1, "compare a b", {"b/volume.vdb"});
}

}  // namespace
}  // namespace topple::test

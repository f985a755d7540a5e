// SPDX-License-Identifier: MIT
#include "cli/program.h"

// The command that draws one object's landscapes.
namespace topple::test {
namespace {

using DrawLandscape = Program;

TEST_F(DrawLandscape, refuses_what_has_none) {
    expect_failure(2, {"landscape"}, {"OUT"});
    expect_failure(1, {"landscape", "nowhere"}, {"nowhere"});
    put("mine/scene.json", "{}");
    expect_failure(1, {"landscape", "mine"}, {"scene.json"});
    put_plane("plane.xyz");
    ASSERT_EQ(run({"parse", "plane.xyz", "-o", "out", "--quiet"}).code, 0);
    expect_failure(1, {"landscape", "out"}, {"no object that can move"});
    expect_failure(2, {"landscape", "out", "--object", "0"}, {"--object 0", "ground"});
    expect_failure(2, {"landscape", "out", "--object", "99"}, {"--object 99"});
    expect_failure(2, {"landscape", "out", "--object", "-1"}, {"--object"});
}

TEST_F(DrawLandscape, makes_pictures_of_the_worst_or_the_chosen_object) {
    ASSERT_EQ(run({"generate", "room", "--seed", "2", "--frames", "10"}).code, 0);
    ASSERT_EQ(run({"parse", "room", "-o", "out", "--voxel", "0.04", "--disturbance", "wind",
                   "--backend", "native", "--quiet"})
                  .code,
              0);
    const Finished worst = run({"landscape", "out"});
    ASSERT_EQ(worst.code, 0) << worst.err;
    EXPECT_NE(worst.out.find(".png"), std::string::npos) << worst.out;
    EXPECT_NE(worst.out.find("Object "), std::string::npos) << worst.out;
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
    expect_failure(1, {"landscape", "out", "-o", "none/x.png"}, {"none/x.png", "no folder none"});
}

}  // namespace
}  // namespace topple::test

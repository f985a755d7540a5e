// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "cli/program.h"

// Questions about what holds what, of the folder of a parse.
namespace topple::test {
namespace {

using Ask = Program;
using nlohmann::json;

TEST_F(Ask, refuses_what_is_no_question) {
    fails(2, "ask", {"OUT"});
    fails(1, "ask nowhere --order", {"nowhere"});
    put("other/notes.txt", "");
    fails(1, "ask other --order", {"other: holds no output of topple"});
    put("mine/scene.json", "{}");
    fails(1, "ask mine --order", {"scene.json"});
    put_plane("plane.xyz");
    succeeds("parse plane.xyz -o out --quiet");
    fails(2, "ask out", {"--without, --order, --before, --holds, --push, --releases or --spots"});
    fails(2, "ask out --order --holds 1", {"expected one question"});
    for (const std::string option : {"--without", "--before", "--holds"}) {
        fails(2, "ask out " + option + " 0", {"object 0", "the building"});
        fails(2, "ask out " + option + " 99", {"object 99: the scene has objects 0 to 0"});
        for (const char* wrong : {"-1", "x", "1.5", "99999999999"})
            fails(2, "ask out " + option + " " + wrong, {option + " " + wrong, "number"});
        expect_failure(2, {"ask", "out", option, ""}, {option, "empty"});
    }
    fails(2, "ask out --without 1,", {"--without"});
    fails(2, "ask out --push 99", {"--push 99", "1 object, from 0 on"});
    fails(2, "ask out --order --at 0,0,0", {"--at", "--push"});
    fails(2, "ask out --push 0 --at 0,0", {"--at 0,0", "X,Y,Z"});
    EXPECT_THAT(succeeds("ask out --push 0").out, HasSubstr("the building"));
    EXPECT_EQ(succeeds("ask out --order").out, "There is nothing that can be taken away.\n");
    EXPECT_EQ(json::parse(succeeds("ask out --order --json").out).at("steps"), json::array());
}

TEST_F(Ask, answers_in_words_and_as_json) {
    succeeds("generate room --seed 2 --frames 10");
    succeeds("parse room -o out --voxel 0.04 --disturbance wind --backend native --quiet");
    std::ifstream file(in("out/scene.json"));
    const json scene = json::parse(file);
    const auto& objects = scene.at("objects");

    // All that is loose, once, and nothing before what it carries.
    std::map<int, std::size_t> step_of;
    const json order = json::parse(succeeds("ask out --order --json").out);
    EXPECT_EQ(order.at("schema"), "topple.ask/1");
    const auto& steps = order.at("steps");
    for (std::size_t n = 0; n < steps.size(); ++n)
        for (const int id : steps[n]) EXPECT_TRUE(step_of.emplace(id, n).second) << id;
    std::size_t loose = 0;
    for (const auto& o : objects) loose += o.at("grounded") ? 0 : 1;
    EXPECT_EQ(step_of.size(), loose);
    EXPECT_GT(loose, 3u);
    std::set<int> carriers;
    for (const auto& s : scene.at("supports")) {
        const int a = s.at("supporter"), b = s.at("supported");
        if (objects[a].at("grounded")) continue;
        EXPECT_LE(step_of.at(b), step_of.at(a));
        carriers.insert(a);
    }
    ASSERT_FALSE(carriers.empty());
    EXPECT_THAT(succeeds("ask out --order").out, HasSubstr("\n  1. Object "));
    const std::string some = std::to_string(*carriers.begin());
    const auto& steps_of_it = objects[*carriers.begin()].at("instability");
    const json none = json::parse(succeeds("ask out --json --energy 0 --releases " + some).out);
    EXPECT_GE(none.at("S_J"), 0);
    const json all = json::parse(succeeds("ask out --json --energy 1e9 --releases " + some).out);
    EXPECT_EQ(all.at("S_J"), steps_of_it.empty() ? json(0.0) : steps_of_it.back().at("S_J"));
    // A correction by spots of its parts, as a file takes it.
    const json spots =
        json::parse(succeeds("ask out --spots " + std::to_string(*carriers.begin())).out);
    EXPECT_EQ(spots.at("do"), "one_thing");
    EXPECT_FALSE(spots.at("at_m").empty());

    std::size_t fallen = 0;
    for (const int id : carriers) {
        const std::string n = std::to_string(id);
        const json without = json::parse(succeeds("ask out --json --without " + n).out);
        EXPECT_EQ(without.at("objects"), json({id}));
        const json before = json::parse(succeeds("ask out --json --before " + n).out);
        const std::size_t sure = without.at("falls").size() + 1;
        EXPECT_GE(before.at("steps").size(), sure) << "no rings here";
        EXPECT_LE(before.at("steps").size(), sure + without.at("unsure").size());
        const std::string words = succeeds("ask out --without " + n).out;
        for (const auto& one : without.at("falls"))
            EXPECT_THAT(words, HasSubstr("  " + one.at("reason").get<std::string>() + ".\n"));
        EXPECT_THAT(words, HasSubstr("Without object " + n));
        fallen += without.at("falls").size();
    }
    EXPECT_GT(fallen, 0u);

    std::size_t known = 0;
    for (const auto& o : objects) {
        if (o.at("grounded")) continue;
        const std::string id = std::to_string(o.at("id").get<int>());
        const json push = json::parse(succeeds("ask out --json --push " + id).out);
        const bool doubted = push.at("doubt") != "";
        EXPECT_EQ(doubted, push.at("stays_up_to_N") == 0) << id;
        EXPECT_THAT(succeeds("ask out --push " + id).out,
                    HasSubstr(doubted ? push.at("doubt").get<std::string>()
                                      : "stays up to a steady push of "));
        known += !doubted;
    }
    EXPECT_GT(known, 0u);

    const std::string n = std::to_string(*carriers.begin());
    EXPECT_THAT(succeeds("ask out --before " + n).out, HasSubstr("object " + n));
    const json holds = json::parse(succeeds("ask out --json --holds " + n).out);
    EXPECT_EQ(holds.at("rests_by"), objects[*carriers.begin()].at("rests_by"));
    const std::string held = succeeds("ask out --holds " + n).out;
    EXPECT_THAT(held, HasSubstr("Object " + n));
    for (const auto& holder : holds.at("held_by"))
        EXPECT_THAT(held,
                    HasSubstr(holder.at("building")
                                  ? "  The building"
                                  : "  Object " + std::to_string(holder.at("object").get<int>())));
}

}  // namespace
}  // namespace topple::test

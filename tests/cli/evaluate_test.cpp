// SPDX-License-Identifier: MIT
#include "cli/program.h"

// The command that judges parses of generated rooms.
namespace topple::test {
namespace {

using Evaluate = Program;

TEST_F(Evaluate, refuses_what_it_cannot_do) {
    expect_failure(2, {"evaluate", "--seeds", "0"}, {"--seeds 0", "1 to"});
    expect_failure(2, {"evaluate", "--frames", "0"}, {"--frames 0", "1 to"});
    expect_failure(2, {"evaluate", "--voxel", "-1"}, {"--voxel"});
    expect_failure(2, {"evaluate", "--furniture", "odd"}, {"--furniture", "varied"});
    expect_failure(2, {"generate", "room", "--furniture", "odd"}, {"--furniture", "plain"});
    expect_failure(2, {"evaluate", "--groupings", "--fit-joints"}, {"--fit-joints"});
    expect_failure(2, {"evaluate", "--groupings", "--single"}, {"--single"});
    put("file", "not a folder");
    expect_failure(1, {"evaluate", "-o", "file/below"}, {"file/below"});
}

TEST_F(Evaluate, prints_tables_and_writes_them) {
    const Finished done =
        run({"evaluate", "--seeds", "1", "--first", "4", "--frames", "6", "--voxel", "0.04",
             "--furniture", "varied", "--backend", "native", "-o", "judged"});
    ASSERT_EQ(done.code, 0) << done.err;
    for (const char* part : {"Fig. 14", "Table 2", "94.1", "Table 3", "81.8", "after filling",
                             "cut discr.", "false alarm"})
        EXPECT_THAT(done.out, HasSubstr(part));
    EXPECT_EQ(everything(),
              (std::set<std::string>{"judged", "judged/scores.csv", "judged/tables.txt"}));
    EXPECT_TRUE(done.out.starts_with(bytes_of_file(in("judged/tables.txt"))));
}

TEST_F(Evaluate, prints_tables_of_groupings_and_fits_one_of_them) {
    const Finished table =
        run({"evaluate", "--groupings", "--seeds", "1", "--first", "4", "--frames", "6", "--voxel",
             "0.04", "--backend", "native", "-o", "judged"});
    ASSERT_EQ(table.code, 0) << table.err;
    for (const char* part : {"Table 3", "discriminative", "greedy", "SWC", "81.8"})
        EXPECT_THAT(table.out, HasSubstr(part));
    EXPECT_EQ(everything(), (std::set<std::string>{"judged", "judged/groupings.txt"}));
    EXPECT_EQ(table.out, bytes_of_file(in("judged/groupings.txt")));
    const Finished weights = run({"evaluate", "--fit-joints", "--seeds", "1", "--first", "4",
                                  "--frames", "6", "--voxel", "0.04", "--backend", "native"});
    ASSERT_EQ(weights.code, 0) << weights.err;
    EXPECT_EQ(std::count(weights.out.begin(), weights.out.end(), ','), 9) << weights.out;
    EXPECT_THAT(weights.out, HasSubstr(" joints of 1 room"));
}

TEST_F(Evaluate, says_which_program_is_missing) {
    std::filesystem::create_directory(in("alone"));
    std::filesystem::copy_file(TOPPLE_PROGRAM, in("alone/topple"));
    const std::string command = "env -u TOPPLE_READERS " + in("alone/topple").string() +
                                " generate room 2> " + in("said").string();
    const int status = std::system(command.c_str());
    EXPECT_EQ(WEXITSTATUS(status), 2);
    EXPECT_NE(bytes_of_file(in("said")).find("build the target topple-lab"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(in("room")));
}

TEST_F(Evaluate, leaves_nothing_when_interrupted) {
    bool sent = false;
    const Finished done = run({"evaluate", "--seeds", "3", "--frames", "20", "-o", "judged"},
                              [&](const std::string& err) {
                                  if (sent || err.find("room 1") == std::string::npos) return 0;
                                  sent = true;
                                  return SIGINT;
                              });
    EXPECT_EQ(done.code, 128 + SIGINT) << done.err;
    EXPECT_EQ(everything(), std::set<std::string>{"judged"});
}

}  // namespace
}  // namespace topple::test

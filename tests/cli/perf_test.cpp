// SPDX-License-Identifier: MIT
#include <cctype>
#include <nlohmann/json.hpp>

#include "cli/program.h"

// The command that measures.
namespace topple::test {
namespace {

using Perf = Program;

TEST_F(Perf, refuses_what_it_does_not_have) {
    fails(2, "perf --filter nothing_like_it", {"nothing_like_it", "--list"});
    fails(2, "perf --backend abacus", {"abacus"});
    fails(2, "perf --runs -1", {"--runs"});
    fails(1, "perf --backend native --filter multiply_add --runs 1 --csv none/x.csv",
          {"none/x.csv"});
}

TEST_F(Perf, lists_its_cases) {
    EXPECT_THAT(topple("perf --help").out, HasSubstr("perf/compare"));
    const Finished list = succeeds("perf --list");
    for (const char* name : {"triad\n", "support_function\n", "landscapes/hulls\n", "pipeline\n"})
        EXPECT_THAT(list.out, HasSubstr(name));
}

// A box on a floor, stage by stage.
TEST_F(Perf, profiles_a_parse) {
    std::ofstream cloud(in("box.xyz"));
    for (int i = 0; i < 60; ++i) {
        for (int j = 0; j < 60; ++j) {
            const bool box = i > 20 && i < 40 && j > 20 && j < 40;
            cloud << 0.02 * i << ' ' << 0.02 * j << ' ' << (box ? 0.4 : 0) << '\n';
            if (i < 20) cloud << 0.4 << ' ' << 0.4 + 0.02 * i << ' ' << 0.4 * j / 60 << '\n';
        }
    }
    cloud.close();
    const Finished done = succeeds("perf --profile box.xyz");
    std::istringstream lines(done.out);
    std::string line;
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_THAT(line, HasSubstr("cpu s"));
    std::set<std::string> stages;
    std::string last;
    while (std::getline(lines, line) && !line.empty()) {
        std::istringstream columns(line);
        double wall = -1, cpu = -1;
        for (std::string word; columns >> word && !std::isdigit(word[0]); last = word) {
            if (word == "field") continue;
            EXPECT_TRUE(stages.insert(word).second) << "twice: " << line;
        }
        std::istringstream(line.substr(18)) >> wall >> cpu;
        EXPECT_GE(wall, 0) << line;
        EXPECT_GE(cpu, 0) << line;
    }
    for (const char* stage : {"ingest", "filling", "grouping", "barriers", "output"})
        EXPECT_TRUE(stages.contains(stage)) << stage;
    EXPECT_EQ(last, "all");
    // Then stage by stage each kernel, and what share they have.
    std::set<std::string> kernels;
    ASSERT_TRUE(std::getline(lines, line));
    while (std::getline(lines, line) && !line.empty()) {
        std::istringstream columns(line.substr(19));
        std::string kernel;
        double dispatches = 0, device_s = -1, cpu_s = -1, bound = -1;
        columns >> kernel >> dispatches >> device_s >> cpu_s >> bound;
        kernels.insert(kernel);
        EXPECT_GE(dispatches, 1) << line;
        EXPECT_GE(device_s, 0) << line;
        EXPECT_GE(bound, 0) << line;
    }
    for (const char* kernel : {"voxel_normals", "six_fill_sweep"})
        EXPECT_TRUE(kernels.contains(kernel)) << kernel;
    EXPECT_TRUE(std::getline(lines, line) && line.starts_with("Kernels ran in ")) << line;
    fails(1, "perf --profile none.ply", {"none.ply"});
}

TEST_F(Perf, counts_and_results_are_those_of_the_last_time) {
    nlohmann::json results[2];
    for (auto& result : results) {
        const Finished done = succeeds(
            "perf --backend native --filter multiply_add --no-roofline --runs 3 --json run.json "
            "--csv run.csv");
        const auto all = nlohmann::json::parse(bytes_of_file(in("run.json"))).at("results");
        ASSERT_EQ(all.size(), 1u);
        result = all[0];
    }
    EXPECT_EQ(results[0].at("case"), "multiply_add");
    EXPECT_FALSE(results[0].at("driver").get<std::string>().empty());
    EXPECT_EQ(results[0].at("hash"), results[1].at("hash"));
    EXPECT_EQ(results[0].at("counts"), results[1].at("counts"));
    EXPECT_GE(results[0].at("counts").at("dispatches"), 1);
    for (const char* samples : {"samples_s", "samples_cpu_s"}) {
        ASSERT_EQ(results[0].at(samples).size(), 3u);
        for (const double s : results[0].at(samples)) EXPECT_GT(s, 0) << samples;
    }
    std::istringstream csv(bytes_of_file(in("run.csv")));
    std::string head, row, more;
    ASSERT_TRUE(std::getline(csv, head) && std::getline(csv, row));
    EXPECT_FALSE(std::getline(csv, more)) << more;
    EXPECT_TRUE(head.starts_with("backend,device,driver,case,best_ms")) << head;
    EXPECT_THAT(row, HasSubstr(",multiply_add,"));
    EXPECT_TRUE(row.ends_with(results[0].at("hash").get<std::string>())) << row;
}

// The command that judges parses of generated rooms.

using Evaluate = Program;

TEST_F(Evaluate, refuses_what_it_cannot_do) {
    fails(2, "evaluate --seeds 0", {"--seeds 0", "1 to"});
    fails(2, "evaluate --frames 0", {"--frames 0", "1 to"});
    fails(2, "evaluate --voxel -1", {"--voxel"});
    fails(2, "evaluate --furniture odd", {"--furniture", "varied"});
    fails(2, "generate room --furniture odd", {"--furniture", "plain"});
    fails(2, "evaluate --groupings --fit-joints", {"--fit-joints"});
    fails(2, "evaluate --groupings --single", {"--single"});
    put("file", "not a folder");
    fails(1, "evaluate -o file/below", {"file/below"});
}

TEST_F(Evaluate, prints_tables_and_writes_them) {
    const Finished done = succeeds(
        "evaluate --seeds 1 --first 4 --frames 6 --voxel 0.04 --furniture varied --backend native "
        "-o judged");
    for (const char* part : {"Fig. 14", "Table 2", "94.1", "Table 3", "81.8", "after filling",
                             "cut discr.", "false alarm"})
        EXPECT_THAT(done.out, HasSubstr(part));
    EXPECT_EQ(everything(),
              (std::set<std::string>{"judged", "judged/scores.csv", "judged/segmentation.svg",
                                     "judged/tables.txt"}));
    EXPECT_TRUE(done.out.starts_with(bytes_of_file(in("judged/tables.txt"))));
}

TEST_F(Evaluate, prints_tables_of_groupings_and_fits_one_of_them) {
    const Finished table = succeeds(
        "evaluate --groupings --seeds 1 --first 4 --frames 6 --voxel 0.04 --backend native -o "
        "judged");
    for (const char* part : {"Table 3", "discriminative", "greedy", "SWC", "81.8"})
        EXPECT_THAT(table.out, HasSubstr(part));
    EXPECT_EQ(everything(), (std::set<std::string>{"judged", "judged/groupings.txt"}));
    EXPECT_EQ(table.out, bytes_of_file(in("judged/groupings.txt")));
    const Finished weights = succeeds(
        "evaluate --fit-joints --seeds 1 --first 4 --frames 6 --voxel 0.04 --backend native");
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
    const Finished done =
        topple("evaluate --seeds 3 --frames 20 -o judged", [&](const std::string& err) {
            if (sent || err.find("room 1") == std::string::npos) return 0;
            sent = true;
            return SIGINT;
        });
    EXPECT_EQ(done.code, 128 + SIGINT) << done.err;
    EXPECT_EQ(everything(), std::set<std::string>{"judged"});
}

}  // namespace
}  // namespace topple::test

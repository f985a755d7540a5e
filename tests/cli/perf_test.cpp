// SPDX-License-Identifier: MIT
#include <cctype>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>

#include "cli/program.h"

// The command that measures.
namespace topple::test {
namespace {

using Perf = Program;

TEST_F(Perf, refuses_what_it_does_not_have) {
    expect_failure(2, {"perf", "--filter", "nothing_like_it"}, {"nothing_like_it", "--list"});
    expect_failure(2, {"perf", "--backend", "abacus"}, {"abacus"});
    expect_failure(2, {"perf", "--runs", "-1"}, {"--runs"});
    expect_failure(1,
                   {"perf", "--backend", "native", "--filter", "multiply_add", "--runs", "1",
                    "--csv", "none/x.csv"},
                   {"none/x.csv"});
}

TEST_F(Perf, lists_its_cases) {
    EXPECT_THAT(run({"perf", "--help"}).out, HasSubstr("perf/compare"));
    const Finished list = run({"perf", "--list"});
    ASSERT_EQ(list.code, 0) << list.err;
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
    const Finished done = run({"perf", "--profile", "box.xyz"});
    ASSERT_EQ(done.code, 0) << done.err;
    std::istringstream lines(done.out);
    std::string line;
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_THAT(line, HasSubstr("cpu s"));
    std::set<std::string> stages;
    std::string last;
    while (std::getline(lines, line)) {
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
    expect_failure(1, {"perf", "--profile", "none.ply"}, {"none.ply"});
}

TEST_F(Perf, counts_and_results_are_those_of_the_last_time) {
    nlohmann::json results[2];
    for (auto& result : results) {
        const Finished done =
            run({"perf", "--backend", "native", "--filter", "multiply_add", "--no-roofline",
                 "--runs", "3", "--json", "run.json", "--csv", "run.csv"});
        ASSERT_EQ(done.code, 0) << done.err;
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

}  // namespace
}  // namespace topple::test

// SPDX-License-Identifier: MIT
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include "cli/commands.h"
#include "cli/print.h"
#include "io/replace_file.h"
#include "perf/kernels/report.h"
#include "perf/profile.h"
#include "perf/suite.h"
#include "topple/device.h"
#include "topple/error.h"

namespace topple::cli {
namespace {

struct PerfArguments {
    perf::SuiteOptions suite;
    std::string json, csv, profile;
    bool list = false;
};

int run(const PerfArguments& a) {
    if (a.list) {
        for (const std::string& name : perf::case_names()) print("%s\n", name.c_str());
        return 0;
    }
    if (!a.profile.empty()) {
        const auto& names = a.suite.backends;
        perf::print_profile(perf::profile(
            device::open_device(names.empty() ? "native" : names.front(), a.suite.threads),
            a.profile));
        return 0;
    }
    // Told before the measuring, which takes minutes.
    for (const std::string& path : {a.json, a.csv}) {
        if (path.empty()) continue;
        const auto folder = std::filesystem::path(path).parent_path();
        std::error_code error;
        if (!folder.empty() && !std::filesystem::is_directory(folder, error))
            throw Error(ErrorKind::input, path + ": there is no folder " + folder.string());
        io::check_own_file(path, path == a.json ? "topple.perf/" : "backend,device,driver,",
                           "is no result of topple perf; choose another name");
    }
    const auto results = perf::run_suite(a.suite);
    if (!a.json.empty()) io::replace_file(a.json, perf::json_text(results));
    if (!a.csv.empty()) io::replace_file(a.csv, perf::csv_text(results));
    return perf::hashes_agree(results) ? 0 : 1;
}

}  // namespace

Command add_perf(CLI::App& app) {
    auto a = std::make_shared<PerfArguments>();
    perf::SuiteOptions& suite = a->suite;
    app.footer(
        "Whether a change made topple slower is told by perf/compare, which runs both in turns\n"
        "(docs/performance.md); figures of different runs do not compare.");
    app.add_option("--filter", suite.filters,
                   "Only cases whose name contains this; may be repeated");
    app.add_option("--backend", suite.backends, "native, opencl, vulkan or all")
        ->delimiter(',')
        ->default_str("all");
    app.add_option("--json", a->json, "Write all samples, counts and hashes to this file");
    app.add_option("--csv", a->csv, "Write one line per case to this file");
    app.add_option("--runs", suite.measure.runs,
                   "Samples of each kernel (default: 7 to 100, for --seconds)")
        ->check(whole_number);
    app.add_flag("--once", suite.measure.once,
                 "Run each kernel once, and no more: for counts and hashes (perf/facts)");
    app.add_option("--seconds", suite.measure.seconds, "Time for each kernel")
        ->check(CLI::Range(0.0, 3600.0))
        ->capture_default_str();
    app.add_option("--stage-runs", suite.stage_runs, "Runs of the stages; 0: none")
        ->check(whole_number)
        ->capture_default_str();
    app.add_option("--pipeline-runs", suite.pipeline.runs, "Parses of the whole room; 0: none")
        ->check(whole_number)
        ->capture_default_str();
    app.add_option("--pipeline-frames", suite.pipeline.frames,
                   "Frames of the walk through the room")
        ->check(CLI::Range(1u, 10000u))
        ->capture_default_str();
    app.add_option("--seed", suite.pipeline.seed, "Seed of the room")
        ->check(whole_number)
        ->capture_default_str();
    app.add_option("--threads", suite.threads, "Threads of the native backend (0: all cores)")
        ->check(whole_number)
        ->capture_default_str();
    app.add_flag_function(
        "--no-roofline", [&suite](std::int64_t) { suite.roofline = false; },
        "Leave out the probes of bandwidth and arithmetic that no --filter names");
    app.add_option(
        "--profile", a->profile,
        "Parse this input instead, and print what each stage takes: time, kernels, memory,\n"
        "dispatches, and what goes to the device and back");
    app.add_flag("--list", a->list, "Print the names of the cases");
    return [a] { return run(*a); };
}

}  // namespace topple::cli

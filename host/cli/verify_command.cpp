// SPDX-License-Identifier: MIT
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/long_run.h"
#include "cli/print.h"
#include "io/output_folder.h"
#include "io/replace_file.h"
#include "io/staging_folder.h"
#include "io/text.h"
#include "mujoco/settle_apart.h"
#include "mujoco/verdict.h"
#include "report/report.h"
#include "result/scene_json.h"
#include "topple/export.h"

namespace topple::cli {
namespace {

struct VerifyArguments {
    std::string parsed;
    double seconds = 5, time_limit_s = 600;
    unsigned threads = 0;
    bool json = false, joints = true;
};

mujoco::Verdict verify(const VerifyArguments& a, Progress& progress) {
    // What is missing is told before the work.
    io::check_output(a.parsed);
    for (const char* name : {"verify.json", "report.html"})
        io::check_replaceable_file(std::filesystem::path(a.parsed) / name);
    const Scene scene = io::read_scene_json(io::FileName::in(a.parsed, "scene.json"));
    mujoco::find_simulator();
    const io::StagingFolder scratch = io::StagingFolder::temporary();
    ExportOptions options;
    options.mjcf = scratch.path();
    options.threads = a.threads;
    options.joints = a.joints;
    options.cancelled = [] { return interrupted() != 0; };
    progress("export", 0);
    const ExportSummary exported = export_output(a.parsed, options);
    progress("MuJoCo", 0);
    mujoco::Settled run =
        mujoco::settle_apart(scratch.path() / "scene.xml", a.seconds, a.time_limit_s, [] {
            if (interrupted() != 0) throw Error(ErrorKind::cancelled, "cancelled");
        });
    return mujoco::judge(scene, exported, std::move(run), a.seconds);
}

// Into the folder of outputs, and its report where there is one that has a place for it.
void keep(const std::filesystem::path& folder, const std::string& json) {
    io::replace_file(folder / "verify.json", json);
    const std::filesystem::path report = folder / "report.html";
    std::error_code error;
    if (std::filesystem::exists(report, error) && !report::add_verification(report, json))
        print_to(stderr, "%s: has no place for it; parse the scan again\n",
                 io::path_text(report).c_str());
}

void check(const VerifyArguments& a) {
    for (const auto& [name, value] :
         {std::pair{"--seconds", a.seconds}, std::pair{"--time-limit", a.time_limit_s}}) {
        if (!(value > 0) || value > 86400)
            throw Error(ErrorKind::usage,
                        std::string(name) + ": expected seconds above 0, a day's at most");
    }
}

int run_verify(const VerifyArguments& a) {
    check(a);
    catch_interrupts();
    return run_long(a.json, [&](Progress& progress) {
        const mujoco::Verdict verdict = verify(a, progress);
        const std::string json = mujoco::verdict_json(verdict);
        keep(a.parsed, json);
        progress.finish();
        std::fputs(a.json ? json.c_str() : mujoco::verdict_text(verdict).c_str(), stdout);
        mujoco::check_stable(verdict, io::path_text(a.parsed));
    });
}

}  // namespace

Command add_verify(CLI::App& app) {
    auto a = std::make_shared<VerifyArguments>();
    app.add_option("OUT", a->parsed, "Output folder of a parse")->required();
    app.add_option("--seconds", a->seconds, "How long all objects are left to themselves")
        ->capture_default_str();
    app.add_option("--time-limit", a->time_limit_s,
                   "Seconds that this may take; what was simulated by then is told")
        ->capture_default_str();
    app.add_option("--threads", a->threads, "Threads; else all cores")->check(whole_number);
    app.add_flag_function(
        "--no-joints", [a](std::int64_t) { a->joints = false; },
        "Doors and drawers stay parts of their furniture");
    app.add_flag("--json", a->json, "Print verify.json, which is written into OUT, not a table");
    return [a] { return run_verify(*a); };
}

}  // namespace topple::cli

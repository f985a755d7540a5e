// SPDX-License-Identifier: MIT
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "perf/field_stages.h"
#include "perf/landscape_stages.h"
#include "perf/measure.h"
#include "perf/peers.h"
#include "perf/pipeline_case.h"
#include "perf/report.h"
#include "perf/stage_cases.h"
#include "topple/device.h"
#include "topple/error.h"

namespace topple::perf {
namespace {

struct Arguments {
    std::vector<std::string> backends;
    std::vector<std::string> filters;
    std::string json, csv;
    MeasureOptions measure;
    PipelineOptions pipeline;
    unsigned threads = 0;
    unsigned stage_runs = 5;
    bool peers = true;
    bool list = false;
};

bool is_probe(const std::string& name) {
    return name == "triad" || name == "multiply_add";
}

bool wanted(const Arguments& a, const std::string& name) {
    return a.filters.empty() ||
           std::any_of(a.filters.begin(), a.filters.end(),
                       [&](const std::string& f) { return name.find(f) != std::string::npos; });
}

// The stages' scene is made once, on the first device; the peers then stand beside that device.
class Stages {
  public:
    explicit Stages(const Arguments& arguments) : a_(arguments) {}

    bool wanted() const { return any(stage_names()) || any(field_names()); }
    std::vector<Result> measure(device::Device& device) {
        if (!scene_) scene_ = make_stage_scene(device);
        std::vector<Result> results;
        if (any(stage_names())) {
            StageRun run = measure_stages(device, *scene_, a_.stage_runs);
            results = run.results;
            if (first_.results.empty()) first_ = std::move(run);
        }
        if (any(field_names())) {
            const auto fields = measure_fields(device, *scene_, a_.stage_runs);
            results.insert(results.end(), fields.begin(), fields.end());
        }
        std::erase_if(results, [&](const Result& r) { return !perf::wanted(a_, r.name); });
        return results;
    }
    std::vector<Result> peers() const {
        if (!a_.peers || first_.results.empty()) return {};
        return compare_with_peers(*scene_, first_);
    }

  private:
    bool any(const std::vector<std::string>& names) const {
        return a_.stage_runs > 0 &&
               std::any_of(names.begin(), names.end(),
                           [&](const std::string& name) { return perf::wanted(a_, name); });
    }

    const Arguments& a_;
    std::optional<StageScene> scene_;
    StageRun first_;
};

bool landscapes_wanted(const Arguments& a) {
    const auto names = landscape_names();
    return a.stage_runs > 0 &&
           std::any_of(names.begin(), names.end(), [&](const auto& n) { return wanted(a, n); });
}

std::vector<Result> measure_backend(const std::shared_ptr<device::Device>& device,
                                    const Arguments& a, Stages& stages) {
    std::vector<Result> results;
    const bool landscapes = landscapes_wanted(a);
    const bool any_kernel = stages.wanted() || landscapes ||
                            std::any_of(all_cases().begin(), all_cases().end(),
                                        [&](const Case& c) { return wanted(a, c.name); });
    for (const Case& test : all_cases()) {
        // The probes are the yardstick of all others.
        if (!wanted(a, test.name) && !(any_kernel && is_probe(test.name))) continue;
        results.push_back(measure(*device, test, a.measure));
    }
    if (stages.wanted()) {
        const auto whole = stages.measure(*device);
        results.insert(results.end(), whole.begin(), whole.end());
    }
    if (landscapes) {
        const auto whole = measure_landscapes(*device, a.stage_runs);
        std::copy_if(whole.begin(), whole.end(), std::back_inserter(results),
                     [&](const Result& r) { return wanted(a, r.name); });
    }
    apply_roofline(results);
    print_results(results);
    if (wanted(a, "pipeline") && a.pipeline.runs > 0) {
        scenes::Score score;
        const auto whole = measure_pipeline(device, a.pipeline, score);
        print_results(whole);
        print_score(score);
        results.insert(results.end(), whole.begin(), whole.end());
    }
    return results;
}

// Every backend must have computed the same.
bool hashes_agree(const std::vector<Result>& results) {
    std::map<std::string, const Result*> first;
    bool agree = true;
    for (const Result& r : results) {
        const auto [at, is_new] = first.emplace(r.name, &r);
        if (is_new || at->second->hash == r.hash) continue;
        std::fprintf(stderr, "topple_perf: %s: the result on %s differs from the one on %s\n",
                     r.name.c_str(), r.backend.c_str(), at->second->backend.c_str());
        agree = false;
    }
    return agree;
}

int run(const Arguments& a) {
    if (a.list) {
        for (const Case& test : all_cases()) std::printf("%s\n", test.name);
        for (const std::string& name : stage_names()) std::printf("%s\n", name.c_str());
        for (const std::string& name : field_names()) std::printf("%s\n", name.c_str());
        for (const std::string& name : landscape_names()) std::printf("%s\n", name.c_str());
        std::printf("pipeline\n");
        return 0;
    }
    const bool all = a.backends.empty() || a.backends.front() == "all";
    const std::vector<std::string> names =
        all ? std::vector<std::string>{"native", "opencl", "vulkan"} : a.backends;
    std::vector<Result> results;
    Stages stages(a);
    for (const std::string& name : names) {
        std::shared_ptr<device::Device> device;
        try {
            device = device::open_device(name, a.threads);
        } catch (const Error& error) {
            if (!all) throw;
            std::printf("%s: skipped: %s\n", name.c_str(), error.what());
            continue;
        }
        const auto one = measure_backend(device, a, stages);
        results.insert(results.end(), one.begin(), one.end());
    }
    const auto peers = stages.peers();
    results.insert(results.end(), peers.begin(), peers.end());
    if (a.peers) {
        for (const auto compare : {compare_with_trimesh, compare_with_bullet})
            if (const auto peer = compare(results)) results.push_back(*peer);
    }
    if (!a.json.empty()) write_json(a.json, results);
    if (!a.csv.empty()) write_csv(a.csv, results);
    return hashes_agree(results) ? 0 : 1;
}

}  // namespace
}  // namespace topple::perf

int main(int argc, char** argv) {
    using namespace topple;
    CLI::App app{
        "Measures every kernel on every backend, as throughput and as share of what the backend "
        "can do, and the "
        "whole pipeline by stage."};
    perf::Arguments a;
    app.add_option("--filter", a.filters, "Only cases whose name contains this; may be repeated");
    app.add_option("--backend", a.backends, "native, opencl, vulkan or all")
        ->delimiter(',')
        ->default_str("all");
    app.add_option("--json", a.json, "Write all samples, counts and hashes to this file");
    app.add_option("--csv", a.csv, "Write one line per case to this file");
    app.add_option("--runs", a.measure.runs,
                   "Samples of each kernel (default: 7 to 100, for --seconds)");
    app.add_option("--seconds", a.measure.seconds, "Time for each kernel")->capture_default_str();
    app.add_option("--stage-runs", a.stage_runs, "Runs of the stages; 0: none")
        ->capture_default_str();
    app.add_flag("!--no-peers", a.peers,
                 "Leave out PCL, OctoMap, trimesh and Bullet beside the stages");
    app.add_option("--pipeline-runs", a.pipeline.runs, "Parses of the whole room; 0: none")
        ->capture_default_str();
    app.add_option("--pipeline-frames", a.pipeline.frames, "Frames of the walk through the room")
        ->capture_default_str();
    app.add_option("--seed", a.pipeline.seed, "Seed of the room")->capture_default_str();
    app.add_option("--threads", a.threads, "Threads of the native backend (0: all cores)")
        ->capture_default_str();
    app.add_flag("--list", a.list, "Print the names of the cases");
    CLI11_PARSE(app, argc, argv);
    try {
        return perf::run(a);
    } catch (const Error& error) {
        std::fprintf(stderr, "topple_perf: %s\n", error.what());
        return error.kind() == ErrorKind::input ? 1 : error.kind() == ErrorKind::usage ? 2 : 3;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "topple_perf: %s\n", error.what());
        return 1;
    }
}

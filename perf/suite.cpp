// SPDX-License-Identifier: MIT
#include "perf/suite.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>

#include "perf/field_stages.h"
#include "perf/landscape_stages.h"
#include "perf/report.h"
#include "perf/stage_cases.h"
#include "topple/device.h"
#include "topple/error.h"

namespace topple::perf {
namespace {

bool is_probe(const std::string& name) {
    return name == "triad" || name == "multiply_add" || name == "divide" || name == "gather";
}

bool wanted(const SuiteOptions& a, const std::string& name) {
    return a.filters.empty() ||
           std::any_of(a.filters.begin(), a.filters.end(),
                       [&](const std::string& f) { return name.find(f) != std::string::npos; });
}

// The stages' scene is made once, on the first device.
class Stages {
  public:
    explicit Stages(const SuiteOptions& arguments) : a_(arguments) {}

    bool wanted() const { return any(stage_names()) || any(field_names()); }
    std::vector<Result> measure(device::Device& device) {
        if (!scene_) scene_ = make_stage_scene(device);
        std::vector<Result> results;
        if (any(stage_names())) {
            results = measure_stages(device, *scene_, a_.stage_runs).results;
        }
        if (any(field_names())) {
            const auto fields = measure_fields(device, *scene_, a_.stage_runs);
            results.insert(results.end(), fields.begin(), fields.end());
        }
        std::erase_if(results, [&](const Result& r) { return !perf::wanted(a_, r.name); });
        return results;
    }

  private:
    bool any(const std::vector<std::string>& names) const {
        return a_.stage_runs > 0 &&
               std::any_of(names.begin(), names.end(),
                           [&](const std::string& name) { return perf::wanted(a_, name); });
    }

    const SuiteOptions& a_;
    std::optional<StageScene> scene_;
};

bool landscapes_wanted(const SuiteOptions& a) {
    const auto names = landscape_names();
    return a.stage_runs > 0 &&
           std::any_of(names.begin(), names.end(), [&](const auto& n) { return wanted(a, n); });
}

std::vector<Result> measure_backend(const std::shared_ptr<device::Device>& device,
                                    const SuiteOptions& a, Stages& stages) {
    std::vector<Result> results;
    const bool landscapes = landscapes_wanted(a);
    const bool any_kernel = stages.wanted() || landscapes ||
                            std::any_of(all_cases().begin(), all_cases().end(),
                                        [&](const Case& c) { return wanted(a, c.name); });
    for (const Case& test : all_cases()) {
        // The probes are the yardstick of all others.
        if (!wanted(a, test.name) && !(a.roofline && any_kernel && is_probe(test.name))) continue;
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
    if ((wanted(a, "pipeline") || wanted(a, "export")) && a.pipeline.runs > 0) {
        scenes::Score score;
        const auto whole = measure_pipeline(device, a.pipeline, score);
        print_results(whole);
        print_score(score);
        results.insert(results.end(), whole.begin(), whole.end());
    }
    return results;
}

}  // namespace

std::vector<std::string> case_names() {
    std::vector<std::string> out;
    for (const Case& test : all_cases()) out.emplace_back(test.name);
    for (const auto& names : {stage_names(), field_names(), landscape_names()})
        out.insert(out.end(), names.begin(), names.end());
    out.emplace_back("pipeline");
    out.emplace_back("export");
    return out;
}

bool hashes_agree(const std::vector<Result>& results) {
    std::map<std::string, const Result*> first;
    bool agree = true;
    for (const Result& r : results) {
        const auto [at, is_new] = first.emplace(r.name, &r);
        if (is_new || at->second->hash == r.hash) continue;
        std::fprintf(stderr, "topple: %s: the result on %s differs from the one on %s\n",
                     r.name.c_str(), r.backend.c_str(), at->second->backend.c_str());
        agree = false;
    }
    return agree;
}

std::vector<Result> run_suite(const SuiteOptions& a) {
    const auto known = case_names();
    for (const std::string& filter : a.filters) {
        if (std::none_of(known.begin(), known.end(),
                         [&](const std::string& name) { return name.find(filter) != name.npos; }))
            throw Error(ErrorKind::usage,
                        "--filter " + filter + ": no case's name contains it; --list has all");
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
    return results;
}

}  // namespace topple::perf

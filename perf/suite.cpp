// SPDX-License-Identifier: MIT
#include "perf/suite.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "perf/cases/cases.h"
#include "perf/field_stages.h"
#include "perf/kernels/report.h"
#include "perf/landscape_stages.h"
#include "perf/stage_cases.h"

namespace topple::perf {
namespace {

void print_score(const scenes::Score& s) {
    std::printf(
        "\nscore: parts mIoU %.3f, Hamming %.3f, missing %.3f, false alarm %.3f; objects mIoU "
        "%.3f\n",
        s.parts.miou, s.parts.hamming, s.parts.missing, s.parts.false_alarm, s.objects.miou);
    std::printf(
        "       volume precision %.3f, recall %.3f; fixed recall %.3f, precision %.3f; support "
        "recall %.3f, precision %.3f; "
        "gravity %.2f deg\n",
        s.volume.precision.value, s.volume.recall.value, s.relations.fixed_recall.value,
        s.relations.fixed_precision.value, s.relations.support_recall.value,
        s.relations.support_precision.value, s.gravity_deg);
    std::fflush(stdout);
}

// The stages' scene is made once, on the first device.
class Stages {
  public:
    explicit Stages(const SuiteOptions& arguments) : a_(arguments) {}

    bool any_wanted() const { return any(stage_names()) || any(field_names()); }
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
        std::erase_if(results, [&](const Result& r) { return !wanted(a_.filters, r.name); });
        return results;
    }

  private:
    bool any(const std::vector<std::string>& names) const {
        return a_.stage_runs > 0 &&
               std::any_of(names.begin(), names.end(),
                           [&](const std::string& name) { return wanted(a_.filters, name); });
    }

    const SuiteOptions& a_;
    std::optional<StageScene> scene_;
};

bool landscapes_wanted(const SuiteOptions& a) {
    const auto names = landscape_names();
    return a.stage_runs > 0 && std::any_of(names.begin(), names.end(),
                                           [&](const auto& n) { return wanted(a.filters, n); });
}

std::vector<Result> measure_backend(const std::shared_ptr<device::Device>& device,
                                    const SuiteOptions& a, Stages& stages) {
    const bool landscapes = landscapes_wanted(a);
    const bool any =
        stages.any_wanted() || landscapes ||
        std::ranges::any_of(all_cases(), [&](const Case& c) { return wanted(a.filters, c.name); });
    std::vector<Result> results =
        measure_cases(*device, all_cases(), a.filters, a.roofline && any, a.measure);
    if (stages.any_wanted()) {
        const auto whole = stages.measure(*device);
        results.insert(results.end(), whole.begin(), whole.end());
    }
    if (landscapes) {
        const auto whole = measure_landscapes(*device, a.stage_runs);
        std::copy_if(whole.begin(), whole.end(), std::back_inserter(results),
                     [&](const Result& r) { return wanted(a.filters, r.name); });
    }
    apply_roofline(results);
    print_results(results);
    if ((wanted(a.filters, "pipeline") || wanted(a.filters, "export")) && a.pipeline.runs > 0) {
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

std::vector<Result> run_suite(const SuiteOptions& a) {
    check_filters(a.filters, case_names());
    std::vector<Result> results;
    Stages stages(a);
    each_backend(a.backends, a.threads, [&](const std::shared_ptr<device::Device>& device) {
        const auto one = measure_backend(device, a, stages);
        results.insert(results.end(), one.begin(), one.end());
    });
    return results;
}

}  // namespace topple::perf

// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "perf/kernels/kernel_suite.h"
#include "perf/pipeline_case.h"

// All that is measured: every kernel, the stages and the whole parse, on every backend.
namespace topple::perf {

struct SuiteOptions {
    std::vector<std::string> backends;  // empty or "all": each that can be used
    std::vector<std::string> filters;   // parts of the names wanted; empty: all
    MeasureOptions measure;
    PipelineOptions pipeline;
    unsigned threads = 0;     // of the native backend; 0: all cores
    unsigned stage_runs = 5;  // of each stage; 0: none
    bool roofline = true;     // the probes, too, whatever the filters, for the shares
};

// In the order in which they are measured.
std::vector<std::string> case_names();

// Measures and prints, backend by backend. Throws Error: usage (a filter that no case's name
// contains, an unknown backend), device (a backend that was named and can't be used).
std::vector<Result> run_suite(const SuiteOptions& options);

}  // namespace topple::perf

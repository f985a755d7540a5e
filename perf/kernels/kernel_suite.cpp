// SPDX-License-Identifier: MIT
#include "perf/kernels/kernel_suite.h"

#include <algorithm>
#include <cstdio>
#include <map>

#include "perf/kernels/probes.h"
#include "topple/device.h"
#include "topple/error.h"

namespace topple::perf {
namespace {

bool is_probe(const Case& test) {
    return std::ranges::any_of(probes, [&](const Case& p) { return p.prepare == test.prepare; });
}

}  // namespace

bool wanted(const std::vector<std::string>& filters, const std::string& name) {
    return filters.empty() || std::ranges::any_of(filters, [&](const std::string& f) {
               return name.find(f) != std::string::npos;
           });
}

void check_filters(const std::vector<std::string>& filters, const std::vector<std::string>& names) {
    for (const std::string& filter : filters) {
        if (std::ranges::none_of(names, [&](const auto& name) { return wanted({filter}, name); }))
            throw Error(ErrorKind::usage,
                        "--filter " + filter + ": no case's name contains it; --list has all");
    }
}

void each_backend(const std::vector<std::string>& names, unsigned threads,
                  const std::function<void(const std::shared_ptr<device::Device>&)>& each) {
    const bool all = names.empty() || names.front() == "all";
    for (const std::string& name :
         all ? std::vector<std::string>{"native", "opencl", "vulkan"} : names) {
        std::shared_ptr<device::Device> device;
        try {
            device = device::open_device(name, threads);
        } catch (const Error& error) {
            if (!all) throw;
            std::printf("%s: skipped: %s\n", name.c_str(), error.what());
            continue;
        }
        each(device);
    }
}

std::vector<Result> measure_cases(device::Device& device, std::span<const Case> cases,
                                  const std::vector<std::string>& filters, bool probed,
                                  const MeasureOptions& options) {
    std::vector<Result> results;
    for (const Case& test : cases) {
        if (wanted(filters, test.name) || (probed && is_probe(test)))
            results.push_back(measure(device, test, options));
    }
    return results;
}

bool hashes_agree(const std::vector<Result>& results) {
    std::map<std::string, const Result*> first;
    bool agree = true;
    for (const Result& r : results) {
        const auto [at, is_new] = first.emplace(r.name, &r);
        if (is_new || at->second->hash == r.hash) continue;
        std::fprintf(stderr, "perf: %s: the result on %s differs from the one on %s\n",
                     r.name.c_str(), r.backend.c_str(), at->second->backend.c_str());
        agree = false;
    }
    return agree;
}

}  // namespace topple::perf

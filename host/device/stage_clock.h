// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "device/cancelling.h"
#include "device/trace.h"
#include "topple/parse.h"

namespace topple {

// Times the stages of a parse, tells its progress, and notices that it was cancelled.
class StageClock {
  public:
    StageClock(std::vector<std::pair<std::string, double>>& timings, const ParseOptions& options)
        : timings_(timings), options_(options) {}

    // Runs one stage and books its time under `name`; the same name again adds to it.
    template <class F>
    auto operator()(const std::string& name, F stage) {
        end_if_cancelled(options_);
        if (options_.progress) options_.progress(name, 0);
        // Its place is made before: what ends a stage may be that there is no memory.
        Book book{*this, place_of(name), std::chrono::steady_clock::now()};
        const device::TraceSpan span(trace_.get(), "stage", name);
        try {
            return stage();
        } catch (const device::OutOfMemory& error) {  // it knows nothing of voxels
            throw Error(error.kind(),
                        error.what() + std::string("; use a larger voxel_m (--voxel)"));
        }
    }
    void progress(const std::string& name, double done) const {
        end_if_cancelled(options_);
        if (options_.progress) options_.progress(name, done);
    }

  private:
    struct Book {
        StageClock& clock;
        std::size_t place;
        std::chrono::steady_clock::time_point start;
        ~Book() {
            clock.timings_[place].second +=
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        }
    };
    std::size_t place_of(const std::string& name) {
        for (std::size_t n = 0; n < timings_.size(); ++n)
            if (timings_[n].first == name) return n;
        timings_.emplace_back(name, 0.0);
        return timings_.size() - 1;
    }
    std::vector<std::pair<std::string, double>>& timings_;
    const ParseOptions& options_;
    std::shared_ptr<device::Trace> trace_ = device::Trace::of_environment();
};

}  // namespace topple

// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/cancelling.h"
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
        const auto start = std::chrono::steady_clock::now();
        struct Book {
            StageClock& clock;
            const std::string& name;
            std::chrono::steady_clock::time_point start;
            ~Book() { clock.book(name, start); }
        } book{*this, name, start};
        return stage();
    }
    void progress(const std::string& name, double done) const {
        end_if_cancelled(options_);
        if (options_.progress) options_.progress(name, done);
    }

  private:
    void book(const std::string& name, std::chrono::steady_clock::time_point start) {
        const double s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        for (auto& [n, t] : timings_) {
            if (n == name) {
                t += s;
                return;
            }
        }
        timings_.emplace_back(name, s);
    }
    std::vector<std::pair<std::string, double>>& timings_;
    const ParseOptions& options_;
};

}  // namespace topple

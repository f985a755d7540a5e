// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

namespace topple::cli {

// What a long run is at, on stderr. On a terminal one line that is overwritten: the time so far,
// the stage, what it does and how far it is. Elsewhere a line per stage, ended by its seconds.
class Progress {
  public:
    explicit Progress(bool quiet);
    void operator()(const std::string& stage, double done);
    // Ends the line of the last stage. Whatever else goes to stderr comes after this.
    void finish();

  private:
    using Clock = std::chrono::steady_clock;
    bool quiet_, terminal_;
    std::string stage_;  // that runs; empty: none
    Clock::time_point start_, stage_start_;
};

}  // namespace topple::cli

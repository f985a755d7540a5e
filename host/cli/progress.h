// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

namespace topple::cli {

// What a long run is at, on stderr. On a terminal one line that is overwritten: the time so far,
// how much of the run is done, the stage, what it does, and of longer runs what time they have
// left. Elsewhere a line per stage, ended by its seconds; a stage of minutes tells twice a minute
// how far the run is, each time in a line that ends with it.
class Progress {
  public:
    explicit Progress(bool quiet);
    void operator()(const std::string& stage, double done);  // done: of the run; 0: not known
    // Ends the line of the last stage. Whatever else goes to stderr comes after this.
    void finish();

  private:
    std::string time_left(double done);

    using Clock = std::chrono::steady_clock;
    bool quiet_, terminal_;
    bool line_begun_ = false;  // where there is no terminal: what comes next ends a line
    std::string stage_;        // that runs; empty: none
    Clock::time_point start_, stage_start_, told_;
    // How far the run was early on, and when.
    double first_done_ = 0, first_s_ = 0;
};

}  // namespace topple::cli

// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

namespace topple::cli {

// What a long run is at, on stderr. On a terminal one line that is overwritten: the time so far,
// the stage, what it does, how far it is, and of longer stages what time they have left. Elsewhere
// a line per stage, ended by its seconds; a stage of minutes tells twice a minute how far it is,
// each time in a line that ends with it.
class Progress {
  public:
    explicit Progress(bool quiet);
    void operator()(const std::string& stage, double done);
    // Ends the line of the last stage. Whatever else goes to stderr comes after this.
    void finish();

  private:
    std::string time_left(double done);

    using Clock = std::chrono::steady_clock;
    bool quiet_, terminal_;
    bool line_begun_ = false;  // where there is no terminal: what comes next ends a line
    std::string stage_;        // that runs; empty: none
    Clock::time_point start_, stage_start_, told_;
    // Of the stage: how far it was early on, and when.
    double first_done_ = 0, first_s_ = 0;
};

}  // namespace topple::cli

// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include "cli/interrupt.h"
#include "cli/progress.h"
#include "topple/parse.h"

namespace topple::cli {

// Calls work(progress), which runs long by the options: their progress is shown, and where a signal
// ended the work that is said, with what `left` then tells of it. Returns the exit code.
template <class Work>
int run_long(bool quiet, ParseOptions& options, const Work& work,
             const std::function<std::string()>& left = {}) {
    Progress progress(quiet);
    options.progress = [&](const std::string& stage, double done) { progress(stage, done); };
    try {
        work(progress);
    } catch (...) {
        progress.finish();
        if (interrupted() != 0) return interrupted_exit(left ? left() : "");
        throw;
    }
    return 0;
}

}  // namespace topple::cli

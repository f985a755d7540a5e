// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include "cli/interrupt.h"
#include "cli/progress.h"

namespace topple::cli {

// Calls work(progress), which runs long. Where a signal ended it that is said, with what `left`
// then tells of it. Returns the exit code.
template <class Work>
int run_long(bool quiet, const Work& work, const std::function<std::string()>& left = {}) {
    Progress progress(quiet);
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

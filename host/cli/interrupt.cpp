// SPDX-License-Identifier: MIT
#include "cli/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>

#include "io/output_folder.h"

namespace topple::cli {
namespace {

std::atomic<int> signal_that_came{0};
static_assert(std::atomic<int>::is_always_lock_free);

void interrupt(int signal) {
    if (signal_that_came.exchange(signal) == 0) return;
    io::remove_pending_outputs();
    _exit(128 + signal);
}

}  // namespace

void catch_interrupts() {
    std::signal(SIGINT, interrupt);
    std::signal(SIGTERM, interrupt);
}

int interrupted() {
    return signal_that_came.load();
}

int interrupted_exit(const std::string& left) {
    std::fprintf(stderr, "topple: interrupted; nothing was written%s\n", left.c_str());
    return 128 + interrupted();
}

}  // namespace topple::cli

// SPDX-License-Identifier: MIT
#include "cli/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>

#include "cli/print.h"
#include "io/pending_outputs.h"

namespace topple::cli {
namespace {

std::atomic<int> signal_that_came{0};
std::atomic<bool> is_polled{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

void interrupt(int signal) {
    int none = 0;
    const bool first = signal_that_came.compare_exchange_strong(none, signal);
    if (is_polled.load() && (first || signal == SIGPIPE)) return;
    io::remove_pending_outputs();
    _exit(128 + signal);
}

}  // namespace

void end_on_signals() {
    for (const int signal : {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGPIPE, SIGXCPU}) {
        struct sigaction now {
        }, action{};
        ::sigaction(signal, nullptr, &now);
        if ((signal == SIGHUP || signal == SIGPIPE) && now.sa_handler == SIG_IGN) continue;
        action.sa_handler = interrupt;
        action.sa_flags = SA_RESTART;
        ::sigfillset(&action.sa_mask);
        ::sigaction(signal, &action, nullptr);
    }
}

void catch_interrupts() {
    is_polled.store(true);
}

int interrupted() {
    return signal_that_came.load();
}

int interrupted_exit(const std::string& left) {
    print_to(stderr, "topple: interrupted; nothing was written%s\n", left.c_str());
    return 128 + interrupted();
}

}  // namespace topple::cli

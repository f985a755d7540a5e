// SPDX-License-Identifier: MIT
#include "busy.h"

#include <pthread.h>

#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <mutex>

#include "topple/error.h"

namespace topple::python {
namespace {

struct State {
    std::mutex mutex;
    std::condition_variable idle;
    unsigned busy = 0;
    bool ending = false;
};

thread_local unsigned busy_here = 0;

// Never destroyed: threads may come here while the process ends.
State* only = new State;

// A process that is forked off has no threads but one. None are at work in it; and it ends without
// the libraries' own ends, of which those that wait for their threads, as log4cplus' does, would
// wait for ever.
void begin_anew() {
    only = new State;
    ::on_exit(
        [](int status, void*) {
            std::fflush(nullptr);
            std::_Exit(status);
        },
        nullptr);
}

[[maybe_unused]] const int at_fork = ::pthread_atfork(nullptr, nullptr, begin_anew);

State& state() {
    return *only;
}

}  // namespace

Busy::Busy() {
    const std::lock_guard lock(state().mutex);
    if (state().ending) throw Error(ErrorKind::cancelled, "cancelled");
    ++state().busy;
    ++busy_here;
}

Busy::~Busy() {
    --busy_here;
    const std::lock_guard lock(state().mutex);
    if (--state().busy == 0) state().idle.notify_all();
}

bool Busy::here() {
    return busy_here > 0;
}

bool Busy::must_stop() {
    const std::lock_guard lock(state().mutex);
    return state().ending;
}

void Busy::stop_all() {
    std::unique_lock lock(state().mutex);
    state().ending = true;
    state().idle.wait(lock, [] { return state().busy == 0; });
}

}  // namespace topple::python

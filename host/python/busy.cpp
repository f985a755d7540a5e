// SPDX-License-Identifier: MIT
#include "busy.h"

#include <condition_variable>
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

// Never destroyed: threads may come here while the process ends.
State& state() {
    static State* const only = new State;
    return *only;
}

}  // namespace

Busy::Busy() {
    const std::lock_guard lock(state().mutex);
    if (state().ending) throw Error(ErrorKind::cancelled, "cancelled");
    ++state().busy;
}

Busy::~Busy() {
    const std::lock_guard lock(state().mutex);
    if (--state().busy == 0) state().idle.notify_all();
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

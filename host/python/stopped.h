// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <memory>

#include "busy.h"
#include "topple/error.h"

namespace topple::python {

// Whether the interpreter ends, or a signal such as Ctrl-C came: then Python's error is set. For
// long work to poll, from any thread.
class Stopped {
  public:
    bool operator()() const {
        if (Busy::must_stop()) return true;
        const auto now = Clock::now().time_since_epoch().count();
        auto asked = asked_->load();
        constexpr Clock::duration pause = std::chrono::milliseconds(50);
        if (now - asked < pause.count() || !asked_->compare_exchange_strong(asked, now))
            return false;
        const pybind11::gil_scoped_acquire acquire;
        return PyErr_CheckSignals() != 0;
    }

  private:
    using Clock = std::chrono::steady_clock;
    std::shared_ptr<std::atomic<Clock::rep>> asked_ = std::make_shared<std::atomic<Clock::rep>>(0);
};

// What work() gives, which polls Stopped, without the interpreter's lock.
template <class Work>
auto stoppable(const Work& work) {
    try {
        return unlocked(work);
    } catch (const Error&) {
        if (PyErr_Occurred()) throw pybind11::error_already_set();
        throw;
    }
}

}  // namespace topple::python

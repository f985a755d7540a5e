// SPDX-License-Identifier: MIT
#pragma once

#include "pybind.h"

namespace topple::python {

// Lives while a thread works without the interpreter's lock, from before it lets go of it until it
// has it back. A thread that comes back to an interpreter which has ended is ended by Python in the
// midst of its functions, which takes the process along: so the interpreter's end stops what is at
// work, in threads that are daemons, and waits for it.
class Busy {
  public:
    Busy();  // throws Error(cancelled) where the interpreter is ending
    ~Busy();
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;

    // Whether this thread is: it may ask for the interpreter's lock.
    static bool here();
    // Whether the interpreter is ending: for long work to poll.
    static bool must_stop();
    // Called at the interpreter's end, without its lock: stops and waits for all.
    static void stop_all();
};

// What work() gives, which is called without the interpreter's lock.
template <class Work>
auto unlocked(const Work& work) {
    const Busy busy;
    const pybind11::gil_scoped_release release;
    return work();
}

}  // namespace topple::python

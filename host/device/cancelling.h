// SPDX-License-Identifier: MIT
#pragma once

#include "core/thread_pool.h"
#include "topple/error.h"
#include "topple/kernels/device.h"
#include "topple/parse.h"

namespace topple {

// Throws Error(cancelled) where the parse was cancelled.
inline void end_if_cancelled(const ParseOptions& options) {
    if (options.cancelled && options.cancelled()) throw Error(ErrorKind::cancelled, "cancelled");
}

// While it lives, a parse that is cancelled ends within its stages, too: wherever they share out
// work among the device's threads, and where they poll these in between.
class Cancelling {
  public:
    Cancelling(device::Device& device, const ParseOptions& options)
        : polling_(device.threads(), [&options] { end_if_cancelled(options); }) {}

  private:
    ThreadPool::Polling polling_;
};

}  // namespace topple

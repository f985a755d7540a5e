// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "topple/kernels/buffer.h"

namespace topple::device {

// Collects dispatches and runs them as one batch.
//
//     Queue queue(device);
//     queue.add<kernels::Triad>(count, {.a = a, .b = b, .dst = c}, {.count = count, .scale = 2});
//     queue.submit();  // or run(), which waits
//     std::vector<float> sums = c.download();  // waits for the last batch that binds c
//
// K is a kernel description generated from kernels/<name>.kernel; its Args struct has one member
// per binding, by name, so a missing or mistyped buffer does not compile.
class Queue {
  public:
    explicit Queue(Device& device) : device_(device) {}

    // `count` is the number of elements, or of work-groups where the kernel works group by group.
    // 0 adds nothing.
    template <class K>
    void add(std::uint64_t count, const typename K::Args& args, const typename K::Params& params) {
        static_assert(sizeof(typename K::Params) <= 128 &&
                      std::is_trivially_copyable_v<typename K::Params>);
        if (count == 0) return;
        std::vector<BoundRange> ranges;
        K::bind(args, ranges);
        add(K::source(), count, std::move(ranges), std::as_bytes(std::span(&params, 1)));
    }

    // The same of a kernel that is known at run time only: a range for each binding, in order,
    // and the parameters as they lie in memory. Throws Error(usage) where there are more or fewer
    // than the kernel has.
    void add(const KernelSource& kernel, std::uint64_t count, std::vector<BoundRange> ranges,
             std::span<const std::byte> params);

    // Begins what was added since the last time, as Device::submit() says: after all batches of the
    // device before it, whichever queue they came from. The buffers may be freed at once.
    Event submit();
    // The same, and waits.
    void run();

    Device& device() const { return device_; }

  private:
    std::uint64_t groups_for(const KernelSource& kernel, std::uint64_t count) const;
    void check(const Dispatch& dispatch) const;
    // Taken out first: a failed run must not leave its dispatches behind for the next one.
    std::vector<Dispatch> take() { return std::exchange(dispatches_, {}); }

    Device& device_;
    std::vector<Dispatch> dispatches_;
};

}  // namespace topple::device

// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include "topple/kernels/buffer.h"

namespace topple::device {

// Collects dispatches and runs them as one batch with one wait.
//
//     Queue queue(device);
//     queue.add<kernels::Triad>(count, {.a = a, .b = b, .dst = c}, {.count = count, .scale = 2});
//     queue.run();
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
        Dispatch dispatch;
        dispatch.kernel = &K::source();
        dispatch.groups = groups_for(*dispatch.kernel, count);
        K::bind(args, dispatch.ranges);
        const auto* bytes = reinterpret_cast<const std::byte*>(&params);
        dispatch.params.assign(bytes, bytes + sizeof(params));
        check(dispatch);
        dispatches_.push_back(std::move(dispatch));
    }

    // Runs what was added since the last run, in order, and waits.
    void run();

    Device& device() const { return device_; }

  private:
    std::uint64_t groups_for(const KernelSource& kernel, std::uint64_t count) const;
    void check(const Dispatch& dispatch) const;

    Device& device_;
    std::vector<Dispatch> dispatches_;
};

}  // namespace topple::device

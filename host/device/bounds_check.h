// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "topple/kernels/buffer.h"

namespace topple::device {

// Whether TOPPLE_CHECK=bounds is in the environment. Throws Error(usage) where it is something
// else.
bool bounds_check_wanted();

// Has a batch run the checked forms of its kernels, which access nothing outside of what is bound.
class BoundsCheck {
  public:
    // Throws Error(device) where a kernel has no checked form.
    BoundsCheck(Device& device, std::vector<Dispatch>& batch);

    // Once the batch has ended: throws Error(device) with the first access outside of the first
    // dispatch that has one.
    void throw_if_found();
    Memory& memory() const;  // what it reads for that

  private:
    std::vector<const KernelSource*> kernels_;
    std::vector<std::uint32_t> words_;
    Buffer<std::uint32_t> report_;
};

}  // namespace topple::device

// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <list>
#include <map>
#include <memory>

#include "topple/kernels/device.h"

namespace topple::device {

// Memory that is kept for reuse: a GPU's driver maps and clears what it allocates. The longest
// unused goes first where there is more than the limit. No batch in flight may bind what it is
// given.
class MemoryPool {
  public:
    // Bytes to keep; none until this is called.
    void limit(std::uint64_t bytes) { most_bytes_ = bytes; }
    // What to allocate for that many bytes, so that it can serve others: at most a quarter more.
    std::uint64_t capacity_for(std::uint64_t bytes) const;
    // Memory of that capacity, or null.
    std::unique_ptr<Memory> take(std::uint64_t capacity);
    void give(std::unique_ptr<Memory> memory);
    void trim() { shrink_to(0, 0); }

  private:
    using Kept = std::list<std::unique_ptr<Memory>>;
    void shrink_to(std::uint64_t bytes, std::size_t count);

    Kept kept_;                                                        // the longest unused first
    std::map<std::uint64_t, std::deque<Kept::iterator>> of_capacity_;  // each in that order, too
    std::uint64_t most_bytes_ = 0, bytes_ = 0;
};

}  // namespace topple::device

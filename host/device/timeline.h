// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <vector>

#include "device/bounds_check.h"
#include "device/memory_pool.h"
#include "topple/kernels/device.h"

namespace topple::device {

// A batch that a backend has begun, and what it needs until it ends.
class Running {
  public:
    virtual ~Running() = default;
    virtual bool ended() = 0;
    // Returns when it has ended: with its error, or null. Throws only what a poll throws meanwhile.
    virtual std::exception_ptr wait() = 0;
};

// The batches of one device, numbered from 1 in the order in which they begin, and so end; and the
// memory that was given back, which those in flight keep alive.
class Timeline {
  public:
    // Takes up a batch, and says its number. running: null where it has ended. checks: of its
    // indices, or null. bound: its memory, each once.
    std::uint64_t begun(std::unique_ptr<Running> running, std::unique_ptr<BoundsCheck> checks,
                        std::vector<Memory*> bound);

    bool in_flight() const { return !flights_.empty(); }
    bool ended(std::uint64_t batch);
    // Waits for it, and so for all before it.
    void finish(std::uint64_t batch);
    void finish_all() { finish(last_); }
    // Throws the first error of the batches up to that one, and forgets all of theirs: what follows
    // may come of it.
    void throw_failure(std::uint64_t batch);

    // Keeps it until no batch in flight binds it; the caller's own is waited for.
    void give_back(std::unique_ptr<Memory> memory);
    MemoryPool& pool() { return pool_; }

  private:
    struct Flight {
        std::uint64_t batch;
        std::unique_ptr<Running> running;
        std::unique_ptr<BoundsCheck> checks;
        std::vector<Memory*> bound;
        std::vector<std::unique_ptr<Memory>> given_back;  // of which it is the last batch
    };
    struct Failure {
        std::uint64_t batch;
        std::exception_ptr error;
    };
    void finish_first();
    void retire(std::exception_ptr error);

    std::deque<Flight> flights_;
    std::vector<Failure> failures_;  // in the batches' order
    std::uint64_t last_ = 0;
    std::uint64_t held_bytes_ = 0;  // given back, in flight
    MemoryPool pool_;
};

}  // namespace topple::device

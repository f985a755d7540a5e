// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "topple/kernels/queue.h"

// What is measured: one case for each kernel. Inputs are the same on every backend, so that the
// hashes of the results must be, too. topple_add_kernel_cases makes a program of a project's own.
namespace topple::perf {

// The work of one run, independent of how a backend does it.
struct Work {
    double items = 0;
    const char* unit = "items";
    // Least traffic with memory: every input and output once. What is read again from a cache is
    // free.
    double bytes = 0;
    // Float and integer operations of the kernel's inner loops, as its source spells them out.
    double operations = 0;
    double divisions = 0;  // and square roots; they count among the operations, too
    // Loads whose places differ from lane to lane and follow from data.
    double gathers = 0;
};

// A case with its buffers on a device. The functions share them.
struct Prepared {
    Work work;
    std::function<void(device::Queue&)> enqueue;  // one run
    std::function<void()> reset;  // restores what a run changes in place; empty where nothing is
    std::function<std::uint64_t()> hash;  // of the outputs of the last run
};

struct Case {
    const char* name;  // the kernel's
    Prepared (*prepare)(device::Device&);
};

// FNV-1a over 32-bit words.
class Hash {
  public:
    template <class T>
    Hash& add(const std::vector<T>& values) {
        static_assert(sizeof(T) == 4);
        for (const T& v : values) word(std::bit_cast<std::uint32_t>(v));
        return *this;
    }
    Hash& word(std::uint32_t v) {
        value_ = (value_ ^ v) * 0x100000001b3ULL;
        return *this;
    }
    std::uint64_t value() const { return value_; }

  private:
    std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

// A buffer with these elements, at least one.
template <class T>
device::Buffer<T> upload(device::Device& device, const std::vector<T>& data, const char* name) {
    return device::Buffer<T>(device, std::span<const T>(data), name);
}

}  // namespace topple::perf

// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace topple::test {

// A 32-bit permuted congruential generator (O'Neill 2014): the same numbers on every machine.
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed * 2 + 1) { word(); }
    std::uint32_t word() {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005ULL + 1442695040888963407ULL;
        const auto mixed = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
        return std::rotr(mixed, static_cast<int>(old >> 59));
    }
    std::uint32_t below(std::size_t limit) { return static_cast<std::uint32_t>(word() % limit); }
    double uniform() { return word() * 0x1p-32; }  // [0, 1)
    // What floats hold, in [low, high).
    float uniform(float low, float high) {
        return low + (high - low) * (static_cast<float>(word() >> 8) * 0x1p-24f);
    }
    std::vector<float> floats(std::size_t count, float low, float high) {
        std::vector<float> out(count);
        for (float& v : out) v = uniform(low, high);
        return out;
    }
    // Durstenfeld's.
    template <class List>
    void shuffle(List& list) {
        for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[below(i)]);
    }
    double normal() {
        return std::sqrt(-2 * std::log(1 - uniform())) * std::cos(2 * M_PI * uniform());
    }

  private:
    std::uint64_t state_;
};

}  // namespace topple::test

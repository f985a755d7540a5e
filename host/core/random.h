// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace topple {

// SplitMix64 (Steele, Lea, Flood 2014). Our own, because the standard library's distributions
// differ between implementations and a seed must mean the same result everywhere.
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
        return z ^ (z >> 31);
    }
    // In [0, 1), 53 bits.
    double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    // In [0, count), count > 0. The bias is below 2^-32 for every count that fits memory.
    std::uint64_t below(std::uint64_t count) {
        return static_cast<std::uint64_t>((static_cast<unsigned __int128>(bits()) * count) >> 64);
    }
    // An independent stream, for parallel parts that must not depend on one another's progress.
    Random split(std::uint64_t stream) const {
        Random r(state_ ^ (0xd1b54a32d192ed03ULL * (stream + 1)));
        r.bits();
        return r;
    }

  private:
    std::uint64_t state_;
};

}  // namespace topple

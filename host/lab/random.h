// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/random.h"

// The scenes' own random numbers: the same seed gives the same scene with every compiler and
// library, which std:: distributions do not promise.
namespace topple::scenes {

// Finaliser of splitmix64 (Steele, Lea & Flood 2014): a bijection that scatters its input.
constexpr std::uint64_t scatter(std::uint64_t v) {
    v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9ULL;
    v = (v ^ (v >> 27)) * 0x94d049bb133111ebULL;
    return v ^ (v >> 31);
}

// Two streams from different seeds, or different `stream` numbers, are unrelated.
class Random : public topple::Random {
  public:
    explicit Random(std::uint64_t seed, std::uint64_t stream = 0)
        : topple::Random(scatter(scatter(seed + 0x9e3779b97f4a7c15ULL) ^
                                 (stream * 0xd1342543de82ef95ULL + 1))) {}

    // In [low, high).
    double operator()(double low, double high) { return uniform(low, high); }
    // In [low, high], both included; the bias of the scaling is below 2^-32.
    int integer(int low, int high) {
        const auto span = static_cast<std::uint64_t>(high - low) + 1;
        return low + static_cast<int>(((bits() >> 32) * span) >> 32);
    }
    // Of one of so many, each as likely.
    std::size_t index(std::size_t count) {
        return static_cast<std::size_t>(integer(0, static_cast<int>(count) - 1));
    }
    bool chance(double probability) { return uniform() < probability; }
    // Approximately standard normal: twelve 10-bit uniforms summed, so that no library's log or cos
    // enters. Variance 1 to 1e-6; never beyond 6.
    double normal() {
        std::uint32_t sum = 0;
        for (int word = 0; word < 2; ++word) {
            const std::uint64_t drawn = bits();
            for (int k = 0; k < 6; ++k)
                sum += static_cast<std::uint32_t>(drawn >> (10 * k)) & 1023u;
        }
        return (static_cast<double>(sum) - 12 * 511.5) / 1024.0;
    }
};

}  // namespace topple::scenes

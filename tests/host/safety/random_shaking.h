// SPDX-License-Identifier: MIT
#pragma once

#include "core/random.h"
#include "standard.h"
#include "topple/input.h"

namespace topple::test {

// Sums of sines under an envelope, 10 s; its peak is 1.
inline Accelerogram random_shaking(std::uint64_t seed) {
    topple::Random random(seed);
    Accelerogram out;
    out.step_s = 0.02;
    out.m_s2.assign(500, 0.0);
    for (int wave = 0; wave < 8; ++wave) {
        const double period_s = random.uniform(0.2, 1.2), phase = random.uniform(0, 6.28);
        for (std::size_t n = 0; n < out.m_s2.size(); ++n) {
            const double t = out.step_s * static_cast<double>(n);
            out.m_s2[n] += std::sin(2 * std::numbers::pi * t / period_s + phase) *
                           std::sin(std::numbers::pi * t / 10);
        }
    }
    const double peak = out.peak_m_s2();
    for (double& a : out.m_s2) a /= peak;
    return out;
}

}  // namespace topple::test

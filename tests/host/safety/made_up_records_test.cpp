// SPDX-License-Identifier: MIT
#include "safety/earthquake/made_up_records.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace topple::safety {
namespace {

double root_mean_square(const std::vector<double>& values, std::size_t from, std::size_t to) {
    double sum = 0;
    for (std::size_t n = from; n < to; ++n) sum += values[n] * values[n];
    return std::sqrt(sum / static_cast<double>(to - from));
}

// Power at a frequency, of the strong part.
double power_at(const std::vector<double>& values, double step_s, double rad_s) {
    double c = 0, s = 0;
    for (std::size_t n = 400; n < 1500; ++n) {
        c += values[n] * std::cos(rad_s * step_s * static_cast<double>(n));
        s += values[n] * std::sin(rad_s * step_s * static_cast<double>(n));
    }
    return (c * c + s * s) / 1100;
}

TEST(MadeUpRecords, AreTheSameFromASeed) {
    const auto all = made_up_records(12, 5), few = made_up_records(3, 5),
               others = made_up_records(3, 6);
    ASSERT_EQ(all.size(), 12u);
    for (std::size_t n = 0; n < few.size(); ++n) {
        EXPECT_EQ(all[n].m_s2, few[n].m_s2);
        EXPECT_EQ(all[n].across_m_s2, few[n].across_m_s2);
        EXPECT_EQ(all[n].up_m_s2, few[n].up_m_s2);
        EXPECT_NE(all[n].m_s2, others[n].m_s2);
    }
    EXPECT_NE(all[0].m_s2, all[6].m_s2) << "the same soil and size";
}

TEST(MadeUpRecords, SwellFadeAndLeaveTheGroundAtRest) {
    for (const Accelerogram& r : made_up_records(12, 1)) {
        EXPECT_NEAR(r.peak_m_s2(), 1, 1e-12);
        ASSERT_EQ(r.across_m_s2.size(), r.m_s2.size());
        ASSERT_EQ(r.up_m_s2.size(), r.m_s2.size());
        double up = 0, velocity = 0;
        for (const double a : r.up_m_s2) up = std::max(up, std::fabs(a));
        for (const double a : r.m_s2) velocity += a * r.step_s;
        EXPECT_NEAR(up, 2.0 / 3, 1e-12);
        // What is left of the motion is a swing of the slow filter, which fades.
        EXPECT_LT(std::fabs(velocity), 0.25 * peak_velocity_m_s(r)) << r.source;
        const std::size_t end = r.m_s2.size();
        EXPECT_LT(root_mean_square(r.m_s2, 0, 50), 0.5 * root_mean_square(r.m_s2, 200, 400));
        EXPECT_LT(root_mean_square(r.m_s2, end - 100, end),
                  0.6 * root_mean_square(r.m_s2, 200, 400));
    }
}

// Peak velocities over peak accelerations of recorded motions lie about 0.05 s on rock to 0.3 s on
// soft ground.
TEST(MadeUpRecords, SofterGroundIsSlower) {
    double ratio[3] = {0, 0, 0};
    const auto records = made_up_records(60, 2);
    for (std::size_t n = 0; n < records.size(); ++n)
        ratio[n % 3] += peak_velocity_m_s(records[n]) / 20;
    EXPECT_LT(0.05, ratio[0]);
    EXPECT_LT(1.2 * ratio[0], ratio[1]);
    EXPECT_LT(1.2 * ratio[1], ratio[2]);
    EXPECT_LT(ratio[2], 0.5);
}

// Kanai and Tajimi's spectrum: over noise that has the same power at all frequencies, that of firm
// ground (15 rad/s, damping 0.6) is highest near 13 rad/s and falls off beyond.
TEST(MadeUpRecords, HaveTheSpectrumOfTheGround) {
    const auto spectrum = [](double w) {
        const double f2 = 15.0 * 15, d = 4 * 0.36 * f2 * w * w, slow2 = 1.5 * 1.5;
        const double ground = (f2 * f2 + d) / ((f2 - w * w) * (f2 - w * w) + d);
        const double slow =
            w * w * w * w / ((slow2 - w * w) * (slow2 - w * w) + 4 * 0.36 * slow2 * w * w);
        return ground * slow;
    };
    double found[3] = {0, 0, 0};
    const double at[3] = {3, 12, 45};
    const auto records = made_up_records(240, 4);
    for (std::size_t n = 0; n < records.size(); n += 6) {  // magnitude 7, firm
        for (int k = 0; k < 3; ++k) {
            for (int around = -5; around <= 5; ++around)
                found[k] +=
                    power_at(records[n].m_s2, records[n].step_s, at[k] * (1 + 0.03 * around));
        }
    }
    for (int k = 1; k < 3; ++k) {
        const double want = spectrum(at[k]) / spectrum(at[0]);
        EXPECT_NEAR(found[k] / found[0] / want, 1, 0.35) << at[k] << " rad/s";
    }
}

}  // namespace
}  // namespace topple::safety

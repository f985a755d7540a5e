// SPDX-License-Identifier: MIT
#include "safety/earthquake/made_up_records.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace topple::safety {
namespace {

double root_mean_square(const std::vector<double>& values, std::size_t from, std::size_t to) {
    double sum = 0;
    for (std::size_t n = from; n < to; ++n) sum += values[n] * values[n];
    return std::sqrt(sum / static_cast<double>(to - from));
}

// Of an oscillator of that period and 5 % damping, m/s^2, in steps of a tenth of the record's.
double response_m_s2(const std::vector<double>& m_s2, double step_s, double period_s) {
    const double w = 2 * std::numbers::pi / period_s, dt = step_s / 10;
    double x = 0, v = 0, most = 0;
    for (std::size_t n = 0; n + 1 < m_s2.size(); ++n) {
        for (int k = 0; k < 10; ++k) {
            const double a = m_s2[n] + (m_s2[n + 1] - m_s2[n]) * (k + 0.5) / 10;
            v += (-a - 2 * 0.05 * w * v - w * w * x) * dt;
            x += v * dt;
        }
        most = std::max(most, std::fabs(x));
    }
    return w * w * most;
}

// Eurocode 8's type 1 spectrum over the peak acceleration (EN 1998-1, 3.2.2.2).
double eurocode(double tb, double tc, double td, double period_s) {
    if (period_s < tb) return 1 + period_s / tb * 1.5;
    if (period_s < tc) return 2.5;
    return period_s < td ? 2.5 * tc / period_s : 2.5 * tc * td / (period_s * period_s);
}

TEST(MadeUpRecords, AreTheSameFromASeed) {
    const auto all = made_up_records(15, 5), few = made_up_records(3, 5),
               others = made_up_records(3, 6);
    ASSERT_EQ(all.size(), 15u);
    for (std::size_t n = 0; n < few.size(); ++n) {
        EXPECT_EQ(all[n].m_s2, few[n].m_s2);
        EXPECT_EQ(all[n].across_m_s2, few[n].across_m_s2);
        EXPECT_EQ(all[n].up_m_s2, few[n].up_m_s2);
        EXPECT_NE(all[n].m_s2, others[n].m_s2);
    }
    EXPECT_NE(all[0].m_s2, all[5].m_s2) << "the same ground type";
}

TEST(MadeUpRecords, SwellFadeAndLeaveTheGroundAtRest) {
    for (const Accelerogram& r : made_up_records(15, 1)) {
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

// The mean spectra are Eurocode 8's: at most a third off at any period, a sixth in the mean, but
// for one factor of all of a ground type.
TEST(MadeUpRecords, HaveEurocodesSpectra) {
    constexpr int each = 20;
    const auto records = made_up_records(5 * each, 2);
    const double corners[5][3] = {
        {0.15, 0.4, 2}, {0.15, 0.5, 2}, {0.2, 0.6, 2}, {0.2, 0.8, 2}, {0.15, 0.5, 2}};
    for (std::size_t type = 0; type < 5; ++type) {
        std::vector<double> off;
        for (const double period_s : {0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0, 1.5, 2.0, 3.0}) {
            double mean = 0;
            for (std::size_t n = type; n < records.size(); n += 5)
                mean += response_m_s2(records[n].m_s2, records[n].step_s, period_s) / each;
            const auto& [tb, tc, td] = corners[type];
            off.push_back(std::log(mean / eurocode(tb, tc, td, period_s)));
        }
        double factor = 0, spread = 0, worst = 0;
        for (const double o : off) factor += o / static_cast<double>(off.size());
        for (const double o : off) {
            spread += std::fabs(o - factor) / static_cast<double>(off.size());
            worst = std::max(worst, std::fabs(o - factor));
        }
        std::printf("ground type %c: %.3f times the spectrum, %.3f off in the mean, %.3f at most\n",
                    static_cast<char>('A' + type), std::exp(factor), spread, worst);
        EXPECT_LT(worst, std::log(4.0 / 3));
        EXPECT_LT(spread, std::log(7.0 / 6));
        EXPECT_NEAR(factor, 0, std::log(1.35));
    }
}

}  // namespace
}  // namespace topple::safety

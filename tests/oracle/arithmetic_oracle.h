// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

// Of the kernels that measure a device's arithmetic and memory.
namespace topple::oracle {

// dst = a + scale * b in double precision, and how far two roundings to float may be from it.
inline void triad(const std::vector<float>& a, const std::vector<float>& b, double scale,
                  std::vector<double>& dst, std::vector<double>& bound) {
    dst.resize(a.size());
    bound.resize(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double product = scale * b[i];
        dst[i] = a[i] + product;
        bound[i] = 1.001 * 0x1p-24 * (std::abs(product) + std::abs(dst[i]));
    }
}

// x <- 0.999f * x + 0.5f, `rounds` times, in double precision. A step's two roundings add at most
// 2^-24 of the product and of the sum, and each later step damps them by 0.999.
inline void multiply_add(const std::vector<float>& x, std::uint32_t rounds,
                         std::vector<double>& out, std::vector<double>& bound) {
    out.assign(x.begin(), x.end());
    bound.assign(x.size(), 0);
    const double factor = 0.999f;
    for (std::size_t i = 0; i < x.size(); ++i) {
        for (std::uint32_t n = 0; n < rounds; ++n) {
            const double product = factor * out[i];
            out[i] = product + 0.5;
            bound[i] = factor * bound[i] +
                       1.001 * 0x1p-24 * (std::abs(product) + std::abs(out[i]) + 2 * bound[i]);
        }
    }
}

// x <- 0.7f / x, `rounds` times, in double precision. Each division adds a relative error of 2^-24
// at most and hands on that of its divisor.
inline void divide(const std::vector<float>& x, std::uint32_t rounds, std::vector<double>& out,
                   std::vector<double>& bound) {
    out.assign(x.begin(), x.end());
    bound.clear();
    const double numerator = 0.7f;
    for (double& value : out) {
        for (std::uint32_t n = 0; n < rounds; ++n) value = numerator / value;
        bound.push_back(1.001 * 0x1p-24 * rounds * std::abs(value));
    }
}

// Of element i the sum, modulo 2^32, of the table's words at the places that follow from the state
// i.
inline std::vector<std::uint32_t> gather(const std::vector<std::uint32_t>& table,
                                         std::uint32_t count, std::uint32_t rounds) {
    std::vector<std::uint32_t> sums;
    const std::uint64_t modulus = std::uint64_t{1} << 32, wide = modulus / table.size();
    for (std::uint64_t i = 0; i < count; ++i) {
        std::uint64_t state = i, sum = 0;
        for (std::uint32_t n = 0; n < rounds; ++n) {
            state = (state * 1664525 + 1013904223) % modulus;
            sum = (sum + table[state / wide]) % modulus;
        }
        sums.push_back(static_cast<std::uint32_t>(sum));
    }
    return sums;
}

// What 16 bits of IEEE 754 mean: a sign, 5 bits of exponent, 10 of the fraction.
inline float of_half_bits(std::uint32_t bits) {
    const std::uint32_t exponent = bits >> 10 & 31, fraction = bits & 1023;
    const float sign = (bits & 0x8000) != 0 ? -1.0F : 1.0F;
    if (exponent == 31) {
        if (fraction == 0) return sign * std::numeric_limits<float>::infinity();
        return std::bit_cast<float>((bits & 0x8000) << 16 | 0x7f800000u | fraction << 13);
    }
    const int power = exponent == 0 ? -24 : static_cast<int>(exponent) - 25;
    return sign * std::ldexp(static_cast<float>(exponent == 0 ? fraction : fraction + 1024), power);
}
// Those of the nearest one, of two the even one: found among all of them.
inline std::uint32_t half_bits(float value) {
    static const std::vector<double> all = [] {
        std::vector<double> values;
        for (std::uint32_t n = 0; n < 0x7c00; ++n) values.push_back(of_half_bits(n));
        values.push_back(65536);  // in whose place infinity stands
        return values;
    }();
    const std::uint32_t sign = std::signbit(value) ? 0x8000 : 0;
    const double magnitude = std::fabs(double{value});
    const auto above = static_cast<std::uint32_t>(
        std::lower_bound(all.begin(), all.end() - 1, magnitude) - all.begin());
    if (above == 0 || magnitude >= all.back()) return sign | above;
    const double over = all[above] - magnitude, under = magnitude - all[above - 1];
    const bool down = under < over || (under == over && above % 2 == 1);
    return sign | (down ? above - 1 : above);
}

}  // namespace topple::oracle

// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "topple/kernel_testing/random.h"
#include "topple/kernels/buffer.h"
#include "topple/kernels/queue.h"

// Running a kernel, and comparing what it gives element by element.
namespace topple::test {

template <class Kernel>
void run_kernel(device::Device& device, std::uint64_t count, const typename Kernel::Args& args,
                const typename Kernel::Params& params) {
    device::Queue queue(device);
    queue.add<Kernel>(count, args, params);
    queue.run();
}

inline std::uint32_t bits(float v) {
    return std::bit_cast<std::uint32_t>(v);
}
inline std::uint32_t bits(std::uint32_t v) {
    return v;
}
inline std::uint32_t bits(std::int32_t v) {
    return static_cast<std::uint32_t>(v);
}

// Bit for bit; two NaN are alike, since IEEE 754 leaves their bits open.
template <class T>
bool alike(T a, T b) {
    if constexpr (std::is_floating_point_v<T>) {
        if (std::isnan(a) && std::isnan(b)) return true;
    }
    return bits(a) == bits(b);
}

// Every element is the same, bit for bit; else the count of those that aren't, and the first.
template <class T>
::testing::AssertionResult same(const std::vector<T>& got, const std::vector<T>& want) {
    if (got.size() != want.size()) {
        return ::testing::AssertionFailure()
               << got.size() << " elements instead of " << want.size();
    }
    std::size_t wrong = 0, first = 0;
    for (std::size_t i = got.size(); i-- > 0;) {
        if (alike(got[i], want[i])) continue;
        ++wrong;
        first = i;
    }
    if (wrong == 0) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure()
           << wrong << " of " << got.size() << " elements differ, the first at " << first << ": "
           << got[first] << " instead of " << want[first];
}

// Every element lies within its bound of the oracle; else the count of those that don't, and the
// worst by its share of the bound.
inline ::testing::AssertionResult within(const std::vector<float>& got,
                                         const std::vector<double>& want,
                                         const std::vector<double>& bound) {
    if (got.size() != want.size()) {
        return ::testing::AssertionFailure()
               << got.size() << " elements instead of " << want.size();
    }
    std::size_t wrong = 0, worst = 0;
    double most = 0;
    for (std::size_t i = 0; i < got.size(); ++i) {
        const double error = std::abs(double{got[i]} - want[i]);
        if (error <= bound[i]) continue;  // not so for NaN
        const double share = std::isnan(error) ? HUGE_VAL : error / bound[i];
        if (wrong++ == 0 || share > most) {
            most = share;
            worst = i;
        }
    }
    if (wrong == 0) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure()
           << wrong << " of " << got.size() << " elements are off, the worst at " << worst << ": "
           << got[worst] << " instead of " << want[worst] << ", where " << bound[worst]
           << " is allowed";
}

// An array with guard words before and after it, to see that a kernel writes nothing outside.
template <class T>
class Guarded {
  public:
    static constexpr std::uint64_t margin = device::slice_alignment / sizeof(T);

    Guarded(device::Device& device, std::uint64_t count, const std::string& name)
        : count_(count), buffer_(device, count + 2 * margin, name) {
        buffer_.fill(guard());
    }
    device::Slice<T> slice() const { return buffer_.slice(margin, count_); }
    void upload(const std::vector<T>& data) { buffer_.upload(std::span<const T>(data), margin); }
    std::vector<T> download() const {
        std::vector<T> out(count_);
        buffer_.download(std::span<T>(out), margin);
        return out;
    }
    ::testing::AssertionResult untouched() const {
        const std::vector<T> all = buffer_.download();
        for (std::uint64_t i = 0; i < all.size(); ++i) {
            const bool inside = i >= margin && i < margin + count_;
            if (!inside && bits(all[i]) != bits(guard())) {
                return ::testing::AssertionFailure()
                       << "buffer " << buffer_.name() << ": element "
                       << static_cast<std::int64_t>(i) - static_cast<std::int64_t>(margin)
                       << ", outside of its " << count_ << ", was overwritten with " << all[i];
            }
        }
        return ::testing::AssertionSuccess();
    }

  private:
    static T guard() { return std::bit_cast<T>(0x4b1d4b1du); }
    std::uint64_t count_;
    device::Buffer<T> buffer_;
};

}  // namespace topple::test

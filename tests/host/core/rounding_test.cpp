// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cstddef>

// That the compiler keeps to what the language says of floats and doubles: results would depend on
// how it optimises otherwise (CMakeLists.txt).
namespace topple::test {
namespace {

using Doubles = std::array<double, 3>;

[[gnu::noinline]] Doubles through_floats(const Doubles& of) {
    Doubles out{};
    for (std::size_t a = 0; a < 3; ++a) out[a] = static_cast<float>(of[a]);
    return out;
}

[[gnu::noinline]] Doubles left_by_floats(const Doubles& of) {
    Doubles out{};
    for (std::size_t a = 0; a < 3; ++a) out[a] = of[a] - double{static_cast<float>(of[a])};
    return out;
}

TEST(Rounding, AFloatIsOneBesideOthers) {
    const Doubles of{1.1, 2.3, 3.7};
    const Doubles through = through_floats(of), left = left_by_floats(of);
    for (std::size_t a = 0; a < 3; ++a) {
        const volatile float kept = static_cast<float>(of[a]);
        EXPECT_EQ(through[a], double{kept});
        EXPECT_EQ(left[a], of[a] - double{kept});
    }
}

}  // namespace
}  // namespace topple::test

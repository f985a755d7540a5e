// SPDX-License-Identifier: MIT
#include "export/text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace topple::exports {

std::string number(double value) {
    std::array<char, 32> digits;
    // A zero has no sign.
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value + 0.0,
                                   std::chars_format::general, 9);
    return {digits.data(), end.ptr};
}

std::string numbers(std::initializer_list<double> values, std::string_view between) {
    std::string out;
    for (const double v : values) {
        if (!out.empty()) out += between;
        out += number(v);
    }
    return out;
}

void append_fixed(std::string& to, double value, int digits) {
    std::int64_t scale = 1;
    for (int n = 0; n < digits; ++n) scale *= 10;
    const auto steps = static_cast<std::int64_t>(std::llround(value * static_cast<double>(scale)));
    const auto size = static_cast<std::uint64_t>(steps < 0 ? -steps : steps);
    const auto whole = size / static_cast<std::uint64_t>(scale);
    auto rest = size % static_cast<std::uint64_t>(scale);
    std::array<char, 24> written;
    if (steps < 0) to += '-';
    const auto end = std::to_chars(written.data(), written.data() + written.size(), whole);
    to.append(written.data(), end.ptr);
    if (rest == 0) return;
    to += '.';
    while (rest > 0) {
        scale /= 10;
        to += static_cast<char>('0' + rest / static_cast<std::uint64_t>(scale));
        rest %= static_cast<std::uint64_t>(scale);
    }
}

}  // namespace topple::exports

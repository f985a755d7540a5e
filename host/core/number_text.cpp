// SPDX-License-Identifier: MIT
#include "core/number_text.h"

#include <array>
#include <charconv>

#include "core/short_number.h"

namespace topple {
namespace {

std::string written(double value, std::chars_format format, int precision) {
    std::array<char, 400> text;  // the largest double has 309 digits before the point
    const auto end =
        std::to_chars(text.data(), text.data() + text.size(), value, format, precision);
    return {text.data(), end.ptr};
}

}  // namespace

std::string short_number(double value) {
    return to_digits(value, 6);
}

std::string to_digits(double value, int digits) {
    return written(value, std::chars_format::general, digits);
}

std::string to_places(double value, int places) {
    return written(value, std::chars_format::fixed, places);
}

}  // namespace topple

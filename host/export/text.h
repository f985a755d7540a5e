// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

#include "topple/input.h"

// Numbers and elements as the formats write them, whatever the locale. Numbers have nine digits.
// Values are our own names and numbers: there is nothing to escape.
namespace topple::exports {

std::string number(double value);
std::string numbers(std::initializer_list<double> values, std::string_view between = " ");
inline std::string text(const Vec3& v, std::string_view between = " ") {
    return numbers({v[0], v[1], v[2]}, between);
}

// Appends a number with so many digits after the point at most. |value| < 1e9.
void append_fixed(std::string& to, double value, int digits);

template <class... Parts>
void append(std::string& to, const Parts&... parts) {
    (to.append(std::string_view(parts)), ...);
}
template <class... Parts>
std::string joined(const Parts&... parts) {
    std::string out;
    append(out, parts...);
    return out;
}

// "0.5 0.25 1 1": of sRGB, opaque.
inline std::string rgba(const std::array<std::uint8_t, 3>& colour) {
    return numbers({colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0, 1});
}

// XML: ` name="value"`, and `<name>value</name>`.
inline std::string attribute(std::string_view name, std::string_view value) {
    return joined(" ", name, "=\"", value, "\"");
}
inline std::string element(std::string_view name, std::string_view value) {
    return joined("<", name, ">", value, "</", name, ">");
}

}  // namespace topple::exports

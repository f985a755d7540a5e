// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "topple/error.h"
#include "topple/input.h"

// What the texts of options' values say. All throw Error(usage) that names the option.
namespace topple::cli {

// "--up 0,0: expected three numbers".
Error wrong_value(const std::string& option, const std::string& text, const std::string& expected);

std::vector<std::string> split_commas(const std::string& text);

// Three numbers, "1.5,0,0.8".
Vec3 parse_vector(const std::string& option, const std::string& text, const char* expected);

// A direction, "0,0,1", of unit length.
Vec3 parse_up(const std::string& option, const std::string& text);

// --pga: a number in m/s^2, or with a unit: 0.3g, 2.9m/s2.
struct Acceleration {
    double m_s2 = 0;
    bool with_unit = false;
};
Acceleration parse_acceleration(const std::string& option, const std::string& text);

// --contents: none for "solid".
std::optional<double> parse_contents(const std::string& option, const std::string& text);

// --max-memory: "500M", "4G", "1.5GB", or a number of bytes.
std::uint64_t parse_size(const std::string& option, const std::string& text);

}  // namespace topple::cli

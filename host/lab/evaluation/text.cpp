// SPDX-License-Identifier: MIT
#include "lab/evaluation/text.h"

#include <cstdarg>
#include <cstdio>
#include <limits>
#include <numeric>

namespace topple::evaluation {

void append(std::string& text, const char* format, ...) {
    char line[256];
    std::va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(line, sizeof(line), format, arguments);
    va_end(arguments);
    text.append(line);
}

std::string percent(double share) {
    if (std::isnan(share)) return "-";
    char digits[32];
    std::snprintf(digits, sizeof(digits), "%.1f", 100 * share);
    return digits;
}

double mean(const std::vector<double>& values) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace topple::evaluation

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/evaluation/tables.h"

namespace topple::evaluation {

Spread spread(const std::vector<RoomScore>& rooms,
              const std::function<double(const RoomScore&)>& measure) {
    std::vector<double> values;
    for (const RoomScore& room : rooms) {
        const double v = measure(room);
        if (!std::isnan(v)) values.push_back(v);
    }
    const double none = std::numeric_limits<double>::quiet_NaN();
    if (values.empty()) return {none, none, none};
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    const double median = values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
    return {median, values.front(), values.back()};
}

}  // namespace topple::evaluation

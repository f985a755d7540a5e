// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/json.h"
#include "topple/scene.h"

// Numbers, vectors and lists as JSON has them: what is not finite is written as null and read back
// as NaN. What reads throws nlohmann's exceptions.
namespace topple::io {

inline OrderedJson number(double value) {
    return std::isfinite(value) ? OrderedJson(value) : OrderedJson(nullptr);
}

inline OrderedJson vector(const Vec3& v) {
    return OrderedJson::array({number(v[0]), number(v[1]), number(v[2])});
}

template <class T, class Convert>
OrderedJson list(const std::vector<T>& items, Convert convert) {
    auto json = OrderedJson::array();
    for (const auto& item : items) json.push_back(convert(item));
    return json;
}

inline OrderedJson numbers(const std::vector<double>& values) {
    return list(values, [](double value) { return number(value); });
}

inline OrderedJson numbers_by_name(const std::map<std::string, double>& values) {
    auto json = OrderedJson::object();
    for (const auto& [name, value] : values) json[name] = number(value);
    return json;
}

// Square, row-major.
template <std::size_t N>
OrderedJson matrix(const std::array<double, N>& m) {
    constexpr std::size_t side = N == 16 ? 4 : 3;
    static_assert(side * side == N);
    auto rows = OrderedJson::array();
    for (std::size_t row = 0; row < side; ++row) {
        auto values = OrderedJson::array();
        for (std::size_t column = 0; column < side; ++column)
            values.push_back(number(m[row * side + column]));
        rows.push_back(std::move(values));
    }
    return rows;
}

// missing: what null stands for.
inline double number_of(const OrderedJson& json,
                        double missing = std::numeric_limits<double>::quiet_NaN()) {
    return json.is_null() ? missing : json.get<double>();
}

inline Vec3 vector_of(const OrderedJson& json) {
    return {number_of(json.at(0)), number_of(json.at(1)), number_of(json.at(2))};
}

inline std::map<std::string, double> numbers_by_name_of(const OrderedJson& json) {
    std::map<std::string, double> values;
    for (const auto& [name, value] : json.items()) values[name] = number_of(value);
    return values;
}

template <std::size_t N>
std::array<double, N> matrix_of(const OrderedJson& rows) {
    constexpr std::size_t side = N == 16 ? 4 : 3;
    static_assert(side * side == N);
    std::array<double, N> m{};
    for (std::size_t i = 0; i < N; ++i) m[i] = number_of(rows.at(i / side).at(i % side));
    return m;
}

}  // namespace topple::io

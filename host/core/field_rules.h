// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <ranges>
#include <string>
#include <type_traits>

#include "core/printable.h"

// What a field of a file must be, wherever the file comes from: rules for core/fields.h. Of arrays
// they are about each value in them.
namespace topple::rules {

template <class T, class Holds>
bool each(const T& value, const Holds& holds) {
    if constexpr (std::ranges::range<T>)
        return std::ranges::all_of(value, [&](const auto& v) { return each(v, holds); });
    else
        return holds(value);
}

inline auto length(std::size_t count) {
    return [count](const auto& values) { return values.size() == count; };
}
// Where nothing is known, the array is empty.
inline auto length_or_none(std::size_t count) {
    return [count](const auto& values) { return values.empty() || values.size() == count; };
}

inline bool is_id(std::int64_t id, std::size_t count) {
    return id >= 0 && id < static_cast<std::int64_t>(count);
}
// Numbers of what there are `count` of.
inline auto ids(std::size_t count) {
    return [count](const auto& values) {
        return each(values, [&](std::int64_t id) { return is_id(id, count); });
    };
}
// The same, or -1.
inline auto labels(std::size_t count) {
    return [count](const auto& values) {
        return each(values, [&](std::int64_t id) { return id == -1 || is_id(id, count); });
    };
}

inline constexpr auto finite = [](const auto& values) {
    return each(values, [](double v) { return std::isfinite(v); });
};
inline constexpr auto no_nan = [](const auto& values) {
    return each(values, [](double v) { return !std::isnan(v); });
};
constexpr auto within(double low, double high) {
    return [low, high](const auto& values) {  // of NaN this is false
        return each(values, [&](double v) { return v >= low && v <= high; });
    };
}

// Each above the one before.
inline constexpr auto ascending = [](const auto& values) {
    return std::ranges::adjacent_find(values, std::ranges::greater_equal()) == values.end();
};

// Of an array of structs: list(item, must) calls must(member, rule) for each member that has one.
template <class List>
auto of_all(const List& list) {
    return [list](const auto& items) {
        return std::ranges::all_of(items, [&](const auto& item) {
            bool holds = true;
            list(item,
                 [&](const auto& member, const auto& rule) { holds = holds && rule(member); });
            return holds;
        });
    };
}

// An enumeration's values up to its last.
template <class Enum>
auto up_to(Enum last) {
    return [last](const auto& values) {
        return each(values, [&](Enum v) {
            using Number = std::underlying_type_t<Enum>;
            return v >= Enum{} && static_cast<Number>(v) <= static_cast<Number>(last);
        });
    };
}

// Lines that may be shown.
inline constexpr auto shown = [](const auto& lines) {
    const auto plain = [](const std::string& line) {
        return printable(line, line.size() + 1) == line;
    };
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(lines)>, std::string>)
        return plain(lines);
    else
        return std::ranges::all_of(lines, plain);
};

}  // namespace topple::rules

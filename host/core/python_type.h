// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/field_list.h"

// What Python has for the value of a field.
namespace topple {

// "float", "list[int]", "NDArray[np.float64]", "Overturning": as its stubs say it.
template <class T>
std::string python_type(const Note& note = {}) {
    const auto plain = [&]() -> std::string {
        if constexpr (Listed<T>)
            return kind<T>.name ? kind<T>.name : "row";
        else if constexpr (std::is_same_v<T, bool>)
            return "bool";
        else if constexpr (std::is_integral_v<T>)
            return "int";
        else if constexpr (std::is_floating_point_v<T>)
            return "float";
        else if constexpr (std::is_convertible_v<T, std::string>)
            return note.one_of ? std::string("Literal[") + note.one_of + "]" : "str";
        else if constexpr (is_a<T, std::map>)
            return "dict[str, float]";
        else if constexpr (array_size<T> != 0)
            return array_size<T> == 2 ? "list[int]" : "NDArray[np.float64]";
        else if constexpr (is_a<typename T::value_type, std::pair>)
            return "dict[str, float]";
        else {
            const std::string each = python_type<typename T::value_type>();
            const bool numbers = each == "float" || each == "row" || each.starts_with("NDArray");
            return numbers ? "NDArray[np.float64]" : "list[" + each + "]";
        }
    }();
    return note.or_none ? "Optional[" + plain + "]" : plain;
}

// The shape of a small array: "(3,)". "" of all else.
template <class T>
std::string python_shape() {
    switch (array_size<T>) {
        case 3:
            return "(3,)";
        case 9:
            return "(3, 3)";
        case 16:
            return "(4, 4)";
        default:
            return "";
    }
}

// What help() says of it: "int: ..", "(3,): ..".
template <class T>
std::string python_words(const char* words, const Note& note) {
    std::string of = python_shape<T>();
    if (of.empty()) of = note.one_of ? "str" : python_type<T>(note);
    return of == "float" || of.starts_with("NDArray") ? words : of + ": " + words;
}

}  // namespace topple

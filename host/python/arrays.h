// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "python.h"
#include "topple/cloud_view.h"
#include "topple/error.h"

// Arrays of NumPy where they lie. The Python side has converted what needs it, and says in the
// caller's words what is wrong with the rest: here remain checks that keep memory safe.
namespace topple::python {

// One-dimensional and without gaps; written to where T is not const.
template <class T>
std::span<T> row(const py::array& from, const char* name) {
    using Element = std::remove_const_t<T>;
    const bool fits = from.ndim() == 1 && py::isinstance<py::array_t<Element>>(from) &&
                      (from.shape(0) < 2 || from.strides(0) == sizeof(T));
    if (!fits || (!std::is_const_v<T> && !from.writeable()))
        throw Error(ErrorKind::usage, std::string(name) + " is no such array, without gaps");
    T* first = nullptr;
    if constexpr (std::is_const_v<T>)
        first = static_cast<T*>(from.data());
    else
        first = static_cast<T*>(const_cast<void*>(from.data()));
    return {first, static_cast<std::size_t>(from.shape(0))};
}

// Lists of three arrays each, or empty ones where there are none; any strides.
CloudView view_of(const std::vector<py::array>& points, const std::vector<py::array>& normals,
                  const std::vector<py::array>& colours, const std::optional<Vec3>& viewpoint);

}  // namespace topple::python

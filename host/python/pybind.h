// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <new>

namespace topple::python {

// pybind11 reads copies of names without a look, which are null where memory is short. It hands a
// name over as a `const char*` of its own; where it has freed the copy before and null is right, it
// hands over something else.
inline char* duplicated(const char* const& text) {
    return ::strdup(text);
}
inline char* duplicated(const char*& name) {
    if (char* copy = ::strdup(name)) return copy;
    throw std::bad_alloc();
}

}  // namespace topple::python

#define strdup topple::python::duplicated
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#undef strdup

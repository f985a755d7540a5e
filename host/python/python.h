// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>

#include "topple/parse.h"

// What the parts of the Python module share.
namespace topple::python {

namespace py = pybind11;

struct SharedDevice {
    std::shared_ptr<device::Device> device;
};

// A result that arrays borrow from: it lives as long as the last of them.
struct Parsed {
    ParseResult result;
};

void bind_export(py::module_& module);
void bind_labels(py::module_& module);
void bind_parse(py::module_& module);
void bind_places(py::module_& module);
void bind_result(py::module_& module);
void bind_stages(py::module_& module);

}  // namespace topple::python

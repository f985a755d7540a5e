// SPDX-License-Identifier: MIT
#pragma once

#include <unistd.h>

#include <memory>
#include <string>
#include <utility>

#include "pybind.h"
#include "topple/error.h"
#include "topple/parse.h"

// What the parts of the Python module share.
namespace topple::python {

namespace py = pybind11;

// A device's threads, and its driver's, are not in a process that was forked from its own.
struct SharedDevice {
    SharedDevice() = default;
    SharedDevice(const SharedDevice&) = delete;
    SharedDevice& operator=(const SharedDevice&) = delete;
    ~SharedDevice() {
        // It would wait for its threads; so it stays.
        if (process != ::getpid()) new std::shared_ptr(std::move(device));
    }
    const std::shared_ptr<device::Device>& here() const {
        if (process != ::getpid())
            throw Error(ErrorKind::usage,
                        "the device was opened by another process, from which this one was forked; "
                        "open it here, by topple.open_device()");
        return device;
    }

    std::shared_ptr<device::Device> device;
    const pid_t process = ::getpid();
};

// A result that arrays borrow from: it lives as long as the last of them.
struct Parsed {
    ParseResult result;
};

void bind_ask(py::module_& module);
void bind_compare(py::module_& module);
void bind_export(py::module_& module);
void bind_kernels(py::module_& module);
void bind_labels(py::module_& module);
void bind_parse(py::module_& module);
void bind_places(py::module_& module);
void bind_result(py::module_& module);
void bind_session(py::module_& module);
void bind_stages(py::module_& module);

}  // namespace topple::python

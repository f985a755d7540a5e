// SPDX-License-Identifier: MIT
#include <array>
#include <string>
#include <string_view>

#include "busy.h"
#include "child/confine.h"
#include "core/printable.h"
#include "python.h"
#include "topple/stages.h"
#include "topple/version.h"

namespace topple::python {
namespace {

const char* name_of(ErrorKind kind) {
    constexpr std::array names{"input", "usage", "device", "cancelled"};
    return names.at(static_cast<std::size_t>(kind));
}

// topple::Error becomes topple.Error, with its kind.
void bind_error(py::module_& module) {
    static PyObject* type = PyErr_NewExceptionWithDoc(
        "topple.Error", "What went wrong, in a line; `kind` is input, usage, device or cancelled.",
        PyExc_RuntimeError, nullptr);
    if (!type) throw py::error_already_set();
    module.add_object("Error", py::reinterpret_borrow<py::object>(type));
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(thrown);
        } catch (const Error& error) {
            py::object made = py::reinterpret_borrow<py::object>(type)(error.what());
            made.attr("kind") = name_of(error.kind());
            PyErr_SetObject(type, made.ptr());
        }
    });
}

void bind_devices(py::module_& module) {
    py::class_<SharedDevice, std::shared_ptr<SharedDevice>>(
        module, "Device",
        "What a parse computes on (open_device()). It serves one parse at a time.")
        .def_property_readonly(
            "backend",
            [](const SharedDevice& d) {
                return device::to_string(device::describe(*d.device).backend);
            },
            "str: \"native\", \"opencl\" or \"vulkan\".")
        .def_property_readonly(
            "name", [](const SharedDevice& d) { return device::describe(*d.device).name; }, "str.")
        .def_property_readonly(
            "gpu", [](const SharedDevice& d) { return device::describe(*d.device).gpu; }, "bool.")
        .def("__repr__", [](const SharedDevice& d) {
            const device::DeviceInfo& info = device::describe(*d.device);
            return std::string("<topple.Device ") + device::to_string(info.backend) + ", " +
                   info.name + ">";
        });
    module.def(
        "open_device",
        [](const std::string& backend, unsigned threads) {
            auto opened = std::make_shared<SharedDevice>();
            opened->device = unlocked([&] { return device::open_device(backend, threads); });
            return opened;
        },
        py::arg("backend") = "auto", py::arg("threads") = 0);
    module.def("list_devices", [] {
        py::list out;
        for (const device::Listing& l : unlocked(device::list_devices))
            out.append(py::make_tuple(device::to_string(l.backend), l.info.name, l.info.driver,
                                      l.info.gpu, l.usable, l.problem));
        return out;
    });
}

// For the Python files alone.
void bind_shared(py::module_& module) {
    module.def("printable", [](const py::bytes& text, std::size_t most) {
        return printable(static_cast<std::string_view>(text), most);
    });
    module.def("confine", [](const std::vector<std::string>& read,
                             const std::vector<std::string>& write, long parent) {
        child::end_with(parent);
        child::confine({{read.begin(), read.end()}, {write.begin(), write.end()}});
    });
}

}  // namespace

PYBIND11_MODULE(_topple, module) {
    // What pybind11 takes of NumPy it looks up once, behind a lock, and importing lets go of the
    // interpreter's meanwhile: two threads at their first array would each wait for the other's.
    py::detail::npy_api::get();
    module.attr("__version__") = version;
    bind_error(module);
    bind_shared(module);
    bind_devices(module);
    bind_result(module);
    bind_parse(module);
    bind_places(module);
    bind_ask(module);
    bind_compare(module);
    bind_labels(module);
    bind_export(module);
    bind_kernels(module);
    bind_session(module);
    bind_stages(module);
    py::module_::import("atexit").attr("register")(py::cpp_function([] {
        const py::gil_scoped_release release;
        Busy::stop_all();
    }));
}

}  // namespace topple::python

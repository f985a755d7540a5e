// SPDX-License-Identifier: MIT
#include <array>
#include <cstring>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "arrays.h"
#include "busy.h"
#include "device/devices.h"
#include "topple/kernels/queue.h"

namespace topple::python {
namespace {

using Device = std::shared_ptr<SharedDevice>;

// A KernelSource that was made at run time, and what it points to. It is never deleted: devices
// keep what they build of it under its address, and another one must not come to lie there.
struct MadeKernel {
    std::string name, opencl;
    std::deque<std::string> names;  // of the bindings; a deque does not move them
    std::vector<device::Binding> bindings;
    std::vector<std::uint32_t> spirv;
    device::KernelSource source{};
};

// A binding's name and whether it is "in", "out" or "inout".
using PyBinding = std::pair<std::string, std::string>;

// Which of NativeEntries devices run here, from 0.
std::size_t native_isa() {
    const auto numbered = [](std::uintptr_t n) { return reinterpret_cast<device::NativeEntry>(n); };
    return reinterpret_cast<std::uintptr_t>(
               device::best_entry({numbered(1), numbered(2), numbered(3)})) -
           1;
}

// items: of a work-item natively, by OpenCL, by Vulkan, on a GPU. Of the forms those may be empty
// or 0 of whose backends no device gets the kernel. native: addresses of NativeEntry: baseline,
// AVX2, AVX-512.
std::unique_ptr<MadeKernel, py::nodelete> make_kernel(
    const std::string& name, std::uint32_t group_size, const std::array<std::uint32_t, 4>& items,
    bool per_group, std::uint32_t params_bytes, const std::vector<PyBinding>& bindings,
    const py::bytes& spirv, const std::string& opencl,
    const std::array<std::uintptr_t, 3>& native) {
    std::unique_ptr<MadeKernel, py::nodelete> made(new MadeKernel{name, opencl, {}, {}, {}, {}});
    for (const auto& [binding, access] : bindings) {
        made->bindings.push_back({made->names.emplace_back(binding).c_str(),
                                  access == "in"    ? device::Access::read
                                  : access == "out" ? device::Access::write
                                                    : device::Access::read_write,
                                  4});
    }
    const std::string_view words(spirv);
    made->spirv.resize(words.size() / 4);
    std::memcpy(made->spirv.data(), words.data(), 4 * made->spirv.size());
    const auto entry = [&](std::size_t n) {
        return reinterpret_cast<device::NativeEntry>(native[n]);
    };
    made->source = {made->name.c_str(),
                    group_size,
                    items[0],
                    items[1],
                    items[2],
                    items[3],
                    per_group,
                    params_bytes,
                    made->bindings,
                    made->spirv,
                    made->opencl.c_str(),
                    {entry(0), entry(1), entry(2)}};
    return made;
}

// The memory of an array without gaps. The Python side has checked types, and says it better.
// NumPy 2 lays descriptions out anew, which pybind11 before 2.12 does not know: NumPy is asked.
std::span<std::byte> bytes_of(const py::array& array, const device::Binding& binding) {
    const bool fits = (array.flags() & py::array::c_style) &&
                      array.attr("itemsize").cast<std::uint32_t>() == binding.element_bytes &&
                      (binding.access == device::Access::read || array.writeable());
    if (!fits) throw Error(ErrorKind::usage, std::string(binding.name) + " is no such array");
    return {static_cast<std::byte*>(const_cast<void*>(array.data())),
            array.attr("nbytes").cast<std::size_t>()};
}

// Runs the kernel once. All arrays are sent, those that are only written to as well: the elements
// that the kernel leaves alone keep their values.
void run_kernel(device::Device& device, const device::KernelSource& kernel,
                const std::vector<std::span<std::byte>>& arrays, std::span<const std::byte> params,
                std::uint64_t count) {
    const device::InUse in_use(device);
    // The last group may reach beyond the count. That it goes no further is up to the kernel, as
    // everywhere; here one that forgets to look hits memory that nobody else has.
    const std::uint64_t spare =
        std::uint64_t{4} * kernel.group_size * device.items_per_lane(kernel);
    std::vector<device::MemoryPtr> memory;
    std::vector<device::BoundRange> ranges;
    for (std::size_t n = 0; n < arrays.size(); ++n) {
        memory.push_back(device.allocate(arrays[n].size() + spare, kernel.bindings[n].name));
        ranges.push_back({memory[n].get(), 0, arrays[n].size()});
    }
    device::Queue queue(device);
    queue.add(kernel, count, std::move(ranges), params);
    for (std::size_t n = 0; n < arrays.size(); ++n)
        if (!arrays[n].empty()) device.write(*memory[n], 0, arrays[n]);
    queue.run();
    for (std::size_t n = 0; n < arrays.size(); ++n)
        if (kernel.bindings[n].access != device::Access::read && !arrays[n].empty())
            device.read(*memory[n], 0, arrays[n]);
}

}  // namespace

void bind_kernels(py::module_& parent) {
    py::module_ module = parent.def_submodule("kernels");
    module.def("native_isa", native_isa);
    py::class_<MadeKernel, std::unique_ptr<MadeKernel, py::nodelete>>(module, "Kernel")
        .def(py::init(&make_kernel))
        // arrays: one for each binding, in their order. count: as Queue::add() takes it.
        .def("run",
             [](const MadeKernel& self, const Device& device, const std::vector<py::array>& arrays,
                const py::bytes& params, std::uint64_t count) {
                 if (arrays.size() != self.bindings.size())
                     throw Error(ErrorKind::usage, self.name + " has as many arrays as bindings");
                 std::vector<std::span<std::byte>> memory;
                 for (std::size_t n = 0; n < arrays.size(); ++n)
                     memory.push_back(bytes_of(arrays[n], self.bindings[n]));
                 const std::string_view block(params);
                 unlocked([&] {
                     run_kernel(*device->here(), self.source, memory,
                                std::as_bytes(std::span(block.data(), block.size())), count);
                 });
             });
}

}  // namespace topple::python

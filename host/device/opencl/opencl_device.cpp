// SPDX-License-Identifier: MIT
#include "device/opencl/opencl_device.h"

#include <algorithm>
#include <cstring>

#include "device/opencl/opencl_error.h"
#include "topple/error.h"

namespace topple::device {
namespace {

// Unmaps what a run uses and maps it again afterwards, also when the run fails.
class Unmapped {
  public:
    explicit Unmapped(std::span<const Dispatch> dispatches) {
        for (const Dispatch& dispatch : dispatches) {
            for (const BoundRange& range : dispatch.ranges) {
                auto* memory = static_cast<OpenClMemory*>(range.memory);
                if (!memory->mapped()) continue;
                memory->unmap();
                memories_.push_back(memory);
            }
        }
    }
    ~Unmapped() {
        for (OpenClMemory* memory : memories_) {
            try {
                memory->map();
            } catch (const Error&) {  // the device is lost; the next use says so
            }
        }
    }
    Unmapped(const Unmapped&) = delete;
    Unmapped& operator=(const Unmapped&) = delete;

  private:
    std::vector<OpenClMemory*> memories_;
};

// The parts of buffers that a batch binds, released when it is done.
struct Parts {
    std::vector<cl_mem> all;
    ~Parts() {
        for (cl_mem part : all) clReleaseMemObject(part);
    }
};

std::string one_line(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == '\0')) text.pop_back();
    std::ranges::replace(text, '\n', ' ');
    return text;
}

}  // namespace

OpenClDevice::OpenClDevice(OpenClContext context) : context_(std::move(context)) {
    info_ = describe_opencl(context_.device);
    as_gpu_ = info_.gpu;
    shares_host_memory_ =
        cl_value<cl_device_type>(context_.device, CL_DEVICE_TYPE) & CL_DEVICE_TYPE_CPU;
    const std::uint64_t alignment =
        cl_value<cl_uint>(context_.device, CL_DEVICE_MEM_BASE_ADDR_ALIGN) / 8;
    if (alignment > slice_alignment) {
        throw Error(ErrorKind::device,
                    "OpenCL device " + info_.name + " aligns parts of buffers to " +
                        std::to_string(alignment) + " bytes, more than topple's " +
                        std::to_string(slice_alignment));
    }
    // IEEE division and square root, where the device leaves a choice: all backends give the same
    // bits.
    const auto floats = cl_value<cl_device_fp_config>(context_.device, CL_DEVICE_SINGLE_FP_CONFIG);
    build_options_ = "-cl-std=CL1.2";
    if (floats & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) {
        build_options_ += " -cl-fp32-correctly-rounded-divide-sqrt";
    }
}

OpenClDevice::~OpenClDevice() {
    for (auto& [source, built] : kernels_) {
        clReleaseKernel(built.kernel);
        clReleaseProgram(built.program);
    }
}

std::unique_ptr<Memory> OpenClDevice::allocate(std::uint64_t bytes, const std::string& name) {
    if (bytes > info_.limits.max_allocation_bytes) {
        throw Error(
            ErrorKind::device,
            "buffer " + name + ": " + std::to_string(bytes) + " bytes are more than the " +
                std::to_string(info_.limits.max_allocation_bytes) + " that " + info_.name +
                " allocates at once; use a larger ParseOptions::voxel_m, or the native backend");
    }
    return std::make_unique<OpenClMemory>(*this, bytes, name);
}

OpenClMemory& OpenClDevice::own(Memory& memory) const {
    auto* mine = dynamic_cast<OpenClMemory*>(&memory);
    if (!mine || &mine->device() != this) {
        throw Error(ErrorKind::device,
                    "buffer " + memory.name() + " belongs to another device than " + info_.name);
    }
    return *mine;
}

void OpenClDevice::write(Memory& to, std::uint64_t offset, std::span<const std::byte> from) {
    OpenClMemory& memory = own(to);
    if (memory.mapped()) {
        std::memcpy(memory.host_address() + offset, from.data(), from.size());
    } else {
        cl_check(clEnqueueWriteBuffer(context_.queue, memory.buffer(), CL_TRUE, offset, from.size(),
                                      from.data(), 0, nullptr, nullptr),
                 "writing buffer " + memory.name());
    }
    counters_.bytes_written += from.size();
}

void OpenClDevice::read(Memory& from, std::uint64_t offset, std::span<std::byte> to) {
    OpenClMemory& memory = own(from);
    if (memory.mapped()) {
        std::memcpy(to.data(), memory.host_address() + offset, to.size());
    } else {
        cl_check(clEnqueueReadBuffer(context_.queue, memory.buffer(), CL_TRUE, offset, to.size(),
                                     to.data(), 0, nullptr, nullptr),
                 "reading buffer " + memory.name());
    }
    counters_.bytes_read += to.size();
}

void OpenClDevice::fill(Memory& target, std::uint64_t offset, std::uint64_t bytes,
                        std::uint32_t word) {
    OpenClMemory& memory = own(target);
    if (memory.mapped()) {
        auto* first = reinterpret_cast<std::uint32_t*>(memory.host_address() + offset);
        std::fill(first, first + bytes / sizeof(word), word);
        return;
    }
    cl_check(clEnqueueFillBuffer(context_.queue, memory.buffer(), &word, sizeof(word), offset,
                                 bytes, 0, nullptr, nullptr),
             "filling buffer " + memory.name());
    cl_check(clFinish(context_.queue), "filling buffer " + memory.name());
}

void OpenClDevice::prepare(const KernelSource& source) {
    kernel(source);
}

cl_kernel OpenClDevice::kernel(const KernelSource& source) {
    auto found = kernels_.find(&source);
    if (found == kernels_.end()) {
        found = kernels_.emplace(&source, build(source)).first;
        ++counters_.kernel_builds;
    }
    return found->second.kernel;
}

OpenClDevice::Built OpenClDevice::build(const KernelSource& source) const {
    const std::string where = std::string("kernel ") + source.name;
    cl_int code = CL_SUCCESS;
    Built built;
    built.program = clCreateProgramWithSource(
        context_.context, 1, const_cast<const char**>(&source.opencl), nullptr, &code);
    cl_check(code, where);
    const std::string options =
        build_options_ + " -D ITEMS=" + std::to_string(items_per_lane(source));
    code = clBuildProgram(built.program, 1, &context_.device, options.c_str(), nullptr, nullptr);
    std::size_t group = 0;
    if (code == CL_SUCCESS) built.kernel = clCreateKernel(built.program, source.name, &code);
    if (code == CL_SUCCESS) {
        code = clGetKernelWorkGroupInfo(built.kernel, context_.device, CL_KERNEL_WORK_GROUP_SIZE,
                                        sizeof(group), &group, nullptr);
    }
    if (code == CL_SUCCESS && group >= source.group_size) return built;

    std::string why = cl_error_name(code);
    if (code == CL_SUCCESS) {
        why = "its groups of " + std::to_string(source.group_size) + " are more than the " +
              std::to_string(group) + " work-items that " + info_.name + " can run together";
    } else {
        std::size_t size = 0;
        clGetProgramBuildInfo(built.program, context_.device, CL_PROGRAM_BUILD_LOG, 0, nullptr,
                              &size);
        std::string log(size, '\0');
        clGetProgramBuildInfo(built.program, context_.device, CL_PROGRAM_BUILD_LOG, size,
                              log.data(), nullptr);
        why += ": ";
        why += one_line(log);
    }
    if (built.kernel) clReleaseKernel(built.kernel);
    clReleaseProgram(built.program);
    throw Error(ErrorKind::device, where + " does not build for " + info_.name + ": " + why);
}

void OpenClDevice::enqueue(const Dispatch& dispatch, std::vector<cl_mem>& parts) {
    const std::string where = std::string("kernel ") + dispatch.kernel->name;
    const cl_kernel kernel_handle = kernel(*dispatch.kernel);
    cl_uint index = 0;
    for (const BoundRange& range : dispatch.ranges) {
        const OpenClMemory& memory = own(*range.memory);
        cl_mem buffer = memory.buffer();
        if (range.offset != 0 || range.bytes != memory.bytes()) {
            const cl_buffer_region region{range.offset, std::max<std::size_t>(4, range.bytes)};
            cl_int code = CL_SUCCESS;
            buffer = clCreateSubBuffer(buffer, 0, CL_BUFFER_CREATE_TYPE_REGION, &region, &code);
            cl_check(code, where + ": part of buffer " + memory.name());
            parts.push_back(buffer);
        }
        cl_check(clSetKernelArg(kernel_handle, index++, sizeof(buffer), &buffer),
                 where + ": buffer " + memory.name());
    }
    cl_check(clSetKernelArg(kernel_handle, index, dispatch.params.size(), dispatch.params.data()),
             where + ": parameters");
    const std::size_t local = dispatch.kernel->group_size;
    const std::size_t global = dispatch.groups * local;
    cl_check(clEnqueueNDRangeKernel(context_.queue, kernel_handle, 1, nullptr, &global, &local, 0,
                                    nullptr, nullptr),
             where);
}

void OpenClDevice::run(std::span<const Dispatch> dispatches) {
    for (const Dispatch& dispatch : dispatches) {
        for (const BoundRange& range : dispatch.ranges) own(*range.memory);
        kernel(*dispatch.kernel);
    }
    const Unmapped unmapped(dispatches);
    Parts parts;
    // In-order: each dispatch sees what the ones before it wrote.
    try {
        for (const Dispatch& dispatch : dispatches) enqueue(dispatch, parts.all);
    } catch (const Error&) {
        clFinish(context_.queue);
        throw;
    }
    cl_check(clFinish(context_.queue), dispatches.empty() ? "empty batch"
                                                          : std::string("batch ending in kernel ") +
                                                                dispatches.back().kernel->name);
    count(dispatches);
}

}  // namespace topple::device

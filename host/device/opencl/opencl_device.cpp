// SPDX-License-Identifier: MIT
#include "device/opencl/opencl_device.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "device/opencl/opencl_error.h"
#include "device/timeline.h"
#include "device/trace.h"
#include "topple/error.h"

namespace topple::device {
namespace {

std::string ending_in(std::span<const Dispatch> dispatches) {
    return dispatches.empty()
               ? "empty batch"
               : std::string("batch ending in kernel ") + dispatches.back().kernel->name;
}

class OpenClBatch final : public Running {
  public:
    // Whose last dispatch has that event.
    OpenClBatch(std::string what, ClEvent last, std::vector<ClMem> parts)
        : what_(std::move(what)), last_(std::move(last)), parts_(std::move(parts)) {}
    bool ended() override {
        cl_int status = CL_COMPLETE;
        const cl_int code = clGetEventInfo(last_.get(), CL_EVENT_COMMAND_EXECUTION_STATUS,
                                           sizeof(status), &status, nullptr);
        return code != CL_SUCCESS || status <= CL_COMPLETE;  // below: an error, which wait() tells
    }
    std::exception_ptr wait() override {
        try {
            const cl_event last = last_.get();
            cl_check(clWaitForEvents(1, &last), what_);
        } catch (const Error&) {
            return std::current_exception();
        }
        return nullptr;
    }

  private:
    std::string what_;
    ClEvent last_;
    std::vector<ClMem> parts_;  // of buffers
};

std::string one_line(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == '\0')) text.pop_back();
    std::ranges::replace(text, '\n', ' ');
    return text;
}

}  // namespace

OpenClDevice::OpenClDevice(std::unique_ptr<OpenClContext> context) : context_(std::move(context)) {
    info_ = describe_opencl(context_->device);
    as_gpu_ = info_.gpu;
    shares_host_memory_ =
        cl_value<cl_device_type>(context_->device, CL_DEVICE_TYPE) & CL_DEVICE_TYPE_CPU;
    const std::uint64_t alignment =
        cl_value<cl_uint>(context_->device, CL_DEVICE_MEM_BASE_ADDR_ALIGN) / 8;
    if (alignment > slice_alignment) {
        throw Error(ErrorKind::device,
                    "OpenCL device " + info_.name + " aligns parts of buffers to " +
                        std::to_string(alignment) + " bytes, more than topple's " +
                        std::to_string(slice_alignment));
    }
    // IEEE division and square root, where the device leaves a choice: all backends give the same
    // bits.
    const auto floats = cl_value<cl_device_fp_config>(context_->device, CL_DEVICE_SINGLE_FP_CONFIG);
    build_options_ = "-cl-std=CL1.2";
    if (floats & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) {
        build_options_ += " -cl-fp32-correctly-rounded-divide-sqrt";
    }
    pool_memory();
    record(Trace::of_environment());
}

std::unique_ptr<Memory> OpenClDevice::make_memory(std::uint64_t bytes, const std::string& name) {
    return std::make_unique<OpenClMemory>(*this, bytes, name);
}

void OpenClDevice::send(Memory& to, std::uint64_t offset, std::span<const std::byte> from) {
    cl_check(clEnqueueWriteBuffer(context_->transfers, own<OpenClMemory>(to).buffer(), CL_TRUE,
                                  offset, from.size(), from.data(), 0, nullptr, nullptr),
             "writing buffer " + to.name());
}

void OpenClDevice::fetch(Memory& from, std::uint64_t offset, std::span<std::byte> to) {
    cl_check(clEnqueueReadBuffer(context_->transfers, own<OpenClMemory>(from).buffer(), CL_TRUE,
                                 offset, to.size(), to.data(), 0, nullptr, nullptr),
             "reading buffer " + from.name());
}

void OpenClDevice::fill_apart(Memory& memory, std::uint64_t offset, std::uint64_t bytes,
                              std::uint32_t word) {
    cl_check(clEnqueueFillBuffer(context_->transfers, own<OpenClMemory>(memory).buffer(), &word,
                                 sizeof(word), offset, bytes, 0, nullptr, nullptr),
             "filling buffer " + memory.name());
    cl_check(clFinish(context_->transfers), "filling buffer " + memory.name());
}

void OpenClDevice::prepare(const KernelSource& source) {
    kernel(source);
}

cl_kernel OpenClDevice::kernel(const KernelSource& source) {
    auto found = kernels_.find(&source);
    if (found == kernels_.end()) {
        const TraceSpan span(trace(), "build", source.name);
        found = kernels_.emplace(&source, build(source)).first;
        ++counters_.kernel_builds;
    }
    return found->second.kernel.get();
}

OpenClDevice::Built OpenClDevice::build(const KernelSource& source) const {
    const std::string where = std::string("kernel ") + source.name;
    cl_int code = CL_SUCCESS;
    Built built;
    const cl_program program = clCreateProgramWithSource(
        context_->context, 1, const_cast<const char**>(&source.opencl), nullptr, &code);
    cl_check(code, where);
    built.program.reset(program);
    const std::string options =
        build_options_ + " -D ITEMS=" + std::to_string(items_per_lane(source));
    code = clBuildProgram(program, 1, &context_->device, options.c_str(), nullptr, nullptr);
    std::size_t group = 0;
    if (code == CL_SUCCESS) built.kernel.reset(clCreateKernel(program, source.name, &code));
    if (code == CL_SUCCESS) {
        code = clGetKernelWorkGroupInfo(built.kernel.get(), context_->device,
                                        CL_KERNEL_WORK_GROUP_SIZE, sizeof(group), &group, nullptr);
    }
    if (code == CL_SUCCESS && group >= source.group_size) return built;

    std::string why = cl_error_name(code);
    if (code == CL_SUCCESS) {
        why = "its groups of " + std::to_string(source.group_size) + " are more than the " +
              std::to_string(group) + " work-items that " + info_.name + " can run together";
    } else {
        std::size_t size = 0;
        clGetProgramBuildInfo(program, context_->device, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size);
        std::string log(size, '\0');
        clGetProgramBuildInfo(program, context_->device, CL_PROGRAM_BUILD_LOG, size, log.data(),
                              nullptr);
        why += ": ";
        why += one_line(log);
    }
    throw Error(ErrorKind::device, where + " does not build for " + info_.name + ": " + why);
}

ClEvent OpenClDevice::enqueue(const Dispatch& dispatch, std::vector<ClMem>& parts) {
    const std::string where = std::string("kernel ") + dispatch.kernel->name;
    const cl_kernel kernel_handle = kernel(*dispatch.kernel);
    cl_uint index = 0;
    for (const BoundRange& range : dispatch.ranges) {
        auto& memory = own<OpenClMemory>(*range.memory);
        memory.unmap();
        cl_mem buffer = memory.buffer();
        if (range.offset != 0 || range.bytes != memory.bytes()) {
            const cl_buffer_region region{range.offset, std::max<std::size_t>(4, range.bytes)};
            cl_int code = CL_SUCCESS;
            buffer = clCreateSubBuffer(buffer, 0, CL_BUFFER_CREATE_TYPE_REGION, &region, &code);
            cl_check(code, where + ": part of buffer " + memory.name());
            parts.emplace_back(buffer);
        }
        cl_check(clSetKernelArg(kernel_handle, index++, sizeof(buffer), &buffer),
                 where + ": buffer " + memory.name());
    }
    cl_check(clSetKernelArg(kernel_handle, index, dispatch.params.size(), dispatch.params.data()),
             where + ": parameters");
    const std::size_t local = dispatch.kernel->group_size;
    const std::size_t global = dispatch.groups * local;
    cl_event event = nullptr;
    cl_check(clEnqueueNDRangeKernel(context_->queue, kernel_handle, 1, nullptr, &global, &local, 0,
                                    nullptr, &event),
             where);
    return ClEvent(event);
}

void OpenClDevice::finish(const std::string& what) {
    const TraceSpan span(trace(), "wait", what);
    cl_check(clFinish(context_->queue), what);
}

std::string OpenClDevice::time_dispatches() {
    profiles_ = context_->profile();
    return profiles_ ? "its own clock"
                     : "the host's clock, one by one: the queue that was given does not profile";
}

// With CL_QUEUE_PROFILING_ENABLE as the device says, else as the host sees each one.
void OpenClDevice::run_timed(std::span<const Dispatch> dispatches, std::vector<ClMem>& parts) {
    const std::uint64_t cpu_before = process_cpu_ns();
    std::vector<ClEvent> events;
    std::vector<DispatchTime> times;
    for (const Dispatch& dispatch : dispatches) {
        const std::int64_t begin_ns = to_ns(Trace::Clock::now());
        events.push_back(enqueue(dispatch, parts));
        if (!profiles_) {
            finish(std::string("kernel ") + dispatch.kernel->name);
            times.push_back({begin_ns, to_ns(Trace::Clock::now())});
        }
    }
    if (profiles_) finish(ending_in(dispatches));
    const auto ended = Trace::Clock::now();
    const std::uint64_t cpu_ns = process_cpu_ns() - cpu_before;
    for (std::size_t e = 0; profiles_ && e < events.size(); ++e) {
        const auto at = [&](cl_profiling_info what) {
            cl_ulong ns = 0;
            cl_check(clGetEventProfilingInfo(events[e].get(), what, sizeof(ns), &ns, nullptr),
                     "time of a kernel");
            return static_cast<std::int64_t>(ns);
        };
        times.push_back({at(CL_PROFILING_COMMAND_START), at(CL_PROFILING_COMMAND_END)});
    }
    share_cpu(times, cpu_ns);
    trace_dispatches(dispatches, times, ended);
}

std::unique_ptr<Running> OpenClDevice::begin(std::vector<Dispatch> batch, bool) {
    // All that can be wrong with a batch is found before any of it runs.
    for (const Dispatch& dispatch : batch) kernel(*dispatch.kernel);
    std::vector<ClMem> parts;
    std::unique_ptr<Running> running;
    // In-order: each dispatch sees what the ones before it wrote.
    try {
        if (trace()) {
            run_timed(batch, parts);
        } else {
            ClEvent last;
            for (const Dispatch& dispatch : batch) last = enqueue(dispatch, parts);
            cl_check(clFlush(context_->queue), ending_in(batch));
            running =
                std::make_unique<OpenClBatch>(ending_in(batch), std::move(last), std::move(parts));
        }
    } catch (const Error&) {
        clFinish(context_->queue);
        for (const Dispatch& dispatch : batch)
            for (const BoundRange& range : dispatch.ranges) range.memory->batch_ended();
        throw;
    }
    count(batch);
    return running;
}

}  // namespace topple::device

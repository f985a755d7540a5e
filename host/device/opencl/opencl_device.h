// SPDX-License-Identifier: MIT
#pragma once

#include <CL/cl.h>

#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "topple/kernels/device.h"

namespace topple::device {

// An object of OpenCL's, and what lets go of it.
template <class T, cl_int (*release)(T)>
struct ClRelease {
    using pointer = T;
    void operator()(T object) const { release(object); }
};
using ClProgram = std::unique_ptr<_cl_program, ClRelease<cl_program, clReleaseProgram>>;
using ClKernel = std::unique_ptr<_cl_kernel, ClRelease<cl_kernel, clReleaseKernel>>;
using ClEvent = std::unique_ptr<_cl_event, ClRelease<cl_event, clReleaseEvent>>;
using ClMem = std::unique_ptr<_cl_mem, ClRelease<cl_mem, clReleaseMemObject>>;

// A context, one device and its in-order queues, released at the end only where `owned`.
struct OpenClContext {
    cl_context context = nullptr;
    cl_device_id device = nullptr;
    cl_command_queue queue = nullptr;  // of the batches
    // Of what the host reads, writes and maps, which so waits for no batch but those that it has to
    // wait for before. With a caller's handles the same as the other: what they enqueue there goes
    // before all of ours.
    cl_command_queue transfers = nullptr;
    bool owned = false;

    OpenClContext() = default;
    OpenClContext(const OpenClContext&) = delete;
    OpenClContext& operator=(const OpenClContext&) = delete;
    ~OpenClContext();

    // Lets the queue time what it runs; one that is the caller's stays as it is. Whether it does.
    bool profile();
};

// What a device says of itself.
DeviceInfo describe_opencl(cl_device_id device);

class OpenClDevice;

class OpenClMemory final : public Memory {
  public:
    OpenClMemory(const OpenClDevice& device, std::uint64_t bytes, const std::string& name);
    // The caller's buffer of that size, which stays theirs.
    OpenClMemory(const OpenClDevice& device, cl_mem buffer, std::uint64_t bytes,
                 const std::string& name);
    ~OpenClMemory() override;

    // Maps the buffer from here on, but for while a batch binds it: OpenCL leaves a kernel's access
    // to a mapped buffer undefined. The address stays the same, since the buffer lies in memory of
    // ours (OpenCL 1.2, 5.4.3).
    std::byte* host_address() override;
    std::byte* in_place() override { return mapped_ ? host_.get() : nullptr; }
    void batch_ended() override;
    void given_back() override;

    // For a batch, on its queue.
    void unmap();
    cl_mem buffer() const { return buffer_; }

  private:
    struct Free {
        void operator()(std::byte* p) const { std::free(p); }
    };
    const OpenClContext& context_;
    std::unique_ptr<std::byte, Free> host_;  // null where the device has memory of its own
    cl_mem buffer_ = nullptr;
    bool mapped_ = false, viewed_ = false;  // viewed: by the holder, at any time
    void map();
};

class OpenClDevice final : public Device {
  public:
    explicit OpenClDevice(std::unique_ptr<OpenClContext> context);

    ~OpenClDevice() override { settle(); }

    void prepare(const KernelSource& kernel) override;

    const OpenClContext& handles() const { return *context_; }
    bool shares_host_memory() const { return shares_host_memory_; }

  private:
    std::unique_ptr<Memory> make_memory(std::uint64_t bytes, const std::string& name) override;
    std::unique_ptr<Running> begin(std::vector<Dispatch> batch, bool at_once) override;
    void send(Memory& to, std::uint64_t offset, std::span<const std::byte> from) override;
    void fetch(Memory& from, std::uint64_t offset, std::span<std::byte> to) override;
    void fill_apart(Memory& memory, std::uint64_t offset, std::uint64_t bytes,
                    std::uint32_t word) override;
    std::string time_dispatches() override;
    struct Built {
        ClProgram program;
        ClKernel kernel;
    };
    cl_kernel kernel(const KernelSource& source);
    Built build(const KernelSource& source) const;
    ClEvent enqueue(const Dispatch& dispatch, std::vector<ClMem>& parts);
    void finish(const std::string& what);
    void run_timed(std::span<const Dispatch> dispatches, std::vector<ClMem>& parts);

    std::unique_ptr<OpenClContext> context_;
    bool shares_host_memory_ = false, profiles_ = false;
    std::string build_options_;
    std::map<const KernelSource*, Built> kernels_;  // looked up only, never iterated for a result
};

}  // namespace topple::device

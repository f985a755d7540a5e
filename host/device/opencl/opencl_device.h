// SPDX-License-Identifier: MIT
#pragma once

#include <CL/cl.h>

#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "device/device.h"

namespace topple::device {

// A context, one device and one in-order queue, released at the end only where `owned`.
struct OpenClContext {
    cl_context context = nullptr;
    cl_device_id device = nullptr;
    cl_command_queue queue = nullptr;
    bool owned = false;

    OpenClContext() = default;
    OpenClContext(OpenClContext&& other) noexcept;
    OpenClContext& operator=(OpenClContext&&) = delete;
    ~OpenClContext();
};

// What a device says of itself.
DeviceInfo describe_opencl(cl_device_id device);

class OpenClDevice;

class OpenClMemory final : public Memory {
  public:
    OpenClMemory(OpenClDevice& device, std::uint64_t bytes, std::string name);
    // The caller's buffer of that size, which stays theirs.
    OpenClMemory(OpenClDevice& device, cl_mem buffer, std::uint64_t bytes, std::string name);
    ~OpenClMemory() override;
    OpenClMemory(const OpenClMemory&) = delete;
    OpenClMemory& operator=(const OpenClMemory&) = delete;

    std::uint64_t bytes() const override { return bytes_; }
    const std::string& name() const override { return name_; }
    // Maps the buffer until the next run that uses it, which unmaps it meanwhile: OpenCL leaves a
    // kernel's access to a mapped buffer undefined. The address stays the same, since the buffer
    // lies in memory of ours (OpenCL 1.2, 5.4.3).
    std::byte* host_address() override;

    void map();
    void unmap();
    bool mapped() const { return mapped_; }
    cl_mem buffer() const { return buffer_; }
    const OpenClDevice& device() const { return device_; }

  private:
    struct Free {
        void operator()(std::byte* p) const { std::free(p); }
    };
    OpenClDevice& device_;
    std::uint64_t bytes_;
    std::string name_;
    std::unique_ptr<std::byte, Free> host_;  // null where the device has memory of its own
    cl_mem buffer_ = nullptr;
    bool mapped_ = false;
};

class OpenClDevice final : public Device {
  public:
    explicit OpenClDevice(OpenClContext context);
    ~OpenClDevice() override;

    std::unique_ptr<Memory> allocate(std::uint64_t bytes, const std::string& name) override;
    void write(Memory& to, std::uint64_t offset, std::span<const std::byte> from) override;
    void read(Memory& from, std::uint64_t offset, std::span<std::byte> to) override;
    void fill(Memory& memory, std::uint64_t offset, std::uint64_t bytes,
              std::uint32_t word) override;
    void run(std::span<const Dispatch> dispatches) override;
    void prepare(const KernelSource& kernel) override;

    const OpenClContext& handles() const { return context_; }
    bool shares_host_memory() const { return shares_host_memory_; }

  private:
    struct Built {
        cl_program program = nullptr;
        cl_kernel kernel = nullptr;
    };
    OpenClMemory& own(Memory& memory) const;
    cl_kernel kernel(const KernelSource& source);
    Built build(const KernelSource& source) const;
    void enqueue(const Dispatch& dispatch, std::vector<cl_mem>& parts);

    OpenClContext context_;
    bool shares_host_memory_ = false;
    std::string build_options_;
    std::map<const KernelSource*, Built> kernels_;  // looked up only, never iterated for a result
};

}  // namespace topple::device

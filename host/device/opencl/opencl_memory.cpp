// SPDX-License-Identifier: MIT
#include "device/opencl/opencl_device.h"
#include "device/opencl/opencl_error.h"
#include "topple/error.h"

namespace topple::device {
namespace {

constexpr std::uint64_t page = 4096;
// An empty slice at a buffer's very end still binds something.
constexpr std::uint64_t opencl_tail = 16;

}  // namespace

OpenClMemory::OpenClMemory(const OpenClDevice& device, std::uint64_t bytes, const std::string& name)
    : Memory(device, bytes, name), context_(device.handles()) {
    cl_mem_flags flags = CL_MEM_READ_WRITE;
    if (device.shares_host_memory()) {
        const std::uint64_t padded = (bytes + opencl_tail + page - 1) / page * page;
        host_.reset(static_cast<std::byte*>(std::aligned_alloc(page, padded)));
        if (!host_) {
            throw OutOfMemory(ErrorKind::device, "buffer " + name + ": the system has no " +
                                                     std::to_string(bytes) + " bytes left");
        }
        flags |= CL_MEM_USE_HOST_PTR;
    }
    cl_int code = CL_SUCCESS;
    buffer_ =
        clCreateBuffer(device.handles().context, flags, bytes + opencl_tail, host_.get(), &code);
    cl_check(code, "buffer " + name + " of " + std::to_string(bytes) + " bytes");
}

OpenClMemory::OpenClMemory(const OpenClDevice& device, cl_mem buffer, std::uint64_t bytes,
                           const std::string& name)
    : Memory(device, bytes, name), context_(device.handles()), buffer_(buffer) {
    cl_check(clRetainMemObject(buffer_), "buffer " + name);
}

OpenClMemory::~OpenClMemory() {
    given_back();
    clReleaseMemObject(buffer_);
}

std::byte* OpenClMemory::host_address() {
    if (!host_) return nullptr;
    viewed_ = true;
    map();
    return host_.get();
}

void OpenClMemory::batch_ended() {
    if (!viewed_) return;
    try {
        map();
    } catch (const Error&) {  // the device is lost; the next use says so
    }
}

void OpenClMemory::given_back() {
    viewed_ = false;
    if (!mapped_) return;
    clEnqueueUnmapMemObject(context_.transfers, buffer_, host_.get(), 0, nullptr, nullptr);
    clFinish(context_.transfers);
    mapped_ = false;
}

void OpenClMemory::map() {
    if (mapped_) return;
    cl_int code = CL_SUCCESS;
    clEnqueueMapBuffer(context_.transfers, buffer_, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0,
                       bytes() + opencl_tail, 0, nullptr, nullptr, &code);
    cl_check(code, "mapping buffer " + name());
    mapped_ = true;
}

void OpenClMemory::unmap() {
    if (!mapped_) return;
    cl_check(clEnqueueUnmapMemObject(context_.queue, buffer_, host_.get(), 0, nullptr, nullptr),
             "unmapping buffer " + name());
    mapped_ = false;
}

}  // namespace topple::device

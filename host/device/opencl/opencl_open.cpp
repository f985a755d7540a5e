// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <mutex>

#include "device/devices.h"
#include "device/opencl/opencl_device.h"
#include "device/opencl/opencl_error.h"
#include "topple/embed.h"
#include "topple/error.h"

namespace topple::device {
namespace {

constexpr const char* opencl_mend = "; install a driver, such as the package pocl-opencl-icd";

// Held wherever drivers are listed, and contexts made and released: the specification says that
// these calls may come from any thread, PoCL and the loader crash where they come from several.
// Recursive: a context that can't be finished is released where it was made.
std::recursive_mutex drivers;

struct Found {
    cl_platform_id platform;
    cl_device_id device;
    std::string problem;  // why it can't be used; empty where it can
};

// Whether a version such as "OpenCL 1.2 pocl ..." will do.
bool at_least_1_2(const std::string& version) {
    int major = 0, minor = 0;
    if (std::sscanf(version.c_str(), "OpenCL %d.%d", &major, &minor) != 2) return false;
    return major > 1 || minor >= 2;
}

std::string problem_of(cl_device_id device) {
    if (!cl_value<cl_bool>(device, CL_DEVICE_AVAILABLE))
        return "its driver says that it is not available";
    if (!cl_value<cl_bool>(device, CL_DEVICE_COMPILER_AVAILABLE))
        return "its driver has no compiler";
    if (!at_least_1_2(cl_text(device, CL_DEVICE_VERSION))) return "it offers less than OpenCL 1.2";
    if (cl_value<cl_uint>(device, CL_DEVICE_MEM_BASE_ADDR_ALIGN) / 8 > slice_alignment) {
        return "it aligns parts of buffers to more than " + std::to_string(slice_alignment) +
               " bytes";
    }
    return {};
}

// All devices of all platforms, in the drivers' order. Throws Error(device) where there are none.
std::vector<Found> find_all() {
    cl_uint count = 0;
    const cl_int code = clGetPlatformIDs(0, nullptr, &count);
    if (code != CL_SUCCESS || count == 0) {
        throw Error(ErrorKind::device,
                    "OpenCL finds no driver (" + cl_error_name(code) + ")" + opencl_mend);
    }
    std::vector<cl_platform_id> platforms(count);
    cl_check(clGetPlatformIDs(count, platforms.data(), nullptr), "listing OpenCL platforms");
    std::vector<Found> found;
    for (cl_platform_id platform : platforms) {
        cl_uint devices = 0;
        if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &devices) != CL_SUCCESS)
            continue;
        std::vector<cl_device_id> ids(devices);
        if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, devices, ids.data(), nullptr) !=
            CL_SUCCESS)
            continue;
        for (cl_device_id id : ids) found.push_back({platform, id, problem_of(id)});
    }
    if (found.empty())
        throw Error(ErrorKind::device, std::string("OpenCL finds no device") + opencl_mend);
    return found;
}

int rank(const Found& found) {
    if (!found.problem.empty()) return 2;
    return cl_value<cl_device_type>(found.device, CL_DEVICE_TYPE) & CL_DEVICE_TYPE_GPU ? 0 : 1;
}

std::unique_ptr<OpenClContext> make_context(const Found& found) {
    const std::string where = "OpenCL device " + cl_text(found.device, CL_DEVICE_NAME);
    auto made = std::make_unique<OpenClContext>();
    made->device = found.device;
    made->owned = true;
    const cl_context_properties properties[] = {
        CL_CONTEXT_PLATFORM, reinterpret_cast<cl_context_properties>(found.platform), 0};
    cl_int code = CL_SUCCESS;
    made->context = clCreateContext(properties, 1, &found.device, nullptr, nullptr, &code);
    cl_check(code, where + ": context");
    made->queue = clCreateCommandQueue(made->context, found.device, 0, &code);
    cl_check(code, where + ": queue");
    made->transfers = clCreateCommandQueue(made->context, found.device, 0, &code);
    cl_check(code, where + ": queue for transfers");
    return made;
}

}  // namespace

OpenClContext::~OpenClContext() {
    if (!owned) return;
    const std::lock_guard lock(drivers);
    if (transfers) clReleaseCommandQueue(transfers);
    if (queue) clReleaseCommandQueue(queue);
    if (context) clReleaseContext(context);
}

bool OpenClContext::profile() {
    cl_command_queue_properties properties = 0;
    cl_check(
        clGetCommandQueueInfo(queue, CL_QUEUE_PROPERTIES, sizeof(properties), &properties, nullptr),
        "OpenCL queue");
    if (properties & CL_QUEUE_PROFILING_ENABLE) return true;
    if (!owned) return false;
    const std::lock_guard lock(drivers);
    cl_int code = CL_SUCCESS;
    const cl_command_queue profiling =
        clCreateCommandQueue(context, device, CL_QUEUE_PROFILING_ENABLE, &code);
    cl_check(code, "OpenCL queue that profiles");
    clFinish(queue);
    clReleaseCommandQueue(queue);
    queue = profiling;
    return true;
}

DeviceInfo describe_opencl(cl_device_id device) {
    DeviceInfo info;
    info.backend = Backend::opencl;
    info.name = cl_text(device, CL_DEVICE_NAME);
    const auto platform = cl_value<cl_platform_id>(device, CL_DEVICE_PLATFORM);
    info.driver = cl_text(platform, CL_PLATFORM_NAME) + ", " + cl_text(device, CL_DRIVER_VERSION);
    const auto type = cl_value<cl_device_type>(device, CL_DEVICE_TYPE);
    info.gpu = (type & CL_DEVICE_TYPE_GPU) && !(type & CL_DEVICE_TYPE_CPU);
    const auto largest = cl_value<cl_ulong>(device, CL_DEVICE_MAX_MEM_ALLOC_SIZE);
    info.limits.max_allocation_bytes = largest > slice_alignment ? largest - slice_alignment : 0;
    info.limits.max_binding_bytes = info.limits.max_allocation_bytes;
    info.limits.memory_bytes = cl_value<cl_ulong>(device, CL_DEVICE_GLOBAL_MEM_SIZE);
    info.limits.max_group_size =
        static_cast<std::uint32_t>(cl_value<std::size_t>(device, CL_DEVICE_MAX_WORK_GROUP_SIZE));
    info.limits.shared_bytes =
        static_cast<std::uint32_t>(cl_value<cl_ulong>(device, CL_DEVICE_LOCAL_MEM_SIZE));
    return info;
}

std::vector<Listing> list_opencl() {
    const std::lock_guard lock(drivers);
    std::vector<Listing> listings;
    try {
        for (const Found& found : find_all()) {
            listings.push_back(unusable(Backend::opencl, found.problem));
            listings.back().usable = found.problem.empty();
            listings.back().info = describe_opencl(found.device);
        }
    } catch (const Error& error) {
        listings.push_back(unusable(Backend::opencl, error.what()));
    }
    return listings;
}

std::unique_ptr<Device> open_opencl() {
    const std::lock_guard lock(drivers);
    const std::vector<Found> all = find_all();
    const Found& best = *std::ranges::min_element(all, {}, [](const Found& f) { return rank(f); });
    if (!best.problem.empty()) {
        throw Error(ErrorKind::device, "OpenCL device " + cl_text(best.device, CL_DEVICE_NAME) +
                                           " can't be used: " + best.problem + opencl_mend);
    }
    return std::make_unique<OpenClDevice>(make_context(best));
}

std::shared_ptr<Device> adopt_opencl(const OpenClHandles& handles) {
    auto given = std::make_unique<OpenClContext>();
    given->context = static_cast<cl_context>(handles.context);
    given->device = static_cast<cl_device_id>(handles.device_id);
    given->queue = given->transfers = static_cast<cl_command_queue>(handles.queue);
    if (!given->context || !given->device || !given->queue) {
        throw Error(ErrorKind::device,
                    "adopt_opencl needs a context, a device and a queue, none of them null");
    }
    const std::lock_guard lock(drivers);
    cl_command_queue_properties properties = 0;
    cl_check(clGetCommandQueueInfo(given->queue, CL_QUEUE_PROPERTIES, sizeof(properties),
                                   &properties, nullptr),
             "adopt_opencl: queue");
    if (properties & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE) {
        throw Error(ErrorKind::device, "adopt_opencl needs an in-order queue");
    }
    if (const std::string problem = problem_of(given->device); !problem.empty()) {
        throw Error(ErrorKind::device, "adopt_opencl: the device can't be used: " + problem);
    }
    return std::make_shared<OpenClDevice>(std::move(given));
}

}  // namespace topple::device

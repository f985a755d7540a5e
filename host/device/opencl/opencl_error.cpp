// SPDX-License-Identifier: MIT
#include "device/opencl/opencl_error.h"

#include <string_view>
#include <utility>

#include "topple/error.h"

namespace topple::device {
namespace {

// What get() tells of one of them.
template <class Get, class Of>
std::string text_of(const Get& get, Of of, cl_uint key) {
    std::size_t size = 0;
    if (get(of, key, 0, nullptr, &size) != CL_SUCCESS) return {};
    std::string text(size, '\0');
    if (get(of, key, size, text.data(), nullptr) != CL_SUCCESS) return {};
    // Drivers count the terminating zero in.
    text.erase(text.find_last_not_of(std::string_view("\0 \n", 3)) + 1);
    return text;
}

}  // namespace

std::string cl_error_name(cl_int code) {
    static constexpr std::pair<cl_int, const char*> names[] = {
        {CL_DEVICE_NOT_FOUND, "CL_DEVICE_NOT_FOUND"},
        {CL_DEVICE_NOT_AVAILABLE, "CL_DEVICE_NOT_AVAILABLE"},
        {CL_COMPILER_NOT_AVAILABLE, "CL_COMPILER_NOT_AVAILABLE"},
        {CL_MEM_OBJECT_ALLOCATION_FAILURE, "CL_MEM_OBJECT_ALLOCATION_FAILURE"},
        {CL_OUT_OF_RESOURCES, "CL_OUT_OF_RESOURCES"},
        {CL_OUT_OF_HOST_MEMORY, "CL_OUT_OF_HOST_MEMORY"},
        {CL_BUILD_PROGRAM_FAILURE, "CL_BUILD_PROGRAM_FAILURE"},
        {CL_MISALIGNED_SUB_BUFFER_OFFSET, "CL_MISALIGNED_SUB_BUFFER_OFFSET"},
        {CL_INVALID_VALUE, "CL_INVALID_VALUE"},
        {CL_INVALID_DEVICE, "CL_INVALID_DEVICE"},
        {CL_INVALID_CONTEXT, "CL_INVALID_CONTEXT"},
        {CL_INVALID_COMMAND_QUEUE, "CL_INVALID_COMMAND_QUEUE"},
        {CL_INVALID_MEM_OBJECT, "CL_INVALID_MEM_OBJECT"},
        {CL_INVALID_BINARY, "CL_INVALID_BINARY"},
        {CL_INVALID_BUILD_OPTIONS, "CL_INVALID_BUILD_OPTIONS"},
        {CL_INVALID_KERNEL_NAME, "CL_INVALID_KERNEL_NAME"},
        {CL_INVALID_ARG_INDEX, "CL_INVALID_ARG_INDEX"},
        {CL_INVALID_ARG_VALUE, "CL_INVALID_ARG_VALUE"},
        {CL_INVALID_ARG_SIZE, "CL_INVALID_ARG_SIZE"},
        {CL_INVALID_KERNEL_ARGS, "CL_INVALID_KERNEL_ARGS"},
        {CL_INVALID_WORK_GROUP_SIZE, "CL_INVALID_WORK_GROUP_SIZE"},
        {CL_INVALID_GLOBAL_WORK_SIZE, "CL_INVALID_GLOBAL_WORK_SIZE"},
        {CL_INVALID_BUFFER_SIZE, "CL_INVALID_BUFFER_SIZE"},
        {CL_INVALID_OPERATION, "CL_INVALID_OPERATION"},
        {-1001, "CL_PLATFORM_NOT_FOUND_KHR"},
    };
    for (const auto& [known, name] : names)
        if (known == code) return name;
    return "OpenCL error " + std::to_string(code);
}

void cl_check(cl_int code, const std::string& what) {
    if (code != CL_SUCCESS) throw Error(ErrorKind::device, what + ": " + cl_error_name(code));
}

std::string cl_text(cl_platform_id platform, cl_platform_info key) {
    return text_of(clGetPlatformInfo, platform, key);
}

std::string cl_text(cl_device_id device, cl_device_info key) {
    return text_of(clGetDeviceInfo, device, key);
}

}  // namespace topple::device

// SPDX-License-Identifier: MIT
#pragma once

#include <CL/cl.h>

#include <string>

namespace topple::device {

// The specification's name of an OpenCL error code.
std::string cl_error_name(cl_int code);

// Throws Error(device) "<what>: <name of code>" unless code is CL_SUCCESS.
void cl_check(cl_int code, const std::string& what);

// A string property of a platform or device; empty where it can't be had.
std::string cl_text(cl_platform_id platform, cl_platform_info key);
std::string cl_text(cl_device_id device, cl_device_info key);

// A plain property of a device; T{} where it can't be had.
template <class T>
T cl_value(cl_device_id device, cl_device_info key) {
    T value{};
    if (clGetDeviceInfo(device, key, sizeof(value), &value, nullptr) != CL_SUCCESS) return T{};
    return value;
}

}  // namespace topple::device

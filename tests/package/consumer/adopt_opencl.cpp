// SPDX-License-Identifier: MIT
#include <CL/cl.h>

#include <cstdio>

#include "topple/embed.h"
#include "topple/parse.h"

// A program with an OpenCL context of its own, on which it parses the scan that it is given. It
// exits with 77 where there is no OpenCL driver for a CPU.
namespace {

constexpr int skipped = 77;

// The first CPU device: what it computes equals the native backend's bits, which a GPU's need not.
cl_device_id cpu_device() {
    cl_platform_id platforms[8];
    cl_uint count = 0;
    if (clGetPlatformIDs(8, platforms, &count) != CL_SUCCESS) return nullptr;
    cl_device_id device = nullptr;
    for (cl_uint i = 0; i < count && i < 8 && !device; ++i) {
        if (clGetDeviceIDs(platforms[i], CL_DEVICE_TYPE_CPU, 1, &device, nullptr) != CL_SUCCESS)
            device = nullptr;
    }
    return device;
}

// Whether the parse ran where it was told to, and told it all.
bool parse_on(cl_context context, cl_device_id device, cl_command_queue queue, const char* scan) {
    topple::ParseOptions options;
    options.device = topple::device::adopt_opencl({context, device, queue});
    options.disturbances = {"wind"};
    const topple::Scene scene = topple::parse(scan, options).scene;
    std::printf("%zu objects on %s\n", scene.objects.size(), scene.backend.c_str());
    return scene.backend == "opencl" &&
           scene.device == topple::device::describe(*options.device).name;
}

}  // namespace

int main(int, char** argv) {
    cl_device_id device = cpu_device();
    if (!device) {
        std::fprintf(stderr, "OpenCL offers no CPU device\n");
        return skipped;
    }
    cl_context context = clCreateContext(nullptr, 1, &device, nullptr, nullptr, nullptr);
    cl_command_queue queue = clCreateCommandQueue(context, device, 0, nullptr);
    bool right = false;
    try {
        right = parse_on(context, device, queue, argv[1]);
    } catch (const topple::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
    }
    // What was adopted is gone by now; the handles are still ours, and ours alone.
    cl_uint references = 0;
    right = right && clFinish(queue) == CL_SUCCESS &&
            clGetCommandQueueInfo(queue, CL_QUEUE_REFERENCE_COUNT, sizeof(references), &references,
                                  nullptr) == CL_SUCCESS &&
            references == 1;
    clReleaseCommandQueue(queue);
    clReleaseContext(context);
    return right ? 0 : 1;
}

// SPDX-License-Identifier: MIT
#include "device/devices.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

#include "device/probe.h"
#include "topple/error.h"

namespace topple::device {
namespace {

bool has_gpu(const std::vector<Listing>& listings) {
    return std::ranges::any_of(
        listings, [](const Listing& listing) { return listing.usable && listing.info.gpu; });
}

// Throws Error(device) where a backend's driver did not survive, or has nothing to offer.
void check_driver(Backend backend) {
    const std::vector<Listing> found = probe(backend);
    if (std::ranges::any_of(found, &Listing::usable)) return;
    for (const Listing& listing : found) {
        // Other problems are told by opening it, with the device's name.
        if (listing.info.name.empty() && !listing.problem.empty())
            throw Error(ErrorKind::device,
                        std::string(to_string(backend)) + " can't be used: " + listing.problem);
    }
}

// Whether the system has a node of any GPU's driver. To ask the drivers themselves takes a tenth of
// a second, since software drivers load their compilers.
bool may_have_gpu() {
#ifdef __linux__
    // Mesa's and others' in the kernel, NVIDIA's, AMD's for computing, Windows' below Linux, and
    // those of telephones' chips.
    constexpr std::array nodes{"/dev/dri", "/dev/nvidiactl", "/dev/kfd",
                               "/dev/dxg", "/dev/mali0",     "/dev/kgsl-3d0"};
    return std::ranges::any_of(nodes, [](const char* node) {
        std::error_code error;
        return std::filesystem::exists(node, error);
    });
#else
    return true;
#endif
}

// A software driver behind a GPU's interface is slower than the native backend on the same CPU, so
// "auto" takes only a real GPU. Vulkan first: its kernels are built ahead of time.
std::unique_ptr<Device> open_best(unsigned threads) {
    if (!may_have_gpu()) return open_native(threads);
    if (has_gpu(probe(Backend::vulkan))) return open_vulkan();
    if (has_gpu(probe(Backend::opencl))) return open_opencl();
    return open_native(threads);
}

}  // namespace

Listing unusable(Backend backend, const std::string& problem) {
    Listing listing;
    listing.backend = backend;
    listing.problem = problem;
    return listing;
}

std::vector<Listing> list_native() {
    return {{Backend::native, true, open_native()->info(), ""}};
}

std::vector<Listing> list_devices() {
    std::vector<Listing> all = list_native();
    for (const auto& list : {probe(Backend::opencl), probe(Backend::vulkan)}) {
        all.insert(all.end(), list.begin(), list.end());
    }
    return all;
}

std::shared_ptr<Device> open_device(const std::string& backend, unsigned threads) {
    if (backend == "auto") return open_best(threads);
    if (backend == "native") return open_native(threads);
    if (backend == "opencl") {
        check_driver(Backend::opencl);
        return open_opencl();
    }
    if (backend == "vulkan") {
        check_driver(Backend::vulkan);
        return open_vulkan();
    }
    throw Error(ErrorKind::usage, "backend (--backend) " + backend +
                                      " is unknown; take auto, native, opencl or vulkan");
}

}  // namespace topple::device

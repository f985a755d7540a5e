// SPDX-License-Identifier: MIT
#include <algorithm>

#include "api/c_support.h"
#include "topple/embed.h"
#include "topple/version.h"

namespace topple::c_api {
namespace {

template <std::size_t size>
void copy_text(std::string_view from, char (&to)[size]) {
    const std::size_t length = std::min(from.size(), size - 1);
    std::copy_n(from.data(), length, to);  // an empty view may have no data
    to[length] = 0;
}

template <class Open>
int opened(topple_device** device, topple_status* status, const Open& open) {
    return guarded(status, [&] {
        needed(device, "device") = nullptr;
        *device = new topple_device{open()};
    });
}

}  // namespace

int set(topple_status* status, int code, std::string_view message) noexcept {
    if (status) {
        status->code = code;
        copy_text(message, status->message);
    }
    return code;
}

int set(topple_status* status, const Error& error) noexcept {
    const auto code = [&] {
        switch (error.kind()) {
            case ErrorKind::input:
                return TOPPLE_ERROR_INPUT;
            case ErrorKind::usage:
                return TOPPLE_ERROR_USAGE;
            case ErrorKind::device:
                return TOPPLE_ERROR_DEVICE;
            case ErrorKind::cancelled:
                return TOPPLE_ERROR_CANCELLED;
        }
        return TOPPLE_ERROR_INTERNAL;
    };
    return set(status, code(), error.what());
}

namespace {

// Three columns of the caller's. Columns keep no count without values: of those where one is given
// all must be, or what is NULL here would be read later.
template <class T>
void take_columns(std::uint64_t count, std::int64_t stride_bytes, std::array<const T*, 3> from,
                  const char* names, std::array<Column<T>*, 3> to) {
    if (count > 0 && std::ranges::find(from, nullptr) != from.end())
        throw Error(ErrorKind::usage, std::string("cloud: ") + names + " must not be NULL");
    const auto stride = stride_bytes ? stride_bytes : std::int64_t{sizeof(T)};
    for (std::size_t n = 0; n < 3; ++n)
        *to[n] = {from[n], count, static_cast<std::ptrdiff_t>(stride)};
}

}  // namespace

CloudView view_of(const topple_cloud* cloud) {
    const topple_cloud c = known(&needed(cloud, "cloud"), {}, "cloud");
    CloudView view;
    take_columns<float>(c.count, c.stride_bytes, {c.x, c.y, c.z}, "x, y and z",
                        {&view.x, &view.y, &view.z});
    if (c.nx || c.ny || c.nz)
        take_columns<float>(c.count, c.normal_stride_bytes, {c.nx, c.ny, c.nz},
                            "nx, ny and nz, where one is given,", {&view.nx, &view.ny, &view.nz});
    if (c.red || c.green || c.blue)
        take_columns<std::uint8_t>(c.count, c.colour_stride_bytes, {c.red, c.green, c.blue},
                                   "red, green and blue, where one is given,",
                                   {&view.red, &view.green, &view.blue});
    if (c.viewpoint_x || c.viewpoint_y || c.viewpoint_z)
        take_columns<float>(c.count, c.viewpoint_stride_bytes,
                            {c.viewpoint_x, c.viewpoint_y, c.viewpoint_z},
                            "viewpoint_x, viewpoint_y and viewpoint_z, where one is given,",
                            {&view.viewpoint_x, &view.viewpoint_y, &view.viewpoint_z});
    array(c.x, "cloud: x", c.count);
    view.width = c.width;
    view.height = c.height;
    view.has_viewpoint = c.viewpoint != nullptr;
    if (c.viewpoint) view.viewpoint = {c.viewpoint[0], c.viewpoint[1], c.viewpoint[2]};
    if (c.name) view.source = c.name;
    return view;
}

}  // namespace topple::c_api

using namespace topple;
using namespace topple::c_api;

const char* topple_version(void) {
    return version;
}

uint32_t topple_version_number(void) {
    std::uint32_t major = 0, minor = 0, patch = 0;
    std::sscanf(version, "%u.%u.%u", &major, &minor, &patch);
    return (major * 100 + minor) * 100 + patch;
}

int topple_device_open(const char* backend, uint32_t threads, topple_device** device,
                       topple_status* status) {
    return opened(device, status,
                  [&] { return device::open_device(backend ? backend : "auto", threads); });
}

int topple_device_adopt_opencl(void* context, void* device_id, void* queue, topple_device** device,
                               topple_status* status) {
    return opened(device, status, [&] {
        return device::adopt_opencl({context, device_id, queue});
    });
}

int topple_device_adopt_vulkan(void* instance, void* physical_device, void* logical_device,
                               void* queue, uint32_t queue_family, topple_device** device,
                               topple_status* status) {
    return opened(device, status, [&] {
        return device::adopt_vulkan(
            {instance, physical_device, logical_device, queue, queue_family});
    });
}

const char* topple_device_backend(const topple_device* device) {
    return device ? device::to_string(device::describe(*device->device).backend) : "";
}

const char* topple_device_name(const topple_device* device) {
    return device ? device::describe(*device->device).name.c_str() : "";
}

void topple_device_release(topple_device* device) {
    delete device;
}

int topple_list_devices(topple_device_info* devices, uint64_t capacity, uint64_t* count,
                        topple_status* status) {
    return guarded(status, [&] {
        needed(count, "count") = 0;
        array(devices, "devices", capacity);
        const auto listings = device::list_devices();
        *count = listings.size();
        for (std::size_t n = 0; n < listings.size() && n < capacity; ++n) {
            const device::Listing& from = listings[n];
            topple_device_info to{};
            copy_text(device::to_string(from.backend), to.backend);
            copy_text(from.info.name, to.name);
            copy_text(from.info.driver, to.driver);
            copy_text(from.problem, to.problem);
            to.usable = from.usable;
            to.gpu = from.info.gpu;
            to.memory_bytes = from.info.limits.memory_bytes;
            devices[n] = to;
        }
    });
}

void topple_cloud_init(topple_cloud* cloud, size_t size) {
    begin(cloud, size);
}

// SPDX-License-Identifier: MIT
#include <algorithm>

#include "api/c_support.h"
#include "topple/embed.h"
#include "topple/option_names.h"
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
    const int code = code_of(error.kind());
    try {
        return set(status, code, in_words_of(Interface::c, error.what()));
    } catch (const std::bad_alloc&) {
        return set(status, code, error.what());
    }
}

int code_of(ErrorKind kind) noexcept {
    switch (kind) {
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
}

CloudView view_of(const topple_cloud* cloud) {
    topple_cloud defaults{};
    topple_cloud_init(&defaults, sizeof(defaults));
    const topple_cloud c = known(&needed(cloud, "cloud"), defaults, "cloud");
    const auto stride = [](std::int64_t bytes) {
        return static_cast<std::ptrdiff_t>(bytes ? bytes : std::int64_t{sizeof(float)});
    };
    // Columns keep no count without values: what is NULL here would be read later.
    const auto all = [&](const char* names, bool first, bool second, bool third) {
        if (c.count > 0 && !(first && second && third))
            throw Error(ErrorKind::usage, std::string("cloud: ") + names + " must not be NULL");
    };
    all("x, y and z", c.x, c.y, c.z);
    if (c.nx || c.ny || c.nz) all("nx, ny and nz, where one is given,", c.nx, c.ny, c.nz);
    if (c.red || c.green || c.blue)
        all("red, green and blue, where one is given,", c.red, c.green, c.blue);
    const bool viewpoints = c.viewpoint_x || c.viewpoint_y || c.viewpoint_z;
    if (viewpoints) {
        all("viewpoint_x, viewpoint_y and viewpoint_z, where one is given,", c.viewpoint_x,
            c.viewpoint_y, c.viewpoint_z);
    }
    array(c.x, "cloud: x", c.count);
    CloudView view;
    view.x = {c.x, c.count, stride(c.stride_bytes)};
    view.y = {c.y, c.count, stride(c.stride_bytes)};
    view.z = {c.z, c.count, stride(c.stride_bytes)};
    if (c.nx || c.ny || c.nz) {
        view.nx = {c.nx, c.count, stride(c.normal_stride_bytes)};
        view.ny = {c.ny, c.count, stride(c.normal_stride_bytes)};
        view.nz = {c.nz, c.count, stride(c.normal_stride_bytes)};
    }
    if (c.red || c.green || c.blue) {
        const auto step = static_cast<std::ptrdiff_t>(c.colour_stride_bytes ? c.colour_stride_bytes
                                                                            : std::int64_t{1});
        view.red = {c.red, c.count, step};
        view.green = {c.green, c.count, step};
        view.blue = {c.blue, c.count, step};
    }
    if (viewpoints) {
        view.viewpoint_x = {c.viewpoint_x, c.count, stride(c.viewpoint_stride_bytes)};
        view.viewpoint_y = {c.viewpoint_y, c.count, stride(c.viewpoint_stride_bytes)};
        view.viewpoint_z = {c.viewpoint_z, c.count, stride(c.viewpoint_stride_bytes)};
    }
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
    std::uint32_t number = 0, part = 0;
    for (const char* c = version; *c; ++c) {
        if (*c != '.') {
            part = part * 10 + static_cast<std::uint32_t>(*c - '0');
            continue;
        }
        number = number * 100 + part;
        part = 0;
    }
    return number * 100 + part;
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
    if (!cloud || size < sizeof(size_t)) return;
    std::memset(cloud, 0, size);
    cloud->size = size;
}

// SPDX-License-Identifier: MIT
#include <limits>
#include <vector>

#include "api/c_support.h"
#include "topple/stages.h"

struct topple_volume {
    topple::stages::Volume volume;
};

using namespace topple;
using namespace topple::c_api;

namespace {

template <class T>
stages::Array<T> array_of(const topple_array& from, const char* name) {
    if (from.buffer_bytes > 0) {
        array(static_cast<T*>(from.data), name, 1);
        return {{from.data, from.buffer_bytes, from.offset_bytes}, from.count};
    }
    return std::span<T>(array(static_cast<T*>(from.data), name, from.count), from.count);
}

stages::Coordinates coordinates(const topple_array* from, const char* name) {
    needed(from, name);
    return {array_of<const float>(from[0], name), array_of<const float>(from[1], name),
            array_of<const float>(from[2], name)};
}

device::Device& opened(topple_device* device) {
    if (!device)
        throw Error(ErrorKind::usage,
                    "device is NULL; topple_device_open(\"auto\", 0, ...) opens the best");
    return *device->device;
}

}  // namespace

int topple_point_spacing(const topple_cloud* cloud, double* spacing_m, topple_status* status) {
    return guarded(status,
                   [&] { needed(spacing_m, "spacing_m") = stages::point_spacing(view_of(cloud)); });
}

int topple_normals(topple_device* device, const topple_cloud* cloud, double cell_m,
                   const double* eye, float* nx, float* ny, float* nz, topple_status* status) {
    return guarded(status, [&] {
        const CloudView view = view_of(cloud);
        const Vec3 eye_m = eye ? Vec3{eye[0], eye[1], eye[2]} : Vec3{};
        const auto out = [&](float* to, const char* name) {
            return std::span<float>(array(to, name, view.size()), view.size());
        };
        stages::normals(opened(device), view, cell_m, eye ? &eye_m : nullptr, out(nx, "nx"),
                        out(ny, "ny"), out(nz, "nz"));
    });
}

int topple_support_functions(topple_device* device, const topple_array vertices[3],
                             const uint64_t* first, uint64_t sets, const topple_array directions[3],
                             const topple_array* out, topple_status* status) {
    return guarded(status, [&] {
        array(&needed(first, "first"), "first", sets);
        stages::support_functions(opened(device), coordinates(vertices, "vertices"),
                                  {first, sets + 1}, coordinates(directions, "directions"),
                                  array_of<float>(needed(out, "out"), "out"));
    });
}

int topple_barriers(topple_device* device, const double* points, const uint64_t* first,
                    uint64_t bodies, const double* mass_kg, const double* center_of_mass_m,
                    double resolution_m, double* barrier_J, double* release_J,
                    topple_status* status) {
    return guarded(status, [&] {
        array(&needed(first, "first"), "first", bodies);
        array(mass_kg, "mass_kg", bodies);
        array(center_of_mass_m, "center_of_mass_m", bodies, 3);
        array(barrier_J, "barrier_J", bodies);
        array(release_J, "release_J", bodies);
        if (first[0] != 0 || !std::is_sorted(first, first + bodies + 1))
            throw Error(ErrorKind::usage, "first must rise from 0");
        array(points, "points", first[bodies], 3);
        std::vector<std::vector<Vec3>> sets(bodies);
        std::vector<stages::StandingBody> standing(bodies);
        for (std::uint64_t n = 0; n < bodies; ++n) {
            for (std::uint64_t p = first[n]; p < first[n + 1]; ++p)
                sets[n].push_back({points[3 * p], points[3 * p + 1], points[3 * p + 2]});
            const double* center = center_of_mass_m + 3 * n;
            standing[n] = {sets[n], mass_kg[n], {center[0], center[1], center[2]}};
        }
        const auto found = stages::barriers(opened(device), standing, resolution_m);
        for (std::uint64_t n = 0; n < bodies; ++n) {
            barrier_J[n] = found[n].barrier_J;
            release_J[n] = found[n].release_J;
        }
    });
}

int topple_convolve(topple_device* device, uint32_t width, uint32_t height, uint32_t directions,
                    uint32_t margin, const topple_array* primary,
                    const topple_footprint_entry* footprint, const uint32_t* first,
                    const topple_array* density, topple_status* status) {
    return guarded(status, [&] {
        needed(first, "first");
        const std::uint32_t entries = first[directions];
        array(footprint, "footprint", entries);
        std::vector<stages::FootprintEntry> copied;
        for (std::uint32_t e = 0; e < entries; ++e)
            copied.push_back({footprint[e].dx, footprint[e].dy, footprint[e].weight});
        stages::convolve(opened(device), {width, height, directions, margin},
                         array_of<const float>(needed(primary, "primary"), "primary"), copied,
                         {first, std::size_t{directions} + 1},
                         array_of<float>(needed(density, "density"), "density"));
    });
}

int topple_volume_create(const topple_cloud* cloud, const int32_t* label, double voxel_m,
                         topple_volume** volume, topple_status* status) {
    return guarded(status, [&] {
        needed(volume, "volume") = nullptr;
        const CloudView view = view_of(cloud);
        *volume =
            new topple_volume{{view, {array(label, "label", view.size()), view.size()}, voxel_m}};
    });
}

int topple_volume_carve(topple_volume* volume, topple_device* device,
                        const topple_intrinsics* intrinsics, const uint16_t* depth,
                        const double* camera_to_world, uint64_t frames, topple_status* status) {
    return guarded(status, [&] {
        const topple_intrinsics& from = needed(intrinsics, "intrinsics");
        const std::uint64_t pixels = std::uint64_t{from.width} * from.height;
        array(depth, "depth", frames, std::max(pixels, std::uint64_t{1}));
        array(camera_to_world, "camera_to_world", frames, 16);
        std::vector<stages::DepthView> views(frames);
        for (std::uint64_t f = 0; f < frames; ++f) {
            views[f].depth = {depth + f * pixels, pixels};
            std::copy_n(camera_to_world + f * 16, 16, views[f].camera_to_world.begin());
        }
        needed(volume, "volume")
            .volume.carve(
                opened(device),
                {from.width, from.height, from.fx, from.fy, from.cx, from.cy, from.depth_scale},
                views);
    });
}

int topple_volume_fill(topple_volume* volume, topple_device* device, uint32_t votes,
                       const int32_t* hollow, uint64_t hollow_count, uint64_t* filled,
                       topple_status* status) {
    return guarded(status, [&] {
        const std::uint64_t count =
            needed(volume, "volume")
                .volume.fill(opened(device), votes,
                             {array(hollow, "hollow", hollow_count), hollow_count});
        if (filled) *filled = count;
    });
}

int topple_volume_state(const topple_volume* volume, int32_t i, int32_t j, int32_t k) {
    return volume ? volume->volume.state_at(i, j, k) : 2;
}

void topple_volume_release(topple_volume* volume) {
    delete volume;
}

// SPDX-License-Identifier: MIT
#include "topple/stages.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "arrays.h"
#include "busy.h"

namespace topple::python {
namespace {

// Two threads that carve, or one that carves while another asks, would race.
struct SharedVolume {
    SharedVolume(const CloudView& cloud, std::span<const std::int32_t> label, double voxel_m)
        : volume(cloud, label, voxel_m) {}
    stages::Volume volume;
    std::mutex in_use;
};
using Volume = std::shared_ptr<SharedVolume>;
using Device = std::shared_ptr<SharedDevice>;

std::unique_lock<std::mutex> alone(const Volume& volume) {
    std::unique_lock lock(volume->in_use, std::try_to_lock);
    if (!lock)
        throw Error(ErrorKind::usage,
                    "the volume is in use by another thread; each needs one of its own");
    return lock;
}

stages::Coordinates coordinates(const std::vector<py::array>& from, const char* name) {
    return {row<const float>(from.at(0), name), row<const float>(from.at(1), name),
            row<const float>(from.at(2), name)};
}

using PyBody = std::tuple<py::array, double, Vec3>;

py::list barriers(const std::vector<PyBody>& given, double resolution_m, const Device& device) {
    std::vector<stages::StandingBody> bodies;
    for (const auto& [points, mass_kg, center_of_mass_m] : given) {
        const std::span<const double> values = row<const double>(points, "points");
        bodies.push_back({{reinterpret_cast<const Vec3*>(values.data()), values.size() / 3},
                          mass_kg,
                          center_of_mass_m});
    }
    std::vector<stages::Barrier> found =
        unlocked([&] { return stages::barriers(*device->here(), bodies, resolution_m); });
    py::list out;
    for (const stages::Barrier& b : found) {
        std::vector<double> curve;
        for (const InstabilityStep& step : b.curve) {
            curve.push_back(step.W_J);
            curve.push_back(step.S_J);
        }
        out.append(py::make_tuple(b.barrier_J, b.release_J, b.direction, owned(std::move(curve))));
    }
    return out;
}

void bind_volume(py::module_& module) {
    py::class_<SharedVolume, Volume>(module, "Volume")
        .def(py::init([](const std::vector<py::array>& points, const py::array& label,
                         double voxel_m) {
            const CloudView view = view_of(points, {}, {}, {});
            const auto labels = row<const std::int32_t>(label, "label");
            return unlocked([&] { return std::make_shared<SharedVolume>(view, labels, voxel_m); });
        }))
        // depth: images in a row, each of width * height readings; poses: 16 numbers for each.
        .def("carve",
             [](const Volume& self, const std::vector<py::array>& depth, const py::array& poses,
                std::uint32_t width, std::uint32_t height, const std::array<double, 5>& camera,
                const Device& device) {
                 const auto pose = row<const double>(poses, "camera_to_world");
                 std::vector<stages::DepthView> frames(depth.size());
                 for (std::size_t n = 0; n < frames.size(); ++n) {
                     frames[n].depth = row<const std::uint16_t>(depth[n], "depth");
                     std::ranges::copy(pose.subspan(16 * n, 16), frames[n].camera_to_world.begin());
                 }
                 const auto volume = alone(self);
                 unlocked([&] {
                     self->volume.carve(*device->here(), intrinsics(width, height, camera), frames);
                 });
             })
        .def("fill",
             [](const Volume& self, unsigned votes, const std::vector<std::int32_t>& hollow,
                const Device& device) {
                 const auto volume = alone(self);
                 return unlocked([&] { return self->volume.fill(*device->here(), votes, hollow); });
             })
        .def("state_at",
             [](const Volume& self, const py::array& i, const py::array& j, const py::array& k) {
                 const auto x = row<const std::int32_t>(i, "i"),
                            y = row<const std::int32_t>(j, "j"),
                            z = row<const std::int32_t>(k, "k");
                 std::vector<std::uint8_t> state(x.size());
                 const auto volume = alone(self);
                 unlocked([&] {
                     for (std::size_t n = 0; n < state.size(); ++n)
                         state[n] =
                             static_cast<std::uint8_t>(self->volume.state_at(x[n], y[n], z[n]));
                 });
                 return owned(std::move(state));
             })
        .def("solid", [](const Volume& self) {
            const auto volume = alone(self);
            stages::Voxels v = unlocked([&] { return self->volume.solid(); });
            return py::make_tuple(owned(std::move(v.i)), owned(std::move(v.j)),
                                  owned(std::move(v.k)), owned(std::move(v.label)),
                                  owned(std::move(v.state)));
        });
}

}  // namespace

void bind_stages(py::module_& parent) {
    py::module_ module = parent.def_submodule("stages");
    module.def("point_spacing", [](const std::vector<py::array>& points) {
        const CloudView view = view_of(points, {}, {}, {});
        return unlocked([&] { return stages::point_spacing(view); });
    });
    module.def("normals", [](const std::vector<py::array>& points, double cell_m,
                             const std::optional<Vec3>& eye_m,
                             const std::vector<py::array>& viewpoints, const Device& device,
                             const std::vector<py::array>& out) {
        CloudView view = view_of(points, {}, {}, {});
        see_from(viewpoints, view);
        const auto nx = row<float>(out.at(0), "out"), ny = row<float>(out.at(1), "out"),
                   nz = row<float>(out.at(2), "out");
        unlocked([&] {
            stages::normals(*device->here(), view, cell_m, eye_m ? &*eye_m : nullptr, nx, ny, nz);
        });
    });
    module.def(
        "support_functions",
        [](const std::vector<py::array>& vertices, const py::array& first,
           const std::vector<py::array>& directions, const Device& device, const py::array& out) {
            const stages::Coordinates v = coordinates(vertices, "vertices"),
                                      d = coordinates(directions, "directions");
            const auto starts = row<const std::uint64_t>(first, "first");
            const stages::Array<float> values(row<float>(out, "out"));
            unlocked([&] { stages::support_functions(*device->here(), v, starts, d, values); });
        });
    module.def("barriers", barriers);
    module.def("label_spots", [](const std::vector<py::array>& cells, const py::array& label,
                                 const py::array& state) {
        const auto copied = [](const auto& values) {
            return std::vector(values.begin(), values.end());
        };
        const stages::Voxels solid{copied(row<const std::int32_t>(cells.at(0), "i")),
                                   copied(row<const std::int32_t>(cells.at(1), "j")),
                                   copied(row<const std::int32_t>(cells.at(2), "k")),
                                   copied(row<const std::int32_t>(label, "label")),
                                   copied(row<const std::uint8_t>(state, "state"))};
        return owned(unlocked([&] { return stages::label_spots(solid); }));
    });
    module.def("convolve", [](const py::array& primary, const std::array<std::uint32_t, 3>& shape,
                              const std::vector<py::array>& footprint, const py::array& first,
                              const Device& device, const py::array& density) {
        const stages::Array<const float> from(row<const float>(primary, "primary"));
        const stages::Array<float> to(row<float>(density, "out"));
        const auto dx = row<const std::int32_t>(footprint.at(0), "footprint dx"),
                   dy = row<const std::int32_t>(footprint.at(1), "footprint dy");
        const auto weight = row<const float>(footprint.at(2), "footprint weight");
        const auto starts = row<const std::uint32_t>(first, "first");
        const auto [directions, height, width] = shape;
        std::vector<stages::FootprintEntry> entries;
        for (std::size_t n = 0; n < weight.size(); ++n)
            entries.push_back({dx[n], dy[n], weight[n]});
        const stages::MapShape map{width, height, directions, 0};
        unlocked([&] { stages::convolve(*device->here(), map, from, entries, starts, to); });
    });
    bind_volume(module);
}

}  // namespace topple::python

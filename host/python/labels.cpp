// SPDX-License-Identifier: MIT
#include "arrays.h"
#include "busy.h"
#include "topple/frame_labels.h"

namespace topple::python {
namespace {

// Height, width, and the ids of parts and objects, a row after the other.
py::tuple label_tuple(FrameLabels&& found) {
    return py::make_tuple(found.height, found.width, owned(std::move(found.primitive)),
                          owned(std::move(found.object)));
}

}  // namespace

void bind_labels(py::module_& module) {
    py::class_<FrameLabeller>(module, "Labeller")
        .def(py::init([](Parsed& parsed, const std::vector<py::array>& points) {
            const std::optional<CloudView> view = caller_points(points, {});
            return unlocked([&] {
                const LentCoordinates lent(view, parsed);
                return FrameLabeller(parsed.result);
            });
        }))
        // Of the columns that a pickle holds: coordinates, and the part and object of each point.
        .def(py::init([](const std::vector<py::array>& points, const py::array& part,
                         const py::array& object, double voxel_m) {
            ParseResult result = labelled_points(points, object, "frame labels");
            const auto parts = row<const std::int32_t>(part, "point_primitive");
            ScenePoints& to = result.scene.points;
            to.primitive.assign(parts.begin(), parts.end());
            if (to.object.size() != to.primitive.size())
                throw Error(ErrorKind::usage, "frame labels: the columns differ in length");
            result.scene.voxel_size_m = voxel_m;
            return unlocked([&] { return FrameLabeller(result); });
        }))
        .def("of_file",
             [](const FrameLabeller& self, const std::string& folder, std::size_t number) {
                 return label_tuple(
                     unlocked([&] { return self.label(std::filesystem::path(folder), number); }));
             })
        .def("of_array", [](const FrameLabeller& self, const PyFrame& frame,
                            const std::array<std::uint32_t, 2>& size, const py::array& pose,
                            const std::array<double, 5>& camera, const std::string& name) {
            const FramesView view = frames_view({frame}, size, pose, camera, name);
            return label_tuple(unlocked([&] { return self.label(view, 0); }));
        });
}

}  // namespace topple::python

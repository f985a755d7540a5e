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
            const Busy busy;
            const py::gil_scoped_release release;
            const LentCoordinates lent(view, parsed);
            return FrameLabeller(parsed.result);
        }))
        // Of the columns that a pickle holds: coordinates, and the part and object of each point.
        .def(py::init([](const std::vector<py::array>& points, const py::array& part,
                         const py::array& object, double voxel_m) {
            const auto copied = [](auto& to, const auto& from) {
                to.assign(from.begin(), from.end());
            };
            ParseResult result;
            result.scene.voxel_size_m = voxel_m;
            ScenePoints& to = result.scene.points;
            copied(to.x, row<const float>(points.at(0), "x"));
            copied(to.y, row<const float>(points.at(1), "y"));
            copied(to.z, row<const float>(points.at(2), "z"));
            copied(to.primitive, row<const std::int32_t>(part, "point_primitive"));
            copied(to.object, row<const std::int32_t>(object, "point_object"));
            if (to.y.size() != to.x.size() || to.z.size() != to.x.size() ||
                to.object.size() != to.primitive.size())
                throw Error(ErrorKind::usage, "frame labels: the columns differ in length");
            const Busy busy;
            const py::gil_scoped_release release;
            return FrameLabeller(result);
        }))
        .def("of_file",
             [](const FrameLabeller& self, const std::string& folder, std::size_t number) {
                 FrameLabels found;
                 {
                     const Busy busy;
                     const py::gil_scoped_release release;
                     found = self.label(std::filesystem::path(folder), number);
                 }
                 return label_tuple(std::move(found));
             })
        .def("of_array", [](const FrameLabeller& self, const PyFrame& frame,
                            const std::array<std::uint32_t, 2>& size, const py::array& pose,
                            const std::array<double, 5>& camera, const std::string& name) {
            const FramesView view = frames_view({frame}, size, pose, camera, name);
            FrameLabels found;
            {
                const Busy busy;
                const py::gil_scoped_release release;
                found = self.label(view, 0);
            }
            return label_tuple(std::move(found));
        });
}

}  // namespace topple::python

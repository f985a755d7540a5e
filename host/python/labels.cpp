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

// SPDX-License-Identifier: MIT
#include "arrays.h"
#include "topple/object_at.h"
#include "topple/stays.h"

// What a result is asked about a place.
namespace topple::python {

void bind_places(py::module_& module) {
    module.def("why_moves", [](const Parsed& parsed, std::size_t object, const Vec3& place_m,
                               const std::optional<Vec3>& way, double force_N, double impulse_Ns,
                               double slack_m) {
        const Scene& scene = parsed.result.scene;
        return why_moves(scene, scene.objects.at(object),
                         {place_m, way.value_or(Vec3{}), force_N, impulse_Ns, slack_m});
    });
    module.def("stays_up_to_N", [](const Parsed& parsed, std::size_t object, const Vec3& place_m,
                                   const std::optional<Vec3>& way) {
        const Scene& scene = parsed.result.scene;
        return stays_up_to_N(scene, scene.objects.at(object), place_m, way.value_or(Vec3{}));
    });
    // Of the columns that a pickle holds, too: coordinates, and the object of each point.
    module.def("object_at", [](const std::vector<py::array>& points, const py::array& object,
                               const Vec3& place_m, double within_m) {
        return object_at(labelled_points(points, object, "object_at"), place_m, within_m);
    });
}

}  // namespace topple::python

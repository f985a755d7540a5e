// SPDX-License-Identifier: MIT
#include "topple/ask.h"

#include "python.h"

// What holds what in a result, and what falls without it. Tuples, which topple/_ask.py names.
namespace topple::python {

void bind_ask(py::module_& module) {
    module.def("falls_without", [](const Parsed& parsed, const std::vector<std::int32_t>& taken) {
        const FallsWithout found = falls_without(parsed.result.scene, taken);
        py::list falls;
        for (const Unheld& one : found.falls)
            falls.append(py::make_tuple(one.object, one.lost, one.left, one.beyond_m,
                                        one.probability, one.reason));
        return py::make_tuple(falls, found.unsure);
    });
    module.def("removal_steps", [](const Parsed& parsed, std::optional<std::int32_t> before) {
        const Scene& scene = parsed.result.scene;
        return before ? removal_steps(scene, *before) : removal_steps(scene);
    });
    module.def("held_by", [](const Parsed& parsed, std::int32_t object) {
        py::list out;
        for (const Holder& one : held_by(parsed.result.scene, object))
            out.append(py::make_tuple(one.object, one.building, one.area_m2, one.probability,
                                      one.from_below));
        return out;
    });
}

}  // namespace topple::python

// SPDX-License-Identifier: MIT
#include "topple/compare.h"

#include "python.h"
#include "stopped.h"

// Two parses of one room. Tuples, which topple/_compare.py names.
namespace topple::python {

void bind_compare(py::module_& module) {
    module.def("compare", [](const std::string& a, const std::string& b) {
        CompareOptions options;
        options.cancelled = Stopped();
        const Comparison found = stoppable([&] { return compare(a, b, options); });
        const Alignment& laid = found.alignment;
        py::list things;
        for (const ComparedThing& one : found.things)
            things.append(py::make_tuple(to_string(one.became), one.a, one.b, one.moved_m, one.free,
                                         one.solid, one.less_safe, one.safer,
                                         one.stands_otherwise));
        return py::make_tuple(py::make_tuple(laid.a_from_b, laid.same_frame, laid.seen,
                                             laid.agreeing, laid.next_agreeing, laid.error_m),
                              things);
    });
}

}  // namespace topple::python

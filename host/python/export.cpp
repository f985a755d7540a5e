// SPDX-License-Identifier: MIT
#include "topple/export.h"

#include <cmath>
#include <map>

#include "arrays.h"
#include "busy.h"

namespace topple::python {
namespace {

py::tuple body_tuple(const ExportedBody& b) {
    const auto share = [&](double value) {
        return b.solid_m3 > 0 ? py::object(py::float_(value)) : py::none();
    };
    return py::make_tuple(b.name, b.object, b.fixed, b.on_pad, b.held, b.struts, b.moved_m, b.parts,
                          b.mass_kg, b.solid_m3, b.parts_m3, b.lost_m3,
                          share(b.parts_m3 / b.solid_m3 - 1), share(b.lost_share()));
}

py::tuple front_tuple(const ExportedFront& f) {
    return py::make_tuple(f.name, f.object, f.opens, f.probability, f.middle_m, f.wide_m, f.high_m,
                          f.handle_m, f.mass_kg, f.axis, f.at_m, f.most);
}

}  // namespace

void bind_export(py::module_& module) {
    // paths: by format. points, colours: those of a result without, as of "write". The bodies come
    // in the order of ExportedBody's fields.
    module.def("export_scene", [](Parsed& parsed, const std::map<std::string, std::string>& paths,
                                  bool visuals, bool joints, unsigned threads,
                                  const std::vector<py::array>& points,
                                  const std::vector<py::array>& colours) {
        static const std::map<std::string, std::filesystem::path ExportOptions::*> formats{
            {"mjcf", &ExportOptions::mjcf},
            {"urdf", &ExportOptions::urdf},
            {"sdf", &ExportOptions::sdf},
            {"usd", &ExportOptions::usd}};
        ExportOptions options;
        for (const auto& [format, path] : paths) options.*formats.at(format) = path;
        options.visuals = visuals;
        options.joints = joints;
        options.threads = threads;
        options.cancelled = Busy::must_stop;
        const std::optional<CloudView> view = caller_points(points, colours);
        const ExportSummary summary = unlocked([&] {
            const LentCoordinates lent(view, parsed);
            return export_scene(parsed.result, options);
        });
        py::list bodies;
        for (const ExportedBody& body : summary.bodies) bodies.append(body_tuple(body));
        py::list fronts;
        for (const ExportedFront& front : summary.fronts) fronts.append(front_tuple(front));
        // None, not NaN: it equals itself, and `if` tells it.
        const bool floor = !std::isnan(summary.floor_m),
                   place = floor && !std::isnan(summary.free_place_m[0]);
        return py::make_tuple(bodies, summary.deepest_overlap_m,
                              floor ? py::object(py::float_(summary.floor_m)) : py::none(),
                              place ? py::cast(summary.free_place_m) : py::none(),
                              summary.free_radius_m, summary.notes, fronts);
    });
}

}  // namespace topple::python

// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>
#include <system_error>

#include "export/export_folder.h"
#include "export/formats.h"
#include "export/named_bodies.h"
#include "export/separate.h"
#include "export/sim_scene.h"
#include "export/summary.h"
#include "io/output_folder.h"
#include "io/replace_file.h"
#include "io/text.h"
#include "points/formats/frame_sequence.h"
#include "result/check_scene.h"
#include "result/read_result_ply.h"
#include "result/scene_json.h"
#include "result/solids_file.h"
#include "topple/export.h"

namespace topple {
namespace {

void stop_where_cancelled(const ExportOptions& options) {
    if (options.cancelled && options.cancelled()) throw Error(ErrorKind::cancelled, "cancelled");
}

ExportSummary summary_of(const exports::SimScene& scene) {
    ExportSummary out;
    for (std::size_t n = 0; n < scene.bodies.size(); ++n) {
        const exports::Body& from = scene.bodies[n];
        ExportedBody to;
        to.name = exports::body_name(from, n);
        to.object = from.object;
        to.fixed = from.fixed;
        to.on_pad = from.on_pad;
        to.held = from.held;
        to.struts = static_cast<std::uint64_t>(from.struts);
        to.moved_m = from.moved_m;
        to.parts = from.parts.size();
        to.mass_kg = from.mass_kg;
        to.solid_m3 = from.solid_m3;
        for (const exports::ConvexPart& part : from.parts) to.parts_m3 += part.volume_m3;
        to.lost_m3 = from.lost_m3;
        out.bodies.push_back(std::move(to));
    }
    for (const exports::JointedFront& from : scene.fronts) {
        ExportedFront to;
        to.name = from.name;
        to.object = scene.bodies[from.body].object;
        to.opens = exports::to_string(from.opening);
        to.probability = from.probability;
        to.middle_m = from.middle;
        to.wide_m = from.wide_m;
        to.high_m = from.high_m;
        to.handle_m = from.grip;
        to.mass_kg = from.mass_kg;
        to.axis = from.axis;
        to.at_m = from.at_m;
        to.most = from.most;
        out.fronts.push_back(std::move(to));
    }
    out.deepest_overlap_m = exports::deepest_overlap_m(scene.bodies);
    if (scene.floor_m) out.floor_m = *scene.floor_m;
    if (scene.free_place) {
        out.free_place_m = scene.free_place->at;
        out.free_radius_m = scene.free_place->radius_m;
    }
    out.notes = exports::notes_of(out);
    return out;
}

// The folder that an export writes into.
std::filesystem::path folder_of(const exports::Format& format, const std::filesystem::path& path) {
    return format.file ? path : path.has_parent_path() ? path.parent_path() : ".";
}

// Throws where an export would lie among the files of the scan that was parsed.
void check_apart_from(const std::string& source, const ExportOptions& options) {
    for (const exports::Format& format : exports::formats()) {
        const std::filesystem::path& path = options.*format.path;
        std::error_code error;
        if (!path.empty() && std::filesystem::equivalent(folder_of(format, path), source, error))
            io::fail(folder_of(format, path),
                     "is the scan that was parsed; choose another folder for the export");
    }
}

ExportSummary write_formats(const Scene& scene, const SolidScene& solids,
                            const ExportOptions& options) {
    check_apart_from(scene.source, options);
    const exports::SimScene made =
        exports::sim_scene(scene, solids, options.visuals, options.joints, options.threads);
    stop_where_cancelled(options);
    const ExportSummary summary = summary_of(made);
    const std::string bodies = exports::bodies_json(summary);
    stop_where_cancelled(options);
    for (const exports::Format& format : exports::formats()) {
        const std::filesystem::path& path = options.*format.path;
        if (path.empty()) continue;
        format.write(path, made);
        io::replace_file(exports::bodies_file(format, path), bodies);
    }
    return summary;
}

}  // namespace

void check_export(const ExportOptions& options) {
    bool any = false;
    std::string known;
    for (const exports::Format& format : exports::formats()) {
        if (!known.empty()) known += ", ";
        known.append(format.name).append(" (--").append(format.name).append(")");
        const std::filesystem::path& path = options.*format.path;
        if (path.empty()) continue;
        any = true;
        if (io::looks_like_sequence(folder_of(format, path)))
            io::fail(folder_of(format, path),
                     "holds a scan's depth frames; choose another folder for the export");
        exports::check_ours(exports::scene_file(format, path));
        if (format.file) exports::check_folder_ours(path / exports::name_beside(format.name));
        io::check_own_file(exports::bodies_file(format, path), exports::bodies_schema);
    }
    if (!any) throw Error(ErrorKind::usage, "export: say what to write, and where to: " + known);
}

ExportSummary export_scene(const ParseResult& result, const ExportOptions& options) {
    check_export(options);
    if (!result.solids)
        throw Error(
            ErrorKind::input,
            result.scene.source +
                ": was parsed in blocks, of which no solids are kept: it can't be exported");
    return write_formats(result.scene, *result.solids, options);
}

ExportSummary export_output(const std::filesystem::path& output, const ExportOptions& options) {
    check_export(options);
    io::check_output(output);
    const auto named = [&](const char* name) { return io::FileName::in(output, name); };
    const io::FileName solids = named("solids.bin"), points = named("points.ply");
    Scene scene = io::read_scene_json(named("scene.json"));
    io::check_bodies(scene, output / "scene.json");
    if (!solids.is_there())
        io::fail(solids.path(),
                 "is missing; parse the scan again (a cloud that was parsed in blocks has none and "
                 "can't be exported)");
    // Only for colours, and for what tells doors and drawers.
    if ((options.visuals || options.joints) && points.is_there())
        scene.points = io::read_points_ply(points);
    return write_formats(scene, *io::read_solids(solids), options);
}

}  // namespace topple

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "device/device.h"
#include "io/frame_sequence.h"
#include "io/octomap.h"
#include "io/text.h"
#include "pipeline/assemble.h"
#include "pipeline/cancelling.h"
#include "pipeline/geometry_stage.h"
#include "pipeline/ingest.h"
#include "pipeline/object_stage.h"
#include "pipeline/parse_memory.h"
#include "pipeline/safety_stage.h"
#include "pipeline/scale_checks.h"
#include "pipeline/stage_clock.h"
#include "pipeline/surface_extent.h"
#include "pipeline/tiled_parse.h"
#include "pipeline/voxel_size.h"
#include "pipeline/voxel_stage.h"
#include "safety/disturbances.h"
#include "topple/parse.h"
#include "vdb/read_volume.h"

namespace topple {
namespace {

// The finest voxel: below the noise of every sensor of rooms, and far above what overflows.
constexpr double least_voxel_m = 0.001;

std::string number_text(double value) {
    char digits[32];
    std::snprintf(digits, sizeof(digits), "%g", value);
    return digits;
}

void check_range(const char* option, double value, double lowest, double highest) {
    if (value > 0 && value >= lowest && value <= highest) return;  // false for NaN
    throw Error(ErrorKind::usage,
                std::string(option) + " " + number_text(value) + ": expected a number " +
                    (lowest > 0 ? "from " + number_text(lowest) + " to " : "above 0 and at most ") +
                    number_text(highest));
}

void check_memory(const CloudView& cloud, const std::string& source, double voxel_m,
                  const ParseOptions& options) {
    if (options.max_memory_bytes == 0) return;
    const SurfaceExtent surface = extent_of(cloud);
    const std::uint64_t need = one_piece_bytes(static_cast<double>(cloud.size()), surface.area_m2(),
                                               surface.bounds(), voxel_m);
    if (need > options.max_memory_bytes) {
        throw Error(ErrorKind::input,
                    std::to_string(cloud.size()) + " points at voxels of " +
                        io::short_number(voxel_m) + " m may need " + io::bytes_text(need) +
                        ", more than the " + io::bytes_text(options.max_memory_bytes) +
                        " of --max-memory; use a larger --voxel" +
                        (io::looks_like_sequence(source) || io::looks_like_octomap(source) ||
                                 vdb::looks_like_volume(source)
                             ? ""
                             : ", or --tile 5 to have it parsed in blocks"));
    }
}

ParseResult parse_ingested(device::Device& device, Ingested input, const ParseOptions& options,
                           Scene scene, StageClock& stage) {
    const double voxel_m = voxel_for_input(input, options);
    check_memory(input.cloud, scene.source, voxel_m, options);
    record_run(device, options, voxel_m, scene);
    scene.offset_m = input.own.offset_m;
    scene.notes.insert(scene.notes.end(), input.notes.begin(), input.notes.end());
    const double extent = extent_m({input.cloud.x, input.cloud.y, input.cloud.z});
    note_small_extent(extent, scene);

    const GeometryStage geometry = find_primitives(device, input, options, stage);  // 2.1
    if (!geometry.frame.note.empty()) scene.notes.push_back(geometry.frame.note);
    VoxelStage voxels = make_solids(device, input, geometry, voxel_m, stage);  // 2.2
    if (voxels.solids->primitives() == 0) {
        const std::string scale = io::looks_like_sequence(scene.source) && input.frames
                                      ? depth_scale_hint(*input.frames)
                                      : small_extent_hint(extent, scene.source);
        throw Error(ErrorKind::input,
                    scene.source + ": " + io::counted(input.cloud.size(), "point") +
                        (input.cloud.size() == 1 ? " was" : " were") +
                        " found, but no surface of them fills the " + std::to_string(least_voxels) +
                        " voxels that a solid takes; give a denser scan, or a smaller --voxel" +
                        (scale.empty() ? "" : "; " + scale));
    }
    SolidParts parts = solid_parts(geometry, voxels);
    const ObjectStage objects = find_objects(device, options, stage, parts);  // 3, 4
    take_over(parts.solids, voxels);
    const SafetyStage safety = assess_safety(device, parts, objects, options, stage);  // 5
    stage("assembly", [&] {
        assemble_objects(parts, objects, safety, scene);
        assemble_points(input, geometry, voxels, parts, objects, safety, scene);
        if (options.coordinates) take_coordinates(input, scene.points);
    });
    return {std::move(scene), std::move(voxels.scene), nullptr, std::move(parts.solids)};
}

template <class Ingest>
ParseResult run(const std::string& source, const ParseOptions& options, Ingest ingest_input) {
    check_options(options);
    const auto device = options.device ? options.device : device::open_device("auto");
    // The clock writes into a list of its own: the scene moves while stages are still running.
    std::vector<std::pair<std::string, double>> timings;
    StageClock stage(timings, options);
    const Cancelling cancelling(*device, options);
    Ingested input = stage("ingest", [&] { return ingest_input(*device); });
    Scene scene;
    scene.source = source;
    ParseResult result =
        parse_ingested(*device, std::move(input), options, std::move(scene), stage);
    result.scene.timings_s = std::move(timings);
    return result;
}

}  // namespace

void check_options(const ParseOptions& o) {
    if (o.voxel_m != 0) check_range("--voxel", o.voxel_m, least_voxel_m, 1.0);
    check_range("--unit", o.unit_m, 1e-6, 1e6);
    if (o.up)
        check_range("--up: its length,", std::hypot((*o.up)[0], (*o.up)[1], (*o.up)[2]), 1e-6, 1e6);
    check_range("--density", o.density_kg_m3, 0, 30000);
    if (o.contents_kg_m3 && *o.contents_kg_m3 != 0)
        check_range("--contents", *o.contents_kg_m3, 0, 30000);
    check_range("--friction", o.friction, 0, 10);
    check_range("--walks", o.walks, 1, 1e6);
    check_range("--wind", o.wind_m_s, 0, 150);
    // 0 is north, so the range is none of those that begin above 0.
    if (o.wind_from_deg && !(std::abs(*o.wind_from_deg) <= 360))
        throw Error(ErrorKind::usage,
                    "--wind-from " + number_text(*o.wind_from_deg) +
                        ": expected degrees clockwise from the scene's north, from -360 to 360");
    if (o.pga_m_s2) check_range("--pga", *o.pga_m_s2, 0, 50);
    if (o.accelerogram) {
        check_range("accelerogram: step_s", o.accelerogram->step_s, 1e-5, 0.5);
        double sum = 0;  // not finite if one of them isn't
        for (const auto* component :
             {&o.accelerogram->m_s2, &o.accelerogram->across_m_s2, &o.accelerogram->up_m_s2}) {
            if (!component->empty() && component->size() != o.accelerogram->m_s2.size())
                throw Error(ErrorKind::usage,
                            "accelerogram: its components have different numbers of samples");
            for (const double a : *component) sum += std::abs(a);
        }
        check_range("accelerogram: its peak in m/s^2,",
                    std::isfinite(sum) ? o.accelerogram->peak_m_s2() : NAN, 0, 100);
    }
    check_range("--floor-amplification", o.floor_amplification, 0, 20);
    if (o.hazard) {
        if (const auto wrong = o.hazard->fault())
            throw Error(ErrorKind::usage, "--hazard: " + *wrong);
    }
    check_range("--tolerable", o.tolerable_J, 0, 1e9);
    if (o.tile_m != 0) check_range("--tile", o.tile_m, least_tile_m, 1000);
    if (o.grouping_time_s) check_range("--grouping-time", *o.grouping_time_s, 0, 86400);
    for (const std::string& name : o.disturbances) safety::disturbance_kind(name);
}

std::vector<std::string> known_disturbances() {
    std::vector<std::string> names;
    for (const safety::DisturbanceKind* kind : safety::disturbance_kinds())
        names.emplace_back(kind->name);
    return names;
}

ParseResult parse(const std::filesystem::path& input, const ParseOptions& options) {
    if (std::optional<ParseResult> tiled = parse_tiled(input, options)) return *std::move(tiled);
    return run(input.string(), options,
               [&](device::Device& device) { return ingest(device, input, options); });
}

ParseResult parse(const CloudView& cloud, const ParseOptions& options) {
    return run(cloud.source.empty() ? "cloud" : cloud.source, options,
               [&](device::Device& device) { return ingest_view(device, cloud, options); });
}

void add_coordinates(const CloudView& cloud, ParseResult& result) {
    ScenePoints& points = result.scene.points;
    const std::size_t count = points.primitive.size();
    const bool fits = points.index.empty() ? cloud.size() == count
                                           : points.index.back() < cloud.size();  // ascending
    const auto whole = [&](const ByteColumn& channel) {
        return channel.size() == (cloud.red.empty() ? 0 : cloud.size());
    };
    if (!fits || cloud.y.size() != cloud.size() || cloud.z.size() != cloud.size() ||
        !whole(cloud.red) || !whole(cloud.green) || !whole(cloud.blue)) {
        throw Error(ErrorKind::usage, "add_coordinates: a cloud of " +
                                          std::to_string(cloud.size()) +
                                          " points is not what the result of " +
                                          std::to_string(count) + " came from");
    }
    const auto taken = [&]<class T>(const Column<T>& from) {
        if (points.index.empty() || from.empty()) return std::vector<T>(from.begin(), from.end());
        std::vector<T> out;
        out.reserve(count);
        for (const std::uint64_t i : points.index) out.push_back(from[i]);
        return out;
    };
    points.x = taken(cloud.x);
    points.y = taken(cloud.y);
    points.z = taken(cloud.z);
    points.red = taken(cloud.red);
    points.green = taken(cloud.green);
    points.blue = taken(cloud.blue);
}

}  // namespace topple

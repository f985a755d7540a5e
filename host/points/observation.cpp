// SPDX-License-Identifier: MIT
#include "points/observation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/solid_cells.h"
#include "core/vectors.h"
#include "device/cancelling.h"
#include "geometry/surfels.h"
#include "io/text.h"
#include "points/apart/read_scan.h"
#include "points/caller_points.h"
#include "points/cloud_views.h"
#include "points/formats/frame_sequence.h"
#include "points/formats/octomap.h"
#include "points/formats/read_cloud.h"
#include "points/given_attributes.h"
#include "points/scale_checks.h"
#include "points/single_scan.h"
#include "points/voxel_size.h"
#include "points/work_check.h"
#include "points/working_origin.h"
#include "vdb/read_volume.h"

namespace topple {

void note_single_frame(Observation& out) {
    out.notes.push_back("A single frame: what it does not show is completed by shape alone.");
}

void note_colours(bool given, Observation& out) {
    if (!given) out.notes.emplace_back(no_colours_note);
}

namespace {

Observation observation_of(PointCloud cloud, ScanOrigin origin) {
    Observation out;
    out.origin = origin;
    out.own = std::move(cloud);
    out.cloud = out.own;
    return out;
}

void check_count(const CloudView& cloud) {
    if (cloud.size() >= least_voxels) return;
    if (cloud.size() == 0) throw Error(ErrorKind::input, cloud.source + ": has no points");
    throw Error(ErrorKind::input, cloud.source + ": " + std::to_string(cloud.size()) +
                                      (cloud.size() == 1 ? " point was" : " points were") +
                                      " found, but the smallest solid takes " +
                                      std::to_string(least_voxels) + "; give a denser scan");
}

// What of normals and colours contradicts the points around is not used. Colours stay in the
// output.
void check_attributes(double around_m, Observation& out) {
    const geometry::GivenAttributes given = geometry::look_at_attributes(out.cloud, around_m);
    const auto percent = [](double share) {
        return std::to_string(std::lround(100 * share)) + " %";
    };
    if (given.normals_contradict()) {
        out.doubts.push_back(
            "The normals that were given contradict the points: " + percent(given.askew) +
            " are far off the direction of the surface, and of the others " +
            percent(given.opposed) +
            " face another side than those around them. They were left out, and the sides of "
            "surfaces estimated.");
        leave_out_normals(out);
    }
    if (out.cloud.red.empty() || given.colours_tell()) return;
    out.doubts.emplace_back(
        given.one_colour ? "All points have one colour, which tells nothing: it was left out."
                         : "The colours that were given differ between neighbouring points as much "
                           "as between any others: they were left out.");
    out.cloud.red = out.cloud.green = out.cloud.blue = {};
}

// On steps of 9 %: a sample of other points of the same surface mostly gives the same cells,
// which would else all shift against the surface, far from the origin by more than a cell.
geometry::PointSpacing steady(geometry::PointSpacing spacing) {
    constexpr double steps_per_octave = 8;
    for (double* m : {&spacing.nearest_m, &spacing.around_m, &spacing.surface_m})
        if (*m > 0) *m = std::exp2(std::round(std::log2(*m) * steps_per_octave) / steps_per_octave);
    return spacing;
}

// All that follows from the points.
void look_at_cloud(device::Device& device, const ParseOptions& options, Observation& out) {
    const CloudView& cloud = out.cloud;
    check_count(cloud);
    // The sensor is the origin of an organised cloud, and a map has voxels of its own.
    const bool placed = cloud.height > 1 || out.origin == ScanOrigin::map_file;
    const Vec3 planes = placed ? Vec3{} : densest_planes(cloud);
    if (!placed) reckon_from(planes, out);
    const geometry::PointSpacing spacing = steady(geometry::point_spacing(cloud));
    check_spacing(cloud, spacing.nearest_m, out.origin);
    // First, and at once: what is large takes long.
    const bool mesh = out.origin == ScanOrigin::mesh_file;
    const std::string hint = unit_hint(cloud, mesh ? INFINITY : spacing.nearest_m, out.origin);
    if (!hint.empty() && options.notice) options.notice(hint);
    // A little above the spacing, so that a surface has no holes at this resolution.
    constexpr double cell_pitches = 1.25;
    out.cell_m = std::clamp(cell_pitches * spacing.nearest_m, least_cell_m, largest_cell_m);
    out.sparse_cell_m = std::max(out.cell_m, cell_pitches * spacing.surface_m);
    out.surfels = geometry::surfels_for(spacing, surfel_cells * out.cell_m);
    if (!placed) reckon_from(origin_amid_voxels(planes, voxel_for_input(out, options)), out);
    out.doubts = cloud.notes;
    if (!hint.empty()) out.doubts.insert(out.doubts.begin(), hint);
    // A depth image's gaps are no news.
    if (cloud.dropped > 0 && cloud.height <= 1)
        out.notes.push_back(io::counted(cloud.dropped, "point") + " of " +
                            std::to_string(cloud.dropped + cloud.size()) +
                            (cloud.dropped == 1 ? " was" : " were") + " not finite and left out.");
    if (cloud.height <= 1) note_spacing(spacing.around_m, out.notes);
    check_attributes(spacing.around_m, out);
    Intrinsics intrinsics;
    DepthFrame frame;
    if (cloud.height > 1 && geometry::frame_of_organised_cloud(cloud, intrinsics, frame)) {
        const Mat4& pose = frame.camera_to_world;
        out.viewpoints = {Vec3{pose[3], pose[7], pose[11]}};
        out.camera_up = Vec3{-pose[1], -pose[5], -pose[9]};
        std::vector<DepthFrame> frames;
        frames.push_back(std::move(frame));
        out.frames = std::make_unique<MemoryStream>(intrinsics, std::move(frames));
        out.by_sensors = true;
        note_single_frame(out);
        return;
    }
    std::optional<geometry::SingleScan> scan;
    if (cloud.viewpoint_x.empty()) {
        scan = geometry::find_single_scan(
            cloud, cloud.has_viewpoint ? cloud.viewpoint : minus(out.own.origin_m, out.origin_m),
            spacing.nearest_m);
    }
    // Reading it took the rest of the stage.
    constexpr double read_share = 0.2;
    const auto tell = [&](double done) {
        if (options.progress) options.progress("ingest", read_share + (1 - read_share) * done);
    };
    if (Budget* budget = Budget::current()) check_surface(out, spacing.around_m, options, *budget);
    look_from_free_places(device, scan, spacing, tell, out);
}

}  // namespace

void leave_out_normals(Observation& input) {
    input.cloud.nx = input.cloud.ny = input.cloud.nz = {};
    input.own.nx = input.own.ny = input.own.nz = {};
}

void check_path(const std::filesystem::path& input) {
    if (input.empty())
        throw Error(ErrorKind::usage,
                    "the path of the input is empty; give that of a file, or of a folder of depth "
                    "frames");
}

Observation observe_cloud(device::Device& device, PointCloud cloud, const ParseOptions& options,
                          ScanOrigin origin) {
    Observation out = observation_of(std::move(cloud), origin);
    if (out.own.height > 1) {
        out.image_width = out.own.width;
        out.image_height = out.own.height;
        if (out.own.dropped > 0) out.index.assign(out.own.pixel.begin(), out.own.pixel.end());
    }
    look_at_cloud(device, options, out);
    return out;
}

Observation observe_view(device::Device& device, const CloudView& cloud,
                         const ParseOptions& options) {
    if (options.unit_m != 1) {
        throw Error(ErrorKind::usage,
                    "unit_m (--unit) is for files; scale a cloud in memory to metres before "
                    "it is parsed");
    }
    Observation out;
    out.origin = ScanOrigin::cloud_in_memory;
    out.cloud = cloud;
    if (out.cloud.source.empty()) out.cloud.source = "cloud";
    if (std::optional<FinitePoints> finite = finite_points(out.cloud)) {
        out.own = std::move(finite->cloud);
        out.index = std::move(finite->index);
        out.cloud = out.own;
    }
    check_viewpoint_distance(out.cloud);
    out.given_colours = {out.cloud.red, out.cloud.green, out.cloud.blue};
    look_at_cloud(device, options, out);
    note_colours(!out.given_colours[0].empty(), out);
    return out;
}

Observation ingest_part(device::Device& device, PointCloud cloud, double cell_m) {
    Observation out = observation_of(std::move(cloud), ScanOrigin::cloud_file);
    out.cell_m = cell_m;
    look_from_free_places(device, out);
    return out;
}

namespace {

// The map's own axes, of which up is the third, so that its voxels and the grid's are the same;
// none where up lies askew to them.
std::optional<geometry::SceneFrame> frame_of_map(const std::optional<Vec3>& given_up) {
    const Vec3 up = given_up.value_or(Vec3{0, 0, 1});
    for (std::size_t a = 0; a < 3; ++a) {
        if (std::abs(up[a]) < 1 - 1e-6) continue;
        geometry::SceneFrame frame{};
        const double sign = up[a] > 0 ? 1 : -1;
        frame.axes[0][(a + 1) % 3] = 1;
        frame.axes[1][(a + 2) % 3] = sign;
        frame.axes[2][a] = sign;
        frame.up_method = given_up ? "given" : "map";
        return frame;
    }
    return std::nullopt;
}

// A volume's surface, and its free space beside what virtual views of the surface find.
Observation ingest_volume(device::Device& device, ScannedMap map, const ParseOptions& options) {
    Observation out = observation_of(std::move(map.cloud), ScanOrigin::map_file);
    look_at_cloud(device, options, out);
    if (!map.space.free.empty()) out.space = std::move(map.space);
    return out;
}

// An OctoMap: what is free and what nobody saw is known, and its voxels are the grid's.
Observation ingest_octomap(ScannedMap map, const ParseOptions& options) {
    Observation out = observation_of(std::move(map.cloud), ScanOrigin::map_file);
    check_count(out.cloud);
    check_spacing(out.cloud, map.space.voxel_m);
    out.doubts = out.own.notes;
    out.voxel_m = map.space.voxel_m;
    // Surfels are the map's voxels: other cells would hold now one layer of them, now two.
    out.cell_m = out.voxel_m / surfel_cells;
    out.frame = frame_of_map(options.up);
    if (!out.frame || (options.voxel_m > 0 && options.voxel_m != out.voxel_m)) {
        out.notes.push_back(
            "The voxels are not the map's own, because another up or voxel size was asked for: "
            "its free space was taken at their centres.");
    }
    out.space = std::move(map.space);
    return out;
}

}  // namespace

ScannedMap read_input(const std::filesystem::path& file, const ParseOptions& options) {
    const auto poll = [&] { end_if_cancelled(options); };
    return options.isolate ? reader::read_scan_apart(file, options.unit_m, poll)
                           : reader::read_scan(file, options.unit_m, poll);
}

Observation observe(device::Device& device, const std::filesystem::path& input,
                    const ParseOptions& options) {
    if (options.progress) options.progress("ingest", 0);
    if (io::looks_like_sequence(input)) return observe_folder(device, input, options);
    ScannedMap map = read_input(input, options);
    if (io::looks_like_octomap(input)) return ingest_octomap(std::move(map), options);
    if (vdb::looks_like_volume(input)) return ingest_volume(device, std::move(map), options);
    const bool mesh = io::is_mesh(input);
    Observation out = observe_cloud(device, std::move(map.cloud), options,
                                    mesh ? ScanOrigin::mesh_file : ScanOrigin::cloud_file);
    if (!mesh) note_colours(!out.own.red.empty(), out);
    out.format_up = io::up_of_format(input);
    return out;
}

}  // namespace topple

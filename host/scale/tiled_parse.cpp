// SPDX-License-Identifier: MIT
#include "scale/tiled_parse.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/ranked.h"
#include "device/cancelling.h"
#include "device/stage_clock.h"
#include "geometry/surfels.h"
#include "io/text.h"
#include "objects/object_stage.h"
#include "points/budget.h"
#include "points/formats/read_cloud.h"
#include "points/observation.h"
#include "points/parse_memory.h"
#include "points/scale_checks.h"
#include "result/assemble.h"
#include "result/explanations.h"
#include "safety/safety_stage.h"
#include "scale/block_stage.h"
#include "scale/blocks.h"
#include "scale/callers_thread.h"
#include "scale/join_blocks.h"
#include "scale/point_spill.h"
#include "scale/shared_stage.h"
#include "scale/tiled_result.h"
#include "scale/tiled_stages.h"
#include "scale/work_files.h"
#include "scale/work_folder.h"
#include "solids/solid_parts.h"
#include "topple/kernels/device.h"

namespace topple {
namespace {

namespace fs = std::filesystem;

// Files below this size hold no more points than that: ten bytes a point are hardly ever too few.
constexpr std::uint64_t small_file = 10 * most_points_at_once;

// Points, and thinned points, that a guess at the whole is made from.
constexpr std::uint64_t spacing_points = 1'500'000, frame_points = 1'200'000;
// Points of the scene that a caller gets, and the report shows.
constexpr std::size_t sampled_points = 3'000'000;

std::string manifest(const fs::path& input, const ParseOptions& options) {
    std::error_code error;
    const auto changed = fs::last_write_time(input, error).time_since_epoch().count();
    return fs::absolute(input, error).string() + " " + std::to_string(fs::file_size(input, error)) +
           " " + std::to_string(changed) + options_text(options);
}

// An eighth of what a run may take: the device, and the portion in hand, take theirs, too.
std::uint64_t spill_bytes(const ParseOptions& options) {
    constexpr std::uint64_t most = std::uint64_t{256} << 20, least = std::uint64_t{16} << 20;
    return std::clamp(memory_bound(options) / 8, least, most);
}

// Sorts the cloud's points into bins on disk.
void spill(const fs::path& input, const tiles::WorkFolder& work, const ParseOptions& options,
           StageClock& stage) {
    if (work.has(tiles::bins_name)) return;
    tiles::PointSpill out(work.path(), spill_bytes(options));
    std::error_code error;
    // A guess, for the progress alone.
    const double expected = static_cast<double>(fs::file_size(input, error)) / 15;
    const PointCloud rest = io::stream_cloud(input, options.unit_m, [&](const PointCloud& portion) {
        out.add(portion, input.string());
        stage.progress("sorting", std::min(0.99, static_cast<double>(out.points()) / expected));
    });
    out.finish(rest.offset_m);
}

// What comes before the blocks. Where it fails the folder goes: another try would do no better, and
// who stops it then has lost little.
template <class Work>
auto or_remove(tiles::WorkFolder& folder, const Work& work) {
    try {
        return work();
    } catch (...) {
        folder.finished();
        throw;
    }
}

// The spacing of the points in a bin: of all, or of a slab of it that holds enough of them.
double spacing_in(const tiles::SpilledPoints& points, std::size_t bin) {
    const auto& of_bin = points.bins()[bin];
    const double share =
        std::min(1.0, static_cast<double>(spacing_points) / static_cast<double>(of_bin.points));
    const double end = (of_bin.bin[0] + share) * tiles::bin_edge_m;
    PointCloud cloud;
    points.read(bin, [&](std::span<const tiles::Point> portion, std::span<const Rgb8>) {
        for (const tiles::Point& p : portion) {
            if (p.x > end) continue;
            cloud.x.push_back(p.x);
            cloud.y.push_back(p.y);
            cloud.z.push_back(p.z);
        }
    });
    return geometry::point_spacing(cloud).nearest_m;
}

// The median over bins with many points.
double find_spacing(const tiles::SpilledPoints& points, const fs::path& input) {
    std::vector<std::size_t> bins(points.bins().size());
    for (std::size_t b = 0; b < bins.size(); ++b) bins[b] = b;
    std::ranges::stable_sort(bins, {}, [&](std::size_t b) { return points.bins()[b].points; });
    std::vector<double> spacings;
    for (const double quantile : {0.5, 0.6, 0.7, 0.8, 0.9}) {
        const double s = spacing_in(
            points, bins[static_cast<std::size_t>(quantile * static_cast<double>(bins.size()))]);
        if (s > 0) spacings.push_back(s);
    }
    const double spacing = spacings.empty() ? INFINITY : upper_median(spacings);
    if (spacing > sparsest_m)
        io::fail(input, "its points are " + io::short_number(spacing) + " m apart, more than the " +
                            io::short_number(sparsest_m) +
                            " m at which surfaces can be found; check unit_m (--unit), or "
                            "give a denser scan");
    return spacing;
}

// The frame of the whole, from the densest bin and those around it.
geometry::SceneFrame find_frame(device::Device& device, const fs::path& folder,
                                const tiles::SpilledPoints& points, double cell_m,
                                const ParseOptions& options) {
    const auto& bins = points.bins();
    const tiles::Bin middle =
        std::ranges::max_element(bins, {}, &tiles::SpilledPoints::BinPoints::points)->bin;
    std::vector<std::pair<std::int32_t, std::size_t>> near;  // distance, index
    for (std::size_t b = 0; b < bins.size(); ++b) {
        std::int32_t away = 0;
        for (std::size_t a = 0; a < 3; ++a)
            away = std::max(away, std::abs(bins[b].bin[a] - middle[a]));
        near.emplace_back(away, b);
    }
    std::ranges::sort(near);
    PointCloud cloud;
    for (const auto& [away, b] : near) {
        if (cloud.size() > 0 && cloud.size() + bins[b].points > frame_points && away > 1) break;
        const tiles::ThinnedBin bin = tiles::read_thinned(folder, bins[b].bin);
        if (cloud.size() > 0 && cloud.size() + bin.size() > frame_points) break;
        cloud.x.insert(cloud.x.end(), bin.x.begin(), bin.x.end());
        cloud.y.insert(cloud.y.end(), bin.y.begin(), bin.y.end());
        cloud.z.insert(cloud.z.end(), bin.z.begin(), bin.z.end());
    }
    const Observation part = ingest_part(device, std::move(cloud), cell_m);
    const geometry::Surfels surfels = geometry::make_surfels(
        device, part.cloud, 2 * cell_m, part.viewpoints, part.viewpoint_of_point);
    return geometry::find_scene_frame(device, surfels,
                                      {options.up, part.camera_up, part.sides_guessed});
}

// Where a layout is there some bin may be missing all the same, which was damaged.
bool all_thinned(const SharedWork& shared, const tiles::SpilledPoints& points) {
    const std::set<std::string> there = tiles::names_in(shared.folder);
    return std::ranges::all_of(points.bins(), [&](const auto& bin) {
        return there.contains(tiles::thinned_name(bin.bin));
    });
}

tiles::Layout find_layout(const SharedWork& shared, const tiles::SpilledPoints& points,
                          const fs::path& input, const ParseOptions& options, StageClock& stage) {
    if (tiles::names_in(shared.folder).contains(tiles::layout_name)) {
        tiles::Layout layout = tiles::read_layout(shared.folder);
        if (!all_thinned(shared, points))
            stage("thinning", [&] { thin_bins(shared, points, layout.cell_m, stage); });
        return layout;
    }
    const double cell_m = stage("spacing", [&] {
        const double finest = 1.25 * find_spacing(points, input);
        const double wanted = options.voxel_m > 0 ? options.voxel_m / voxel_cells : building_cell_m;
        return tiles::dividing_cell(std::min(largest_cell_m, std::max(finest, wanted)));
    });
    const double voxel_m = options.voxel_m > 0 ? options.voxel_m : voxel_cells * cell_m;
    stage("thinning", [&] { thin_bins(shared, points, cell_m, stage); });
    const geometry::SceneFrame frame = stage(
        "frame", [&] { return find_frame(shared.device, shared.folder, points, cell_m, options); });
    if (options.up && options.notice && !frame.note.empty()) options.notice(frame.note);
    return stage("layout", [&] {
        const std::vector<tiles::Bin> bins = bins_of(points);
        tiles::Layout layout = tiles::cut_into_blocks(shared.folder, bins, frame, cell_m, voxel_m);
        if (layout.blocks.empty())
            io::fail(input, io::counted(points.points(), "point") +
                                " were found, but nowhere enough of them for a surface; give a "
                                "denser scan, or a larger voxel_m (--voxel)");
        tiles::write_layout(shared.folder, layout);
        return layout;
    });
}

void add_notes(const tiles::SpilledPoints& points, const tiles::Layout& layout,
               const std::string& unit_note, Scene& scene) {
    if (!unit_note.empty()) scene.notes.push_back(unit_note);
    if (!layout.frame.note.empty()) scene.notes.push_back(layout.frame.note);
    PointCloud moved;
    moved.offset_m = scene.offset_m = points.offset_m();
    io::note_offset(moved);
    scene.notes.insert(scene.notes.end(), moved.notes.begin(), moved.notes.end());
    if (points.dropped() > 0)
        scene.notes.push_back(io::counted(points.dropped(), "point") + " of " +
                              std::to_string(points.dropped() + points.points()) +
                              (points.dropped() == 1 ? " was" : " were") +
                              " not finite and left out.");
    if (!points.coloured()) scene.notes.emplace_back(no_colours_note);
    scene.notes.push_back("The cloud of " + io::counted(points.points(), "point") +
                          " was parsed in " + io::counted(layout.blocks.size(), "block") +
                          ", thinned to one point per " +
                          io::short_number(std::round(layout.cell_m * 1e4) / 10) +
                          " mm; its sensor's places were not known, and free space was estimated.");
}

// Before the blocks, which take most of the time.
void check_memory_of(const tiles::Layout& layout, const fs::path& input,
                     const ParseOptions& options) {
    double all = 0;
    for (const tiles::Block& b : layout.blocks) all += static_cast<double>(b.cells);
    const double need = std::max(whole_bytes(all), block_bytes(tiles::largest_block(layout)));
    check_memory(io::path_text(input) + ": in blocks at voxels of " +
                     io::short_number(layout.voxel_m) + " m it would need about",
                 static_cast<std::uint64_t>(need), options, "use a larger voxel_m (--voxel)");
}

ParseResult parse_in_blocks(const fs::path& input, const ParseOptions& options,
                            std::unique_ptr<tiles::WorkFolder> work, const SharedWork& shared,
                            StageClock& stage) {
    device::Device& device = shared.device;
    const tiles::SpilledPoints points(work->path());
    const std::vector<tiles::Bin> bins = bins_of(points);
    const tiles::Layout layout = or_remove(*work, [&] {
        tiles::Layout found = find_layout(shared, points, input, options, stage);
        check_memory_of(found, input, options);
        return found;
    });
    stage("blocks", [&] { parse_blocks(shared, points, layout, options, stage); });
    JoinedBlocks joined =
        stage("joining", [&] { return join_blocks(work->path(), layout, stage); });
    SolidParts& parts = joined.parts;
    if (parts.model.empty())
        io::fail(input, "no surface in it fills the " + std::to_string(least_voxels) +
                            " voxels that a solid takes; give a denser scan, or a smaller "
                            "voxel_m (--voxel)");
    ParseResult result;
    Scene& scene = result.scene;
    scene.source = input.string();
    record_run(device, options, layout.voxel_m, scene);
    add_notes(points, layout, io::unit_note_of(input, options.unit_m), scene);
    const auto tiled = std::make_shared<TiledResult>(std::move(work), input, options.unit_m, bins,
                                                     layout, std::move(joined.number));
    parts.points = tiled->count_points(parts.model.size());
    const ObjectStage objects = find_objects(device, options, stage, parts);
    parts.samples = {};  // joints were judged by them, and by nothing else
    parts.seams = {};
    if (objects.taken) tiled->take_away(*objects.taken);
    SafetyStage safety = assess_safety(device, parts, objects, options, stage);
    stage("assembly", [&] {
        result.space_fields = take_space_fields(parts, safety);
        assemble_objects(parts, objects, safety, scene);
        scene.solid = vdb::solid_voxels({layout.voxel_m, layout.frame.axes}, parts.solids->cells(),
                                        objects.object_of_primitive);
        std::vector<TiledResult::Exposure> exposures;
        for (safety::Disturbance& d : safety.disturbances)
            if (!d.exposure.empty()) exposures.push_back({d.name, std::move(d.exposure)});
        tiled->set_scene(parts.solids, objects.object_of_primitive, std::move(exposures));
        scene.points = tiled->sample(sampled_points);
        note_small_extent(extent_m({scene.points.x, scene.points.y, scene.points.z}),
                          ScanOrigin::cloud_file, scene.notes);
    });
    result.tiled = tiled;
    return result;
}

}  // namespace

bool may_be_tiled(const fs::path& input, const ParseOptions& options) {
    std::error_code error;
    return fs::is_regular_file(input, error) && io::can_stream(input) &&
           (options.tile_m > 0 || fs::file_size(input, error) >= small_file);
}

std::string to_text(const WorkLeft& left) {
    if (left.blocks == 0) return "the points sorted on disk";
    return std::to_string(left.done) + " of " + io::counted(left.blocks, "block");
}

std::optional<WorkLeft> work_left(const fs::path& input, const ParseOptions& options) {
    const fs::path& folder = options.work_folder;
    if (folder.empty() || !may_be_tiled(input, options)) return std::nullopt;
    try {
        if (!tiles::is_work_folder(folder, manifest(input, options))) return std::nullopt;
        const std::set<std::string> there = tiles::names_in(folder);
        if (!there.contains(tiles::bins_name)) return std::nullopt;
        WorkLeft left;
        if (!there.contains(tiles::layout_name)) return left;
        left.blocks = tiles::read_layout(folder).blocks.size();
        for (std::size_t b = 0; b < left.blocks; ++b)
            left.done += there.contains(block_file({}, b).string());
        return left;
    } catch (const Error&) {  // the parse says what is wrong there
        return std::nullopt;
    }
}

namespace {

// What an earlier run has left, and what of it is made anew.
void tell_of_work(const fs::path& input, const tiles::WorkFolder& work,
                  const ParseOptions& options) {
    if (!options.notice || !work.taken_up()) return;
    const std::string folder = io::path_text(work.path());
    if (const auto left = work_left(input, options))
        options.notice("going on with " + to_text(*left) + " from " + folder);
    for (const std::string& name : work.damaged())
        options.notice(folder + ": " + name + " is damaged and is made anew");
}

}  // namespace

std::optional<ParseResult> parse_tiled(const fs::path& input, const ParseOptions& callers) {
    if (!may_be_tiled(input, callers)) return std::nullopt;
    const ParseOptions options = called_here(callers);
    std::vector<std::pair<std::string, double>> timings;
    StageClock stage(timings, options);
    const std::string about = manifest(input, options);
    auto work = std::make_unique<tiles::WorkFolder>(options.work_folder, about,
                                                    [&] { end_if_cancelled(options); });
    tell_of_work(input, *work, options);
    or_remove(*work, [&] { stage("sorting", [&] { spill(input, *work, options, stage); }); });
    if (options.tile_m == 0 && tiles::SpilledPoints(work->path()).points() <= most_points_at_once) {
        work->finished();
        return std::nullopt;
    }
    const auto device = options.device ? options.device : device::open_device("auto");
    const device::InUse in_use(*device);
    const Cancelling cancelling(*device, options);
    const auto crew = options.crew ? options.crew : std::shared_ptr<Crew>(lone_crew());
    std::error_code error;
    const fs::path folder = fs::absolute(work->path(), error);
    if (error) io::fail(work->path(), "has no absolute path: " + error.message());
    const SharedWork shared{*crew, *device, folder, about};
    ParseResult result = parse_in_blocks(input, options, std::move(work), shared, stage);
    result.scene.timings_s = std::move(timings);
    if (device->trace()) device->trace()->write();
    return result;
}

}  // namespace topple

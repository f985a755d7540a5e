// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "device/device.h"
#include "io/frame_sequence.h"
#include "io/scan_notes.h"
#include "io/text.h"
#include "pipeline/assemble.h"
#include "pipeline/budget.h"
#include "pipeline/cancelling.h"
#include "pipeline/groundwork.h"
#include "pipeline/groundwork_file.h"
#include "pipeline/ingest.h"
#include "pipeline/nothing_judged.h"
#include "pipeline/object_stage.h"
#include "pipeline/safety_stage.h"
#include "pipeline/stage_clock.h"
#include "pipeline/tiled_parse.h"
#include "pipeline/voxel_size.h"
#include "pipeline/voxel_stage.h"
#include "pipeline/whole_progress.h"
#include "safety/disturbances.h"
#include "topple/parse.h"

namespace topple {
namespace {

void check_range(const char* option, double value, double lowest, double highest) {
    if (value > 0 && value >= lowest && value <= highest) return;  // false for NaN
    throw Error(
        ErrorKind::usage,
        std::string(option) + " " + short_number(value) + ": expected a number " +
            (lowest > 0 ? "from " + short_number(lowest) + " to " : "above 0 and at most ") +
            short_number(highest));
}

// Objects and what may happen to them, from the groundwork on.
ParseResult build_on(device::Device& device, Groundwork ground, const ParseOptions& options,
                     Scene scene, StageClock& stage) {
    record_run(device, options, ground.voxel_m, scene);
    scene.offset_m = ground.offset_m;
    scene.notes = std::move(ground.notes);
    SolidParts& parts = ground.parts;
    std::shared_ptr<const SolidScene> solids = parts.solids;
    const ObjectStage objects =
        find_objects(device, options, stage, parts, std::move(ground.weighed));  // 3, 4
    if (objects.taken) {
        take_away(*objects.taken, *ground.voxels);
        solids = objects.taken->solids;
    }
    take_over(*solids, *parts.solids, *ground.voxels);
    const SafetyStage safety = assess_safety(device, parts, objects, options, stage);  // 5
    ParseResult result{{},           ground.voxels,      nullptr,
                       parts.solids, ground.image_width, ground.image_height};
    stage("assembly", [&] {
        assemble_objects(parts, objects, safety, scene);
        assemble_points(std::move(ground), objects, safety, scene);
    });
    result.scene = std::move(scene);
    return result;
}

using Timings = std::vector<std::pair<std::string, double>>;

// lay(device, stage): the groundwork. timings: of the stages before it.
template <class Lay>
ParseResult run(const std::string& source, const ParseOptions& options, Lay lay,
                Timings timings = {}) {
    const auto device = options.device ? options.device : device::open_device("auto");
    // The clock writes into a list of its own: the scene moves while stages are still running.
    StageClock stage(timings, options);
    const device::InUse in_use(*device);
    const Cancelling cancelling(*device, options);
    Groundwork ground = lay(*device, stage);
    Scene scene;
    scene.source = source;
    ParseResult result = build_on(*device, std::move(ground), options, std::move(scene), stage);
    result.scene.timings_s = std::move(timings);
    return result;
}

// Options that are about files, of a scan in memory.
void refuse_file_options(const ParseOptions& options) {
    if (!options.cache_file.empty())
        throw Error(ErrorKind::usage, "ParseOptions::cache_file " +
                                          io::path_text(options.cache_file) +
                                          ": a cache is kept of a file or folder, and the scan is "
                                          "in memory; leave it out, or parse its file");
    if (!options.work_folder.empty())
        throw Error(ErrorKind::usage,
                    "work_folder " + io::path_text(options.work_folder) +
                        ": only clouds in files are parsed in blocks, which are kept there, and "
                        "the scan is in memory; leave it out");
}

void refuse_tiles(const ParseOptions& options) {
    if (options.tile_m == 0) return;
    throw Error(ErrorKind::usage,
                "ParseOptions::tile_m " + short_number(options.tile_m) +
                    ": only clouds in files are parsed in blocks (.ply, .pcd, .las and .xyz); "
                    "leave it out");
}

bool keeps_groundwork(const ParseOptions& options) {
    return !options.cache_file.empty() && options.tile_m == 0;
}

// cache: where it was looked for already.
ParseResult parse_whole(const std::filesystem::path& input, const ParseOptions& options,
                        GroundworkFile cache, Timings timings) {
    const auto lay = [&](device::Device& device, StageClock& stage) {
        Ingested ingested = stage("ingest", [&] {
            Ingested read = ingest(device, input, options);
            // Of what can be read: what can't may be of any size.
            if (keeps_groundwork(options) && !cache.usable())
                cache = GroundworkFile(input, options);
            return read;
        });
        Groundwork ground =
            lay_groundwork(device, std::move(ingested), options, input.string(), stage);
        if (cache.usable()) stage("cache", [&] { cache.write(ground); });
        return ground;
    };
    return run(input.string(), options, lay, std::move(timings));
}

}  // namespace

void check_options(const ParseOptions& o) {
    if (o.voxel_m != 0)
        check_range("ParseOptions::voxel_m", o.voxel_m, least_voxel_m, largest_voxel_m);
    check_range("ParseOptions::unit_m", o.unit_m, 1e-6, 1e6);
    if (o.up)
        check_range("ParseOptions::up: its length,", std::hypot((*o.up)[0], (*o.up)[1], (*o.up)[2]),
                    1e-6, 1e6);
    check_range("ParseOptions::density_kg_m3", o.density_kg_m3, 0, 30000);
    if (o.contents_kg_m3 && *o.contents_kg_m3 != 0)
        check_range("ParseOptions::contents_kg_m3", *o.contents_kg_m3, 0, 30000);
    check_range("ParseOptions::friction", o.friction, 0, 10);
    check_range("ParseOptions::walks", o.walks, 1, 1e6);
    check_range("ParseOptions::wind_m_s", o.wind_m_s, 0, 150);
    // 0 is north, so the range is none of those that begin above 0.
    if (o.wind_from_deg && !(std::abs(*o.wind_from_deg) <= 360))
        throw Error(ErrorKind::usage,
                    "ParseOptions::wind_from_deg " + short_number(*o.wind_from_deg) +
                        ": expected degrees clockwise from the scene's north, from -360 to 360");
    if (o.pga_m_s2) check_range("ParseOptions::pga_m_s2", *o.pga_m_s2, 0, 50);
    if (o.accelerogram) {
        check_range("ParseOptions::accelerogram: step_s", o.accelerogram->step_s, 1e-5, 0.5);
        double sum = 0;  // not finite if one of them isn't
        for (const auto* component :
             {&o.accelerogram->m_s2, &o.accelerogram->across_m_s2, &o.accelerogram->up_m_s2}) {
            if (!component->empty() && component->size() != o.accelerogram->m_s2.size())
                throw Error(
                    ErrorKind::usage,
                    "ParseOptions::accelerogram: its components have different numbers of samples");
            for (const double a : *component) sum += std::abs(a);
        }
        check_range("ParseOptions::accelerogram: its peak in m/s^2,",
                    std::isfinite(sum) ? o.accelerogram->peak_m_s2() : NAN, 0, 100);
    }
    check_range("ParseOptions::floor_amplification", o.floor_amplification, 0, 20);
    if (o.hazard) {
        if (const auto wrong = o.hazard->fault())
            throw Error(ErrorKind::usage, "ParseOptions::hazard: " + *wrong);
    }
    check_range("ParseOptions::tolerable_J", o.tolerable_J, 0, 1e9);
    if (o.tile_m != 0) check_range("ParseOptions::tile_m", o.tile_m, least_tile_m, 1000);
    if (o.grouping_time_s)
        check_range("ParseOptions::grouping_time_s", *o.grouping_time_s, 0, 86400);
    if (const auto wrong = fault_of(o.corrections))
        throw Error(ErrorKind::usage, "ParseOptions::corrections: " + *wrong);
    for (auto name = o.disturbances.begin(); name != o.disturbances.end(); ++name) {
        safety::disturbance_kind(*name);
        if (std::find(o.disturbances.begin(), name, *name) != name)
            throw Error(ErrorKind::usage,
                        "ParseOptions::disturbances: " + *name + " is given twice; name each once");
    }
    for (std::size_t n = 0; n < o.motions.size(); ++n) {
        if (!o.motions[n])
            throw Error(ErrorKind::usage, "ParseOptions::motions: number " + std::to_string(n) +
                                              " is null; give what read_motion() returns, or leave "
                                              "it out");
    }
}

std::vector<std::string> known_disturbances() {
    std::vector<std::string> names;
    for (const safety::DisturbanceKind* kind : safety::disturbance_kinds())
        names.emplace_back(kind->name);
    return names;
}

namespace {

// Checks the options, and tells at once of one that was meant otherwise, perhaps.
void take_options(const ParseOptions& options) {
    check_options(options);
    const std::string note = light_density_note(options.density_kg_m3);
    if (!note.empty() && options.notice) options.notice(note);
}

// The result, whose notes begin with what the options make doubtful, and go on with `notes`; before
// them that nothing was judged, if so.
ParseResult noted(ParseResult result, const ParseOptions& options,
                  std::vector<std::string> notes = {}) {
    std::vector<std::string> all;
    for (const std::string& name : options.disturbances) {
        const auto doubt = safety::disturbance_kind(name).doubt;
        if (std::string asked = doubt ? doubt(options) : ""; !asked.empty())
            all.push_back(std::move(asked));
    }
    all.insert(all.end(), notes.begin(), notes.end());
    std::vector<std::string>& own = result.scene.notes;
    own.insert(own.begin(), all.begin(), all.end());
    note_nothing_judged(result.scene);
    return result;
}

ParseResult parse_scan(const std::filesystem::path& input, ParseOptions options) {
    GroundworkFile cache;
    Timings timings;
    if (keeps_groundwork(options) && !options.device) options.device = device::open_device("auto");
    std::error_code error;
    if (keeps_groundwork(options) && std::filesystem::exists(options.cache_file, error)) {
        std::optional<Groundwork> ground = StageClock(timings, options)("cache", [&] {
            cache = GroundworkFile(input, options);
            return cache.read();
        });
        if (ground)
            return run(
                input.string(), options,
                [&](device::Device&, StageClock&) { return *std::move(ground); },
                std::move(timings));
    }
    if (std::optional<ParseResult> tiled = parse_tiled(input, options)) return *std::move(tiled);
    if (std::filesystem::exists(input, error)) refuse_tiles(options);
    return parse_whole(input, options, std::move(cache), std::move(timings));
}

}  // namespace

ParseResult parse(const std::filesystem::path& input, const ParseOptions& options) {
    take_options(options);
    check_path(input);
    // First, as it is told early what can't be read.
    std::vector<std::string> notes = io::scan_notes(input);
    const auto kind =
        io::looks_like_sequence(input) ? WholeProgress::Input::frames : WholeProgress::Input::cloud;
    Budget budget(io::path_text(input), bytes_of_input(input), options);
    return noted(tell_whole(kind, budget.polled(),
                            [&](const ParseOptions& o) { return parse_scan(input, o); }),
                 options, std::move(notes));
}

ParseResult parse(const CloudView& cloud, const ParseOptions& options) {
    take_options(options);
    refuse_file_options(options);
    refuse_tiles(options);
    const std::string source = cloud.source.empty() ? "cloud" : cloud.source;
    const auto parse_view = [&](const ParseOptions& o) {
        return run(source, o, [&](device::Device& device, StageClock& stage) {
            Ingested input = stage("ingest", [&] { return ingest_view(device, cloud, o); });
            return lay_groundwork(device, std::move(input), o, source, stage);
        });
    };
    Budget budget(source, 3 * sizeof(float) * cloud.size(), options);
    return noted(tell_whole(WholeProgress::Input::cloud, budget.polled(), parse_view), options);
}

ParseResult parse(const FramesView& frames, const ParseOptions& options) {
    take_options(options);
    refuse_file_options(options);
    refuse_tiles(options);
    const std::string source = frames.source.empty() ? "frames" : frames.source;
    const auto parse_view = [&](const ParseOptions& o) {
        return run(source, o, [&](device::Device& device, StageClock& stage) {
            Ingested input = stage("ingest", [&] { return ingest_frames_view(device, frames, o); });
            return lay_groundwork(device, std::move(input), o, source, stage);
        });
    };
    const std::size_t count =
        std::max({frames.images.size(), frames.camera_to_world.size(), std::size_t{1}});
    const std::uint64_t pixels = io::saturating_multiply(
        std::uint64_t{frames.intrinsics.width} * frames.intrinsics.height, count);
    Budget budget(source, io::saturating_multiply(sizeof(std::uint16_t), pixels), options);
    return noted(tell_whole(WholeProgress::Input::frames, budget.polled(), parse_view), options);
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

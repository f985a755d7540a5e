// SPDX-License-Identifier: MIT
#include <algorithm>
#include <system_error>
#include <utility>

#include "device/cancelling.h"
#include "device/stage_clock.h"
#include "io/text.h"
#include "objects/found_parts.h"
#include "pipeline/stages.h"
#include "pipeline/whole_progress.h"
#include "points/budget.h"
#include "points/formats/frame_sequence.h"
#include "points/formats/scan_notes.h"
#include "points/observation.h"
#include "result/assemble.h"
#include "result/nothing_judged.h"
#include "safety/disturbances.h"
#include "scale/parts_cache.h"
#include "scale/tiled_parse.h"
#include "topple/kernels/device.h"
#include "topple/parse.h"

namespace topple {
namespace {

using Timings = std::vector<std::pair<std::string, double>>;

// find(device, stage): the parts. timings: of the stages before it.
template <class Find>
ParseResult run(const std::string& source, const ParseOptions& options, Find find,
                Timings timings = {}) {
    const auto device = options.device ? options.device : device::open_device("auto");
    StageClock stage(timings, options);
    const device::InUse in_use(*device);
    const Cancelling cancelling(*device, options);
    ParseResult result = judge_parts(*device, find(*device, stage), options, source, stage);
    result.scene.timings_s = std::move(timings);
    if (device->trace()) device->trace()->write();
    return result;
}

// Options that are about files, of a scan in memory.
void refuse_file_options(const ParseOptions& options) {
    if (!options.cache_file.empty())
        throw Error(ErrorKind::usage, "cache_file (--cache) " + io::path_text(options.cache_file) +
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
                "tile_m (--tile) " + short_number(options.tile_m) +
                    ": only clouds in files are parsed in blocks (.ply, .pcd, .las and .xyz); "
                    "leave it out");
}

bool keeps_parts(const ParseOptions& options) {
    return !options.cache_file.empty() && options.tile_m == 0;
}

// cache: where it was looked for already.
ParseResult parse_whole(const std::filesystem::path& input, const ParseOptions& options,
                        PartsCache cache, Timings timings) {
    const auto find = [&](device::Device& device, StageClock& stage) {
        Observation ingested = stage("ingest", [&] {
            Observation read = observe(device, input, options);
            // Of what can be read: what can't may be of any size.
            if (keeps_parts(options) && !cache.usable()) cache = PartsCache(input, options);
            return read;
        });
        FoundParts found = find_parts(device, std::move(ingested), options, input.string(), stage);
        if (cache.usable()) stage("cache", [&] { cache.write(found); });
        return found;
    };
    return run(input.string(), options, find, std::move(timings));
}

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
    for (const safety::DisturbanceKind* kind : safety::acting_kinds(options)) {
        if (std::string asked = kind->doubt ? kind->doubt(options) : ""; !asked.empty())
            all.push_back(std::move(asked));
    }
    all.insert(all.end(), notes.begin(), notes.end());
    std::vector<std::string>& own = result.scene.notes;
    own.insert(own.begin(), all.begin(), all.end());
    note_nothing_judged(result.scene);
    return result;
}

ParseResult parse_scan(const std::filesystem::path& input, ParseOptions options) {
    PartsCache cache;
    Timings timings;
    if (keeps_parts(options) && !options.device) options.device = device::open_device("auto");
    std::error_code error;
    if (keeps_parts(options) && std::filesystem::exists(options.cache_file, error)) {
        std::optional<FoundParts> found = StageClock(timings, options)("cache", [&] {
            cache = PartsCache(input, options);
            return cache.read();
        });
        if (found)
            return run(
                input.string(), options,
                [&](device::Device&, StageClock&) { return *std::move(found); },
                std::move(timings));
    }
    if (std::optional<ParseResult> tiled = parse_tiled(input, options)) return *std::move(tiled);
    if (std::filesystem::exists(input, error)) refuse_tiles(options);
    return parse_whole(input, options, std::move(cache), std::move(timings));
}

// A scan in memory. look(device, options): the Observation.
template <class Look>
ParseResult parse_view(std::string source, const std::string& otherwise, WholeProgress::Input kind,
                       std::uint64_t bytes, const ParseOptions& options, const Look& look) {
    take_options(options);
    refuse_file_options(options);
    refuse_tiles(options);
    if (source.empty()) source = otherwise;
    const auto whole = [&](const ParseOptions& o) {
        return run(source, o, [&](device::Device& device, StageClock& stage) {
            Observation input = stage("ingest", [&] { return look(device, o); });
            return find_parts(device, std::move(input), o, source, stage);
        });
    };
    Budget budget(source, bytes, options);
    return noted(tell_whole(kind, budget.polled(), whole), options);
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
    return parse_view(cloud.source, "cloud", WholeProgress::Input::cloud,
                      3 * sizeof(float) * cloud.size(), options,
                      [&](device::Device& device, const ParseOptions& o) {
                          return observe_view(device, cloud, o);
                      });
}

ParseResult parse(const FramesView& frames, const ParseOptions& options) {
    const std::size_t count =
        std::max({frames.images.size(), frames.camera_to_world.size(), std::size_t{1}});
    const std::uint64_t pixels = io::saturating_multiply(
        std::uint64_t{frames.intrinsics.width} * frames.intrinsics.height, count);
    return parse_view(frames.source, "frames", WholeProgress::Input::frames,
                      io::saturating_multiply(sizeof(std::uint16_t), pixels), options,
                      [&](device::Device& device, const ParseOptions& o) {
                          return observe_frames(device, frames, o);
                      });
}

}  // namespace topple

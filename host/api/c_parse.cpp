// SPDX-License-Identifier: MIT
#include <cstdint>

#include "api/c_result.h"
#include "api/c_support.h"
#include "core/number_options.h"
#include "export/formats.h"

namespace topple::c_api {
namespace {

// A bit for each name, in their order.
std::vector<std::string> of_bits(const std::string& what, std::uint32_t bits,
                                 const std::vector<std::string>& names, const std::string& last) {
    std::vector<std::string> out;
    std::uint32_t bit = 1;
    for (const std::string& name : names) {
        if (bits & bit) out.push_back(name);
        bit <<= 1;
    }
    if (bits >= bit)
        throw Error(ErrorKind::usage,
                    what + ": " + std::to_string(bits) + " has bits beyond " + last);
    return out;
}

}  // namespace

topple_options default_options() {
    const ParseOptions from;
    topple_options o{};
    o.size = sizeof(o);
    for (const NumberOption& option : number_options) option.to_c(from, o);
    o.disturbances = TOPPLE_HUMAN | TOPPLE_WIND | TOPPLE_EARTHQUAKE | TOPPLE_REACH;
    o.people = TOPPLE_ADULTS;
    o.walks = from.walks;
    o.seed = from.seed;
    return o;
}

ParseOptions parse_options(const topple_options& o) {
    ParseOptions to;
    if (o.device) to.device = o.device->device;
    for (const NumberOption& option : number_options) option.from_c(o, to);
    if (o.up[0] != 0 || o.up[1] != 0 || o.up[2] != 0) to.up = Vec3{o.up[0], o.up[1], o.up[2]};
    to.disturbances = of_bits("disturbances", o.disturbances, known_disturbances(),
                              "those of topple_disturbance_name()");
    to.people = of_bits("people", o.people, known_people(), "TOPPLE_WHEELCHAIR");
    to.walks = o.walks;
    to.seed = o.seed;
    to.max_memory_bytes = o.max_memory_bytes;
    if (o.hazard_points > 0) {
        if (!o.hazard_pga_g || !o.hazard_per_year)
            throw Error(ErrorKind::usage, "hazard_points: " + std::to_string(o.hazard_points) +
                                              ", but hazard_pga_g or hazard_per_year is NULL");
        array(o.hazard_pga_g, "hazard_pga_g", o.hazard_points);
        to.hazard = HazardCurve{{o.hazard_pga_g, o.hazard_pga_g + o.hazard_points},
                                {o.hazard_per_year, o.hazard_per_year + o.hazard_points},
                                "hazard_pga_g"};
    }
    if (o.corrections_file && o.corrections_json)
        throw Error(ErrorKind::usage, "corrections_file and corrections_json: give one of both");
    if (o.corrections_file) to.corrections = read_corrections(o.corrections_file);
    if (o.corrections_json) to.corrections = corrections_of(o.corrections_json, "corrections_json");
    if (o.materials) to.materials = std::make_shared<const Materials>(read_materials(o.materials));
    if (o.cache_file) to.cache_file = o.cache_file;
    to.coordinates = !o.without_coordinates;
    to.isolate = !o.without_isolation;
    to.space_fields = o.space_fields != 0;
    if (o.progress || o.log) {
        to.progress = [&o, last = std::string()](const std::string& stage, double done) mutable {
            if (o.progress) o.progress(stage.c_str(), done, o.user);
            if (o.log && stage != last) o.log(TOPPLE_LOG_INFO, stage.c_str(), o.user);
            last = stage;
        };
    }
    if (o.cancelled) to.cancelled = [&o] { return o.cancelled(o.user) != 0; };
    return to;
}

namespace {

template <class Parse>
int parsed(const topple_options* given_options, topple_result** result, topple_status* status,
           const Parse& parse_with) {
    return guarded(status, [&] {
        needed(result, "result") = nullptr;
        const topple_options o = known(given_options, default_options(), "options");
        ParseResult done = parse_with(parse_options(o));
        if (o.log)
            for (const std::string& note : done.scene.notes)
                o.log(TOPPLE_LOG_WARNING, note.c_str(), o.user);
        *result = new topple_result(std::move(done), o.allocator);
    });
}

}  // namespace

Arrays::Arrays(const topple_allocator* allocator) {
    if (!allocator) return;
    if (!allocator->allocate || !allocator->release)
        throw Error(ErrorKind::usage, "allocator: allocate and release must not be NULL");
    allocator_ = *allocator;
}

Arrays::~Arrays() {
    for (const Block& b : blocks_) allocator_->release(b.memory, b.bytes, allocator_->user);
}

const void* Arrays::copy(const void* from, std::size_t bytes, std::size_t alignment) {
    blocks_.reserve(blocks_.size() + 1);  // so that no block is lost
    void* memory = allocator_->allocate(bytes, alignment, allocator_->user);
    if (!memory) throw OutOfMemory{bytes};
    blocks_.push_back({memory, bytes});
    std::memcpy(memory, from, bytes);
    return memory;
}

}  // namespace topple::c_api

using namespace topple;
using namespace topple::c_api;

void topple_options_init(topple_options* options, size_t size) {
    begin(options, size, default_options());
}

int topple_parse(const char* path, const topple_options* options, topple_result** result,
                 topple_status* status) {
    return parsed(options, result, status, [&](const ParseOptions& o) {
        return parse(std::filesystem::path(&needed(path, "path")), o);
    });
}

int topple_parse_cloud(const topple_cloud* cloud, const topple_options* options,
                       topple_result** result, topple_status* status) {
    return parsed(options, result, status,
                  [&](const ParseOptions& o) { return parse(view_of(cloud), o); });
}

int topple_parse_frames(const topple_frames* frames, const topple_options* options,
                        topple_result** result, topple_status* status) {
    return parsed(options, result, status,
                  [&](const ParseOptions& o) { return parse(frames_of(frames), o); });
}

void topple_result_release(topple_result* result) {
    delete result;
}

int topple_result_write(const topple_result* result, const char* folder, uint32_t what,
                        topple_status* status) {
    return guarded(status, [&] {
        if (what & ~7u)
            throw Error(ErrorKind::usage, "what: " + std::to_string(what) + " has unknown bits");
        OutputOptions options;
        options.pictures = what & TOPPLE_WRITE_PICTURES;
        options.glb = what & TOPPLE_WRITE_GLB;
        options.octomap = what & TOPPLE_WRITE_OCTOMAP;
        write_outputs(needed(result, "result").result, &needed(folder, "folder"), options);
    });
}

int topple_result_add_coordinates(topple_result* result, const topple_cloud* cloud,
                                  topple_status* status) {
    return guarded(status,
                   [&] { add_coordinates(view_of(cloud), needed(result, "result").result); });
}

int topple_result_export(const topple_result* result, const char* format, const char* path,
                         topple_status* status) {
    return guarded(status, [&] {
        const ParseResult& from = needed(result, "result").result;
        ExportOptions options;
        exports::set_path(options, &needed(format, "format"), &needed(path, "path"));
        export_scene(from, options);
    });
}

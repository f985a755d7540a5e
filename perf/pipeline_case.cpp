// SPDX-License-Identifier: MIT
#include "perf/pipeline_case.h"

#include <bit>

#include "lab/rooms/furnished_room.h"
#include "lab/scan/depth_camera.h"
#include "lab/temporary_folder.h"
#include "topple/export.h"
#include "topple/parse.h"

namespace topple::perf {
namespace {

std::uint64_t hash_of(const Scene& scene) {
    Hash hash;
    hash.add(scene.points.primitive)
        .add(scene.points.object)
        .add(scene.solid.primitive)
        .add(scene.solid.object);
    for (const Object& object : scene.objects)
        hash.word(std::bit_cast<std::uint32_t>(static_cast<float>(object.barrier_J)));
    return hash.value();
}

// The room for MuJoCo, without surfaces.
Result measure_export(const device::Device& device, const ParseResult& parsed, unsigned runs) {
    const scenes::TemporaryFolder folder("topple-perf-export");
    ExportOptions options;
    options.mjcf = folder.path();
    options.visuals = false;
    Result result = named(device, "export", {0, "convex parts", 0, 0});
    for (unsigned run = 0; run < runs; ++run) {
        const Stopwatch watch;
        const ExportSummary made = export_scene(parsed, options);
        result.add(watch.elapsed());
        Hash hash;
        result.work.items = 0;
        for (const ExportedBody& body : made.bodies) {
            result.work.items += static_cast<double>(body.parts);
            hash.word(std::bit_cast<std::uint32_t>(static_cast<float>(body.parts_m3)));
        }
        result.hash = hash.value();
    }
    return result;
}

}  // namespace

std::vector<Result> measure_pipeline(const std::shared_ptr<device::Device>& device,
                                     const PipelineOptions& options, scenes::Score& score) {
    const scenes::World world = scenes::furnished_room({.seed = options.seed});
    scenes::CameraOptions camera;
    camera.frames = options.frames;
    camera.seed = options.seed;
    const scenes::TemporaryFolder folder("topple-perf");
    scenes::write_sequence(folder.path(), world, scenes::walk(world, camera));

    ParseOptions parse_options;
    parse_options.device = device;
    std::vector<Result> results;
    const auto result = [&](const std::string& name) -> Result& {
        for (Result& r : results) {
            if (r.name == name) return r;
        }
        return results.emplace_back(named(*device, name, {}));
    };
    for (unsigned run = 0; run < options.runs; ++run) {
        const device::Counters before = device->counters();
        const Stopwatch watch;
        const ParseResult parsed = parse(folder.path(), parse_options);
        const Span all = watch.elapsed();
        const device::Counters after = device->counters();
        Result& whole = result("pipeline");
        whole.add(all);
        whole.hash = hash_of(parsed.scene);
        if (run == 0) {
            whole.counters = after - before;
        }
        whole.work = {static_cast<double>(parsed.scene.points.x.size()), "points", 0, 0};
        for (const auto& [stage, seconds] : parsed.scene.timings_s) {
            Result& r = result("pipeline/" + stage);
            r.samples_s.push_back(seconds);
            r.work = {static_cast<double>(parsed.scene.points.x.size()), "points", 0, 0};
        }
        if (run + 1 < options.runs) continue;
        score = scenes::score(world, parsed.scene);
        results.push_back(measure_export(*device, parsed, options.runs));
    }
    return results;
}

}  // namespace topple::perf

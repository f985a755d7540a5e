// SPDX-License-Identifier: MIT
#include "perf/field_stages.h"

#include <utility>

#include "device/stage_clock.h"
#include "objects/object_stage.h"
#include "safety/safety_stage.h"
#include "solids/volume.h"

namespace topple::perf {
namespace {

struct Field {
    const char* name;
    double events;
    const char* of;
};
constexpr Field fields[]{
    {"human", 500, "walks"}, {"wind", 16, "gales"}, {"earthquake", 64, "events"}};

}  // namespace

std::vector<std::string> field_names() {
    std::vector<std::string> out;
    for (const Field& field : fields) out.push_back(std::string("fields/") + field.name);
    return out;
}

std::vector<Result> measure_fields(device::Device& device, const StageScene& scene, unsigned runs) {
    std::vector<std::pair<std::string, double>> timings;
    ParseOptions options;
    StageClock clock(timings, options);
    SpaceCarving carving(device, scene.ingested, {stage_voxel_m, scene.geometry.frame.axes});
    const Volume voxels = fill_volume(device, scene.ingested, scene.geometry, carving, clock);
    SolidParts parts = solid_parts(scene.geometry, voxels);
    const ObjectStage objects = find_objects(device, options, clock, parts);
    std::vector<Result> out;
    for (const Field& field : fields) {
        options.disturbances = {field.name};
        Result result =
            named(device, std::string("fields/") + field.name, {field.events, field.of, 0, 0});
        // Once more than is sampled, to build the kernels.
        for (unsigned n = 0; n <= runs; ++n) {
            timings.clear();
            const device::Counters before = device.counters();
            const SafetyStage safety = assess_safety(device, parts, objects, options, clock);
            if (n == 0) {
                result.hash = Hash().add(safety.disturbances.at(0).exposure).value();
                continue;
            }
            if (n == 1) result.counters = device.counters() - before;
            for (const auto& [stage, seconds] : timings) {
                if (stage == std::string("field ") + field.name)
                    result.samples_s.push_back(seconds);
            }
        }
        result.work.bytes = static_cast<double>(result.counters.bytes_bound);
        out.push_back(std::move(result));
    }
    return out;
}

}  // namespace topple::perf

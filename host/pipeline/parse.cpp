// SPDX-License-Identifier: MIT
// All stages of a parse, in order; each line's comment names its section of the paper. The inputs
// that they start from are in inputs.cpp.
#include <utility>

#include "pipeline/stages.h"
#include "points/scale_checks.h"
#include "points/voxel_size.h"
#include "points/work_check.h"
#include "result/assemble.h"
#include "result/labelled_points.h"
#include "safety/safety_stage.h"
#include "solids/find_solids.h"

namespace topple {

FoundParts find_parts(device::Device& device, Observation input, const ParseOptions& options,
                      const std::string& source, StageClock& stage) {
    FoundParts out;
    out.voxel_m = voxel_for_input(input, options);
    out.offset_m = input.own.offset_m;
    out.image_width = input.image_width;
    out.image_height = input.image_height;
    // What the input may mean else comes first: its unit, sides, colours, poses and up.
    out.notes = input.doubts;
    const double extent = extent_m({input.cloud.x, input.cloud.y, input.cloud.z});
    note_small_extent(extent, input.origin, out.notes);

    auto [surfaces, voxels] = with_unit_hint(extent, input.origin, [&] {
        check_memory_of(input, out.voxel_m, options);
        return find_solids(device, input, out.voxel_m, options, stage);  // 2
    });
    if (!surfaces.frame.note.empty()) out.notes.push_back(surfaces.frame.note);
    out.notes.insert(out.notes.end(), input.notes.begin(), input.notes.end());
    if (voxels.solids->primitives() == 0) fail_without_surface(input, source, extent);
    out.parts = solid_parts(surfaces, voxels);
    out.points = labelled_points(input, surfaces, voxels, options.coordinates);
    out.weighed = weigh_parts(device, out.parts, options, stage);  // 4.2
    take_likely(voxels);
    out.parts.solids = voxels.solids;
    out.voxels = std::move(voxels.scene);
    return out;
}

ParseResult judge_parts(device::Device& device, FoundParts found, const ParseOptions& options,
                        const std::string& source, StageClock& stage) {
    ParseResult result;
    Scene& scene = result.scene;
    scene.source = source;
    record_run(device, options, found.voxel_m, scene);
    scene.offset_m = found.offset_m;
    scene.notes = std::move(found.notes);
    SolidParts& parts = found.parts;
    std::shared_ptr<const SolidScene> solids = parts.solids;
    const ObjectStage objects =
        find_objects(device, options, stage, parts, std::move(found.weighed));  // 4.1, 3
    if (objects.taken) {
        take_away(*objects.taken, *found.voxels);
        solids = objects.taken->solids;
    }
    clear_lost_labels(*solids, *parts.solids, *found.voxels);
    SafetyStage safety = assess_safety(device, parts, objects, options, stage);  // 5
    result.voxels = found.voxels;
    result.solids = parts.solids;
    result.image_width = found.image_width;
    result.image_height = found.image_height;
    stage("assembly", [&] {
        result.space_fields = take_space_fields(parts, safety);
        assemble_objects(parts, objects, safety, scene);
        assemble_points(std::move(found), objects, safety, scene);
    });
    return result;
}

}  // namespace topple

// SPDX-License-Identifier: MIT
#include "lab/evaluation/ray_ends.h"

#include <algorithm>
#include <vector>

#include "lab/evaluation/kind_score.h"
#include "lab/evaluation/text.h"
#include "lab/solids/rigid.h"
#include "points/observation.h"
#include "points/voxel_size.h"
#include "solids/find_solids.h"
#include "vdb/completion.h"

namespace topple::evaluation {
namespace {

using Count = RayEndCounts::Count;

void add(const Count& more, Count& to) {
    to.solid += more.solid;
    to.of += more.of;
}

double share(const Count& count, double towards) {
    constexpr double weight = 50;  // voxels
    return (count.solid + weight * towards) / (count.of + weight);
}

std::string row_of(const RayEndCounts& counts, bool agree, unsigned above) {
    const auto at = [&](unsigned sides, unsigned below) -> const Count& {
        return counts.ends[vdb::ends_of(agree, above, sides, below)];
    };
    std::array<Count, vdb::most_sides + 1> of_sides{};
    Count of_above;
    for (unsigned sides = 0; sides <= vdb::most_sides; ++sides) {
        for (unsigned below = 0; below < vdb::ends_below; ++below)
            add(at(sides, below), of_sides[sides]);
        add(of_sides[sides], of_above);
    }
    const double mean = of_above.of > 0 ? of_above.solid / of_above.of : 0;
    std::string out;
    for (unsigned sides = 0; sides <= vdb::most_sides; ++sides) {
        const double towards = share(of_sides[sides], mean);
        append(out, "  ");
        for (unsigned below = 0; below < vdb::ends_below; ++below)
            append(out, "%2.0f,", 100 * share(at(sides, below), towards));
    }
    return out;
}

}  // namespace

void add_rays(const std::string& kind, const scenes::ScanOptions& scan_options,
              const ParseOptions& options, RayEndCounts& counts) {
    constexpr std::size_t most_voxels = 10'000;
    const ScannedKind room(kind, scan_options);
    std::vector<std::pair<std::string, double>> timings;
    StageClock stage(timings, options);
    device::Device& device = *options.device;
    const Observation input = observe(device, room.input(), options);
    const auto [geometry, voxels] =
        find_solids(device, input, voxel_for_input(input, options), options, stage);
    vdb::VoxelScene& volume = *voxels.scene;
    volume.clear_completed();
    const auto rays = vdb::six_direction_rays(
        device, volume, fill_options(voxels.solids->cells(), voxels.solids->roles()),
        [](const vdb::RayEnds&) { return true; });
    const Mat4 world_from_scan = scenes::inverse(room.scan.world_to_scan);
    const vdb::VoxelFrame& frame = volume.frame();
    const std::size_t step = std::max<std::size_t>(1, rays.size() / most_voxels);
    for (std::size_t n = 0; n < rays.size(); n += step) {
        Vec3 center;
        for (std::size_t a = 0; a < 3; ++a) center[a] = (rays[n].at[a] + 0.5) * frame.voxel_m;
        const auto [distance, part] =
            room.world.distance(scenes::moved(world_from_scan, frame.input_of(center)));
        const bool solid = distance <= 0;
        if (solid && room.world.parts[part].object == 0) continue;
        add({solid ? 1.0 : 0.0, 1}, counts.ends[rays[n].ends]);
    }
    ++counts.rooms;
}

std::string table_of(const RayEndCounts& counts) {
    Count all;
    for (const Count& count : counts.ends) add(count, all);
    std::string out;
    append(out, "Solid, percent, of %.0f voxels of %u rooms\n", all.of, counts.rooms);
    for (const bool agree : {false, true})
        for (unsigned above = 0; above < vdb::ends_above; ++above)
            append(out, "%s\n", row_of(counts, agree, above).c_str());
    return out;
}

}  // namespace topple::evaluation

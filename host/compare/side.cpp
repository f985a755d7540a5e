// SPDX-License-Identifier: MIT
#include "compare/side.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "core/rotation.h"
#include "io/text.h"
#include "points/apart/read_scan.h"
#include "topple/parse.h"

namespace topple::comparing {
namespace {

// Cells in which points are one.
constexpr double surface_cell_m = 0.05;

std::vector<SurfacePoint> surface_of(const Scene& scene) {
    const ScenePoints& p = scene.points;
    const Rotation turn = rotation_of(scene.manhattan_from_input);
    struct Sum {
        Vec3 place{}, normal{};
        double count = 0, building = 0;
    };
    std::map<std::array<std::int64_t, 3>, Sum> cells;
    for (std::size_t n = 0; n < p.x.size(); ++n) {
        const Vec3 at = transformed(scene.manhattan_from_input, {p.x[n], p.y[n], p.z[n]});
        std::array<std::int64_t, 3> cell{};
        for (std::size_t a = 0; a < 3; ++a)
            cell[a] = static_cast<std::int64_t>(std::floor(at[a] / surface_cell_m));
        Sum& sum = cells[cell];
        sum.place = plus(sum.place, at);
        ++sum.count;
        if (!p.nx.empty()) sum.normal = plus(sum.normal, turned(turn, {p.nx[n], p.ny[n], p.nz[n]}));
        if (p.object[n] >= 0)
            sum.building += scene.objects[static_cast<std::size_t>(p.object[n])].grounded;
    }
    std::vector<SurfacePoint> out;
    for (const auto& [cell, sum] : cells) {
        constexpr double least_points = 3;  // fewer are strays
        if (sum.count < least_points) continue;
        out.push_back({along({}, 1 / sum.count, sum.place), unit_or_zero(sum.normal),
                       2 * sum.building > sum.count});
    }
    return out;
}

}  // namespace

Side read_side(const std::filesystem::path& folder, const std::function<void()>& poll) {
    ParseResult result = read_outputs(folder);
    poll();
    const std::filesystem::path volume = folder / "volume.vdb";
    const ScannedMap seen = reader::read_volume_apart(volume, poll);
    if (seen.cloud.x.size() != result.scene.solid.x.size())
        io::fail(volume, "is of another scene: it has " +
                             io::counted(seen.cloud.x.size(), "solid voxel") +
                             ", but solid.ply has " + std::to_string(result.scene.solid.x.size()));
    SeenSpace space(result.scene, seen.space);
    std::vector<SurfacePoint> surface = surface_of(result.scene);
    return {std::move(result.scene), std::move(space), std::move(surface)};
}

}  // namespace topple::comparing

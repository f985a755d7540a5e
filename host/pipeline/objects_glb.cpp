// SPDX-License-Identifier: MIT
#include "pipeline/objects_glb.h"

#include <cmath>
#include <map>
#include <vector>

#include "io/palette.h"
#include "io/write_glb.h"
#include "report/drawing.h"

namespace topple {
namespace {

using Cell = std::array<std::int32_t, 3>;

std::map<std::int32_t, std::vector<Cell>> cells_of_objects(const Scene& scene,
                                                           const vdb::VoxelScene& voxels) {
    std::map<std::int32_t, std::vector<Cell>> out;
    const SolidCells cells = voxels.solid_cells();
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const std::int32_t p = cells.primitive[n];
        const bool known = p >= 0 && static_cast<std::size_t>(p) < scene.primitives.size();
        const std::int32_t object =
            known ? scene.primitives[static_cast<std::size_t>(p)].object : -1;
        out[object].push_back({cells.i[n], cells.j[n], cells.k[n]});
    }
    return out;
}

std::array<std::uint8_t, 3> colour_of(const Scene& scene, std::int32_t id) {
    const auto o = static_cast<std::size_t>(id);
    if (id < 0 || o >= scene.objects.size() || scene.objects[o].grounded) return io::colour_of(-1);
    const double unsafety = scene.objects[o].unsafety;
    return report::colour_along(report::unsafety_ramp,
                                std::isfinite(unsafety) ? (unsafety - 1) / 9 : 0);
}

}  // namespace

void write_objects_glb(const std::filesystem::path& file, const Scene& scene,
                       const vdb::VoxelScene& voxels) {
    const vdb::VoxelFrame& frame = voxels.frame();
    const auto& grid = frame.grid_from_input;
    std::vector<io::GlbNode> nodes;
    for (const auto& [id, cells] : cells_of_objects(scene, voxels)) {
        io::GlbNode node;
        node.name = id < 0 ? "unassigned" : "object " + std::to_string(id);
        node.colour = colour_of(scene, id);
        node.mesh = io::voxel_boundary(cells);
        for (Vec3& v : node.mesh.vertex) {
            Vec3 in_input{};
            for (std::size_t a = 0; a < 3; ++a) {
                for (std::size_t d = 0; d < 3; ++d)
                    in_input[d] += grid[a][d] * v[a] * frame.voxel_m;
            }
            v = in_input;
        }
        nodes.push_back(std::move(node));
    }
    const Vec3 &x = grid[0], &y = grid[1], &z = grid[2];
    io::write_glb(file, nodes, {x, z, Vec3{-y[0], -y[1], -y[2]}});
}

}  // namespace topple

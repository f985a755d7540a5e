// SPDX-License-Identifier: MIT
#include "export/objects_glb.h"

#include <cmath>
#include <vector>

#include "io/palette.h"
#include "report/drawing.h"
#include "result/write_glb.h"

namespace topple {
namespace {

Rgb8 colour_of(const Scene& scene, std::int32_t id) {
    const auto o = static_cast<std::size_t>(id);
    if (id < 0 || o >= scene.objects.size() || scene.objects[o].grounded) return io::colour_of(-1);
    const double unsafety = scene.objects[o].unsafety;
    return report::colour_along(report::unsafety_ramp,
                                std::isfinite(unsafety) ? (unsafety - 1) / 9 : 0);
}

}  // namespace

void write_objects_glb(const std::filesystem::path& file, const Scene& scene,
                       std::span<const ObjectSurface> surfaces, const vdb::VoxelFrame& frame) {
    std::vector<io::GlbNode> nodes;
    for (const ObjectSurface& surface : surfaces) {
        io::GlbNode node;
        const std::int32_t id = surface.object;
        node.name = id < 0 ? "unassigned" : "object " + std::to_string(id);
        node.colour = colour_of(scene, id);
        node.mesh = {surface.vertex, surface.normal, surface.triangle};
        for (const auto& colour : surface.colour)
            node.vertex_colour.push_back(colour.value_or(node.colour));
        nodes.push_back(std::move(node));
    }
    const auto& [x, y, z] = frame.grid_from_input;
    io::write_glb(file, nodes, {x, z, Vec3{-y[0], -y[1], -y[2]}});
}

}  // namespace topple

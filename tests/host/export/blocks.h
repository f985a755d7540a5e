// SPDX-License-Identifier: MIT
#pragma once

#include "core/solid_scene.h"
#include "export/body.h"
#include "export/convex_part.h"
#include "export/joints.h"
#include "standard.h"

// Boxes along the axes, as parts and as voxels.
namespace topple::exports::test {

inline ConvexPart block(const Vec3& low, const Vec3& high) {
    ConvexPart out = *hull_part(Extents<double>{low, high}.corners());
    // Solid throughout: points on a lattice.
    constexpr int count = 5;
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j)
            for (int k = 0; k < count; ++k)
                out.solid.push_back({low[0] + (high[0] - low[0]) * i / (count - 1.0),
                                     low[1] + (high[1] - low[1]) * j / (count - 1.0),
                                     low[2] + (high[2] - low[2]) * k / (count - 1.0)});
    out.solid_each_m3 = out.volume_m3 / static_cast<double>(out.solid.size());
    return out;
}

inline Body body_of(ConvexPart part, int level, std::vector<std::int32_t> carried_by) {
    Body out;
    out.fixed = level == 0;
    out.level = level;
    out.carried_by = std::move(carried_by);
    for (std::size_t a = 0; a < 3; ++a) out.center_m[a] = (part.low[a] + part.high[a]) / 2;
    out.mass_kg = 700 * part.volume_m3;
    for (std::size_t a = 0; a < 3; ++a) out.inertia_kg_m2[4 * a] = 0.1 * out.mass_kg;
    out.parts.push_back(std::move(part));
    return out;
}

// Cells [low, high) of primitive `primitive`, in voxels of a centimetre.
struct Cells {
    std::array<int, 3> low, high;
    std::int32_t primitive = 0;
};
inline SolidScene solids_of(const std::vector<Cells>& blocks, std::size_t primitives) {
    std::vector<std::array<std::int32_t, 4>> all;
    for (const Cells& b : blocks)
        for (int i = b.low[0]; i < b.high[0]; ++i)
            for (int j = b.low[1]; j < b.high[1]; ++j)
                for (int k = b.low[2]; k < b.high[2]; ++k) all.push_back({i, j, k, b.primitive});
    std::ranges::sort(all);
    SolidCells cells;
    cells.voxel_m = 0.01;
    for (const auto& [i, j, k, p] : all) {
        cells.i.push_back(i);
        cells.j.push_back(j);
        cells.k.push_back(k);
        cells.primitive.push_back(p);
        cells.basis.push_back(Basis::surface);
    }
    return {std::move(cells), std::vector<Role>(primitives, Role::none)};
}

inline std::vector<JointedFront> fronts_on_joints(std::vector<Body>& bodies,
                                                  const std::vector<std::vector<Front>>& of_object,
                                                  double density_kg_m3) {
    std::vector<JointedFront> out = place_fronts(bodies, of_object, density_kg_m3);
    joint_fronts(out, bodies);
    return out;
}

}  // namespace topple::exports::test

// SPDX-License-Identifier: MIT
#include "export/clumps.h"

#include <array>
#include <cmath>
#include <map>

namespace topple::exports {
namespace {

// Of a body's solid: what a part may hold beyond it.
constexpr double slight_of_object = 0.005, slight_of_ground = 0.001;
// Objects of fewer primitives keep each; and so do primitives of more voxels.
constexpr std::size_t many_primitives = 16;
constexpr double crumb_voxels = 64;
// Crumbs whose middles lie in one block of so many voxels become one.
constexpr double block_voxels = 6;

using Block = std::array<std::int64_t, 3>;

Block block_of(const Vec3& p, double edge_m) {
    Block out{};
    for (std::size_t a = 0; a < 3; ++a)
        out[a] = static_cast<std::int64_t>(std::floor(p[a] / edge_m));
    return out;
}

}  // namespace

std::vector<Clump> clumps_of(const Scene& scene, double voxel_m) {
    std::vector<Clump> out;
    const double voxel_m3 = voxel_m * voxel_m * voxel_m;
    for (const Object& object : scene.objects) {
        double solid_m3 = 0;
        for (const std::int32_t p : object.primitives)
            solid_m3 += scene.primitives.at(static_cast<std::size_t>(p)).volume_m3;
        const double slight_m3 = solid_m3 * (object.grounded ? slight_of_ground : slight_of_object);
        std::map<Block, std::size_t> clump_of;
        for (const std::int32_t p : object.primitives) {
            const Primitive& primitive = scene.primitives[p];
            const bool crumb = object.primitives.size() > many_primitives &&
                               primitive.volume_m3 < crumb_voxels * voxel_m3;
            if (crumb) {
                const auto [at, fresh] = clump_of.try_emplace(
                    block_of(primitive.center_of_mass_m, block_voxels * voxel_m), out.size());
                if (!fresh) {
                    out[at->second].primitives.push_back(p);
                    continue;
                }
            }
            out.push_back({object.id, {p}, slight_m3, object.grounded});
        }
    }
    return out;
}

}  // namespace topple::exports

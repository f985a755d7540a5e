// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "lab/scores/share.h"
#include "lab/solids/scene.h"
#include "topple/scene.h"

namespace topple::scenes {

// Solid voxels against all parts but the room's. A voxel is right within 0.87 voxels (half a
// diagonal) of a part; one in the room's own parts, up to 1.5 voxels off them, is not judged. A
// true voxel, a quarter inside of a part, is found where it or a face neighbour is solid.
struct VolumeScore {
    Share precision, recall;
};

// Whether a place in the room's frame is judged at all.
using Domain = std::function<bool(const Vec3&)>;

// Of each voxel.
enum class Verdict : std::uint8_t { not_judged, wrong, right };
std::vector<Verdict> verdicts(const World& truth, const SolidVoxels& solid, double voxel_m,
                              const Domain& domain = {});

// Voxel centres are in the input's frame; an empty domain judges everywhere. Uses all cores; the
// result does not depend on how many there are.
VolumeScore volume_score(const World& truth, const SolidVoxels& solid, double voxel_m,
                         const Domain& domain = {});

}  // namespace topple::scenes

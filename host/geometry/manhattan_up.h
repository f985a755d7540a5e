// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "geometry/manhattan.h"
#include "geometry/manhattan_normals.h"

namespace topple::geometry {

struct UpChoice {
    Vec3 up{0, 0, 1};
    std::string method;  // as SceneFrame::up_method
};

// Which of the scene's directions is up, and which way along it. A direction's evidence is the
// share of the surface that lies in large planes across it (floors, tables, shelves, ceilings); a
// camera's up weighs it by how near it is, and rules out what is too far off. Without a camera, the
// evidence is weighed by how flat the scene lies across the direction (rooms are wider than high,
// tables wider than what stands on them), and by convention: clouds without poses have z up more
// often than not.
UpChoice choose_up(const Surfels& surfels, const WeightedNormals& normals,
                   const std::vector<Vec3>& directions, const std::vector<Vec3>& manhattan,
                   const FrameHints& hints);

}  // namespace topple::geometry

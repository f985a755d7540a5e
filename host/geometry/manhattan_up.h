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
    std::string note;    // as SceneFrame::note
};

// Which of the scene's directions is up, and which way along it. A direction's evidence is the
// share of the surface that lies in large planes across it (floors, tables, shelves, ceilings).
//
// A camera's up weighs it by how near it is, for cameras are held level but for their pitch; planes
// that face up count more than those that face down, which keeps walls, seen by a camera that looks
// down a little, from passing for floors. Where there is no such plane, upright surfaces (Gupta,
// Arbelaez, Malik 2013) turn the camera's up.
//
// Without a camera, a direction's odds are those of how the scene lies along it (rooms are wider
// than high, what stands is turned about up alone, tables face up, things lie low), fitted on
// generated rooms, times those of convention: clouds without poses have z up more often than not.
// Where all surface faces -z, the input's axes are taken for those of a camera.
//
// An up that was given is taken, and noted where the scan contradicts it: where the up that would
// have been found lies elsewhere, by level surface, and is likelier by 20 to 1 by the same odds,
// without those of convention, and by how near a camera's up is.
UpChoice choose_up(const Surfels& surfels, const WeightedNormals& normals,
                   const std::vector<Vec3>& directions, const std::vector<Vec3>& manhattan,
                   const FrameHints& hints);

}  // namespace topple::geometry

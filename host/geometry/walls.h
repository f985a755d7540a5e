// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "geometry/segmentation.h"
#include "geometry/shell_faces.h"
#include "geometry/structure.h"
#include "geometry/surfels.h"

// The rules of find_structure() by which walls are told from what stands at them. `face` holds one
// face for each primitive; heights are along up, metres.
namespace topple::geometry {

// Of a room, where its surface ends. Nothing but noise lies behind the planes that bound it.
struct RoomEnds {
    std::vector<bool> bounds;     // of each primitive: a plane that has the whole scene before it
    double ceiling_m = INFINITY;  // of the ceiling among them; infinite where none was seen
    double walls_end_m = -INFINITY;  // the upper end of the highest wall among them
};
RoomEnds find_room_ends(const Surfels& surfels, const Vec3& up, const std::vector<Face>& face,
                        double least_area_m2, double floor_m);

// Whether a plane that does not bound the scene is a wall of a room whose ceiling was not seen: as
// large and as high as a wall, from the floor up, and what lies behind it is no deeper than the
// steps of a wall: a recess, a chimney breast, a boxed pipe. Cupboards are deeper, and one sees
// past them.
bool is_stepped_wall(const Surfels& surfels, const Face& face, const RoomEnds& ends,
                     double floor_m);

// Where a ceiling was seen, a wall need not reach it: ducts, beams and coves are between. Upright
// sheets that are higher than a person and end at the ceiling, or at what is built in under it,
// along most of their upper edge become walls.
void add_walls_under_shell(const Surfels& surfels, const PrimitiveSet& primitives, const Vec3& up,
                           const std::vector<Face>& face, double floor_m,
                           std::vector<Structure>& structure);

// What lies in the planes of walls, no further away than a door is wide, becomes wall: pieces that
// doors and things cut off.
void add_wall_pieces(const Surfels& surfels, const PrimitiveSet& primitives, const Vec3& up,
                     const std::vector<Face>& face, std::vector<Structure>& structure);

}  // namespace topple::geometry

// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/surfels.h"

namespace topple::geometry {

inline constexpr double horizontal_cos = 0.9;  // within 26 degrees of up: allows for noisy normals
inline constexpr double vertical_sin = 0.3;    // within 17 degrees of level
inline constexpr double flat = 0.85;           // of a plane, the least length of the mean normal
// In maps of thin walls and floors, cells behind the surface are free where the sensor erred. Share
// of a plane's surfels that may face the other way, and how even the plane must be but for those.
inline constexpr double most_against = 0.25, even_sheet = 0.95;
// A smaller plane bounds no room.
inline constexpr double wall_area_m2 = 0.3;
// A wall that is known by its height is no smaller.
inline constexpr double high_wall_m2 = 1.5;
// A wall has its other face no farther behind, and goes on beyond a door of this width.
inline constexpr double thickest_wall_m = 0.5, door_m = 1.5;
// Walls end no lower below ceilings.
inline constexpr double below_ceiling_m = 0.2;

inline double component(const Vec3& a, double x, double y, double z) {
    return a[0] * x + a[1] * y + a[2] * z;
}

// Area-weighted mean plane of one primitive: point, normal, and how much of it agrees.
struct Face {
    double area_m2 = 0;  // of all its surfels
    double nx = 0, ny = 0, nz = 0, px = 0, py = 0, pz = 0;
    double flatness = 0;  // length of the mean normal: 1 for a plane, less for a box
    // The same where each normal counts by its axis: of a sheet of which both sides were seen it is
    // 1, too. The share of the surfels that face against the rest.
    double sheetness = 0, against = 0;
    double lowest_m = INFINITY, highest_m = -INFINITY;  // along up
    double height_m(const Vec3& up) const { return component(up, px, py, pz); }
    // Along up: 1 looks up, 0 is upright, -1 looks down.
    double level(const Vec3& up) const { return component(up, nx, ny, nz); }
    bool is_upright(const Vec3& up) const { return std::abs(level(up)) < vertical_sin; }
    // A plane with one side or both; and one with one side, or so even a sheet that the few surfels
    // against it only have their sides confused.
    bool is_sheet() const { return sheetness > flat; }
    bool is_plane() const {
        return flatness > flat || (sheetness > even_sheet && against < most_against);
    }
};

// label: of each surfel, below `count` or -1.
std::vector<Face> faces(const Surfels& surfels, const std::vector<std::int32_t>& label,
                        std::size_t count, const Vec3& up);

// Unit, level, along an upright face.
Vec3 level_axis(const Face& face, const Vec3& up);
// From where to where a face reaches along its level_axis().
struct LevelSpan {
    double low_m = INFINITY, high_m = -INFINITY;
};
std::vector<LevelSpan> level_spans(const Surfels& surfels, const std::vector<std::int32_t>& label,
                                   const std::vector<Face>& faces, const Vec3& up);
// Between two faces that are parallel, or look away from each other, along them; negative where
// they overlap.
double gap_m(const LevelSpan& a, const LevelSpan& b, bool opposite);

// Of the highest large plane that looks down from above a person's head, but below top_m; infinite
// where there is none.
double ceiling_height(const std::vector<Face>& faces, const Vec3& up, double floor_m, double top_m);

}  // namespace topple::geometry

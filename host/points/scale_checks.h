// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "topple/cloud_view.h"
#include "topple/error.h"
#include "topple/input.h"
#include "topple/scene.h"

// Whether a scan is of the size of rooms in metres: who gives another unit than the file's, or
// none, gets it too large or too small by 25 to 1000 times, and then rather nonsense than an error.
namespace topple {

// Where a scan came from, and so what of it, and which option, would mend it.
enum class ScanOrigin {
    cloud_file,
    mesh_file,
    map_file,
    frames_folder,
    cloud_in_memory,
    frames_in_memory
};
inline bool in_memory(ScanOrigin origin) {
    return origin == ScanOrigin::cloud_in_memory || origin == ScanOrigin::frames_in_memory;
}
inline bool of_frames(ScanOrigin origin) {
    return origin == ScanOrigin::frames_folder || origin == ScanOrigin::frames_in_memory;
}

// The longest edge of the box around points with these coordinates, metres; 0 of none.
double extent_m(const std::array<FloatColumn, 3>& axes);

// Refuses a cloud whose points are `spacing_m` apart where that is too far for surfaces at the
// coarsest resolution, which is what a room looks like in another unit than metres. Throws
// Error(input), which names the units in which it would be a room.
void check_spacing(const CloudView& cloud, double spacing_m,
                   ScanOrigin origin = ScanOrigin::cloud_file);

// Refuses a cloud whose sensor lies so far off its points that its place is in another unit. Throws
// Error(input).
void check_viewpoint_distance(const CloudView& cloud);

// Of what extends over more than a room, and would be one in another unit: "it all extends over
// 115 m: if the coordinates are in cm, multiply them by 0.01 (1.1 m)", or how else an input from
// there is mended; else "".
std::string large_extent_hint(double extent_m, ScanOrigin origin);
// What find() makes, whose Error(input) begins with that hint.
template <class Find>
auto with_unit_hint(double extent_m, ScanOrigin origin, const Find& find) {
    try {
        return find();
    } catch (const Error& error) {
        const std::string hint = large_extent_hint(extent_m, origin);
        if (error.kind() != ErrorKind::input || hint.empty()) throw;
        throw Error(ErrorKind::input, hint + ", else: " + error.what());
    }
}
// Of a cloud that is larger than rooms, or as high as none, and whose points are `spacing_m` apart,
// farther than such a scan's: the units in which it were one, as a note; else "". Those of a mesh
// are as far apart as they were made: INFINITY.
std::string unit_hint(const CloudView& cloud, double spacing_m, ScanOrigin origin);
// Of what extends over less than things in a room do: "it all extends over X m: check
// unit_m (--unit)", or what else gives the unit of such an input; else "".
std::string small_extent_hint(double extent_m, ScanOrigin origin);
// The same as a note of a scene from there, which else shows shards of nothing in particular.
void note_small_extent(double extent_m, ScanOrigin origin, std::vector<std::string>& notes);

// Refuses frames between which the camera moved as nobody carries one: their poses are in another
// unit. places: of the cameras, metres. Throws Error(input).
void check_camera_steps(std::span<const Vec3> places, const std::string& source);

// Refuses frames whose pixels lie too far apart for surfaces where their typical reading is, as
// those of a depth_scale that is off by a thousand do. Throws Error(input).
void check_readings(const Intrinsics& intrinsics, std::size_t frames, double typical_depth_m,
                    const std::string& source, ScanOrigin origin);

// Says what points of a cloud that are so far apart leave open, where that matters for things in
// rooms: thin boards, and what stands on little.
void note_spacing(double spacing_m, std::vector<std::string>& notes);

// Of frames whose typical reading is this far away: "at the depth_scale of intrinsics.json, 1, the
// readings of 4 depth frames lie about 1500 m away: check it ...".
std::string depth_scale_hint(std::size_t frames, double depth_scale, double typical_depth_m,
                             ScanOrigin origin);

}  // namespace topple

// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "topple/error.h"
#include "topple/input.h"
#include "topple/parse.h"

// Scenes for simulators: each object a rigid body of convex parts. docs/export.md says how they are
// made, and how well they stand. Their frame has z up, in metres: that which
// Scene::manhattan_from_input leads to.
namespace topple {

struct ExportOptions {
    // What to write, by format, one at least: the folders for scene.xml (MuJoCo's MJCF, with
    // scene_asleep.xml beside it), scene.urdf and scene.sdf, and the file, NAME.usda.
    std::filesystem::path mjcf, urdf, sdf, usd;
    bool visuals = true;  // what bodies look like, in the scan's colours, beside what collides
    // Doors and drawers of closed furniture as bodies on joints, as far as the scan's points tell
    // their handles.
    bool joints = true;
    unsigned threads = 0;  // 0: all cores; the result is the same
    // Polled between steps, which take seconds each; true ends the export with Error(cancelled),
    // before it has written anything.
    std::function<bool()> cancelled;
};

// What became of an object, or a pad that was made to carry one.
struct ExportedBody {
    std::string name;          // in the exports: "object_3", "pad_28"
    std::int32_t object = -1;  // id; -1 for a pad
    bool fixed = false;  // part of the world, which nothing moves: the ground, pads, what is held
    // Its footing was not seen, or was cut away as it lay in others: it stands on a pad made for
    // it, or is held where it is.
    bool on_pad = false, held = false;
    std::uint64_t struts = 0;  // of its parts: in the place of feet that were not seen
    Vec3 moved_m{};            // by which it was let down, so that it touches what carries it
    // Convex ones. A body without any is in no export: a handle that was found as a thing is part
    // of its front there.
    std::uint64_t parts = 0;
    double mass_kg = 0;   // 0 for a pad
    double solid_m3 = 0;  // of the object as it was parsed
    double parts_m3 = 0;  // of its parts: more than solid_m3 by what their hulls add
    double lost_m3 = 0;   // cut off its parts, so that no two bodies overlap

    // lost_m3 as a share of its solid, which may be above 1: parts are hulls. 0 for a pad.
    double lost_share() const { return solid_m3 > 0 ? lost_m3 / solid_m3 : 0; }
};

// A door or a drawer: a body on a joint to its object's, shut as it was scanned.
struct ExportedFront {
    std::string name;          // in the exports: "object_3_front_0", its joint "..._joint"
    std::int32_t object = -1;  // id
    std::string opens;         // "slide", or "hinge"
    double probability = 0;    // that it is there, and opens so
    Vec3 middle_m{};           // of its outer face
    double wide_m = 0, high_m = 0;
    Vec3 handle_m{};  // the middle of its handle
    double mass_kg = 0;
    Vec3 axis{};      // unit; it opens along it, or around it by the right-hand rule
    Vec3 at_m{};      // a point of a hinge's axis; of a slide middle_m
    double most = 0;  // how far it opens: metres, or radians
};

struct ExportSummary {
    std::vector<ExportedBody> bodies;     // those of the objects by id, then pads
    std::vector<ExportedFront> fronts{};  // by object
    double deepest_overlap_m = 0;         // of any two bodies
    // Height of the lowest level floor, and the middle of the widest place on it where nothing
    // stands, with its radius: NaN and 0 where there is none.
    double floor_m = std::numeric_limits<double>::quiet_NaN();
    Vec3 free_place_m{floor_m, floor_m, floor_m};
    double free_radius_m = 0;
    // What is not as it was parsed: whose parts were cut by more than half, and what is held or
    // stands on pads, in sentences.
    std::vector<std::string> notes;
};

// Writes the scene in each format that the options name, and what became of each body as
// bodies.json in the same folder. Folders are made where they are missing; earlier exports are
// replaced, and nothing else is. Throws Error: usage (no format is named), input (a file there is
// no export of topple, or can't be written: the path and why; the folder holds a scan, the one that
// was parsed or another; the cloud was parsed in blocks, so that there are no solids).
ExportSummary export_scene(const ParseResult& result, const ExportOptions& options);

// The same of a folder that write_outputs() has made: of its scene.json and solids.bin. Throws
// Error(input), too, where they are missing or damaged.
ExportSummary export_output(const std::filesystem::path& output, const ExportOptions& options);

// Throws what can be known before a long parse: that no format is named, or that a scan or a file
// of another program is where an export shall be written.
void check_export(const ExportOptions& options);

}  // namespace topple

// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "lab/scan/points.h"
#include "lab/solids/rigid.h"
#include "lab/solids/scene.h"

// Scans of a World as scanners leave them: noise, gaps and tilt differ from seed to seed.
namespace topple::scenes {

enum class ScanKind {
    walk,  // depth and colour frames of a hand-held camera, poses some millimetres off
    // Of these three a third is cut off above 1.5 to 2.4 m:
    sparse,  // such frames fused to bare points 2 to 6 cm apart, smoothed, with holes
    cloud,   // the same, 8 mm to 2 cm apart
    laser,   // some stations, 0.3 to 0.7 degrees, mixed pixels at edges
    single,  // one depth and colour frame; the scan's frame is the camera's
};

struct ScanOptions {
    ScanKind kind = ScanKind::walk;
    std::uint64_t seed = 1;
    unsigned frames = 0;   // of a walk, also that behind a cloud; 0: by the size of the room
    double spacing_m = 0;  // of a sparse or dense cloud; 0: by chance
    unsigned threads = 0;  // 0: all cores; the result does not depend on it
};

struct Scan {
    Intrinsics intrinsics;
    std::vector<DepthFrame> frames;                  // in the scan's frame
    std::vector<std::vector<Colour>> colour;         // of each frame's pixels
    std::vector<ColouredPoint> cloud;                // in the scan's frame; of clouds only
    std::vector<LabelledPoint> truth;                // surfaces in view, in the scan's frame
    double truth_m = 0.01, building_truth_m = 0.03;  // edges of the cubes that hold one truth point
    Mat4 world_to_scan = identity;
};

// Throws Error(usage) where no camera finds room in the world, or for options out of range.
Scan scan(const World& world, const ScanOptions& options);

// FOLDER/depth/NNNN.png, color/NNNN.png, intrinsics.json and, but for a single frame,
// trajectory.txt; or cloud.ply; and truth.ply (x y z object) and truth.json: what is fixed, shell
// or pile, what carries what, gravity and the frame. `kind` names the world. Throws Error(input)
// where it can't write.
void write_scan(const std::filesystem::path& folder, const World& world, const Scan& scan,
                const ScanOptions& options, const std::string& kind);

const char* to_string(ScanKind kind);

// What carries each object, by the world's supports between parts; ascending.
std::vector<std::vector<std::int32_t>> supporters(const World& world);

// The things of a world that are fixed to the building, itself among them; one flag per object.
std::vector<bool> fixed_objects(const World& world);

}  // namespace topple::scenes

// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "topple/parse.h"

namespace topple {

// What a parse will take, before it: guesses from how many points there are, over how much surface
// they spread and what stands there, by the measured costs of the stages and the speed of this
// machine. docs/performance.md tells how near they come.
struct Estimate {
    std::uint64_t points = 0;  // of a cloud; of frames those they are fused to
    std::uint64_t frames = 0;  // 0: a cloud
    double surface_m2 = 0;
    bool tiled = false;  // parsed in blocks
    double cell_m = 0;   // one point of each such cell is looked at
    // In one piece: how far apart the points are, as the parse's note has it; of frames those that
    // they are fused to.
    double spacing_m = 0;
    double voxel_m = 0;  // of solids, in one piece
    // With the device's threads on a machine without other work; and of the processor, with one.
    double seconds = 0, processor_s = 0;
    // What that is reckoned from, beside the above: pixels of frames; in one piece whether the scan
    // is looked at from virtual views, its patches and ground (scan_look.h), the voxels of its
    // surface, and those of its box, or of what a single view sees there; the seconds of a piece of
    // work here.
    std::uint64_t pixels = 0;
    bool views = false;
    double patches_m = 0, ground_m2 = 0, box_voxels = 0, surface_voxels = 0, probe_s = 0;
    // With a max_memory_bytes below it parse() refuses; what it may take as the options are; and,
    // where it would refuse, its words for that.
    std::uint64_t least_bytes = 0, allowed_bytes = 0;
    std::string refusal;
    std::string unit_hint;  // as a note of the parse has it; "" where there is none
    std::uint64_t memory_bytes = 0, work_bytes = 0, output_bytes = 0;
};

// Reads a cloud once from front to back, and of frames a sample. Holds a hash of the surface, 50 MB
// for a large building, and as many points as are parsed in one piece. options: voxel_m, unit_m,
// tile_m, max_memory_bytes, device, progress and cancelled. Throws as parse() does.
Estimate estimate(const std::filesystem::path& input, const ParseOptions& options);

}  // namespace topple

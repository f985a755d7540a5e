// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "lab/scan/scan.h"
#include "lab/solids/scene.h"
#include "topple/parse.h"
#include "vdb/fill_chance.h"

// How often what nobody saw is solid, by what its six rays end at: what vdb/fill_chance.h has its
// table from.
namespace topple::evaluation {

struct RayEndCounts {
    struct Count {
        double solid = 0, of = 0;
    };
    std::array<Count, vdb::all_ends> ends{};
    unsigned rooms = 0;
};

// Scans and parses a room, and adds some ten thousand of its voxels. Those within the room's own
// parts are not counted.
void add_rays(const std::string& kind, const scenes::ScanOptions& scan, const ParseOptions& options,
              RayEndCounts& counts);

// Percent, each drawn towards what voxels have that differ in the ray downwards alone, and that
// towards those that differ in the level ones, too.
std::string table_of(const RayEndCounts& counts);

}  // namespace topple::evaluation

// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/table.h"
#include "graph/joints.h"
#include "graph/known_links.h"
#include "graph/stable_objects.h"

namespace topple::graph {

// What was counted as the building, or as fixed to it, and may be a thing by itself.
struct BuildingPiece {
    std::vector<std::int32_t> primitives;  // ascending
    double probability = 0;                // that it is a thing
};

// Of the building's primitives those that are not surely the room's, joined where they are likelier
// one than not, in the order of their lowest ones. surface: voxels in which each primitive was
// seen. fixed: primitives known to be the building's; what is one with them is no question.
std::vector<BuildingPiece> building_pieces(std::span<const Joint> joints, const KnownLinks& links,
                                           std::span<const std::int32_t> fixed,
                                           const ShellOdds& shell, const Grouping& grouping,
                                           TableView<PrimitiveId, std::uint64_t> surface);

}  // namespace topple::graph

// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "lab/evaluation/joint_classifier.h"
#include "lab/evaluation/room.h"
#include "objects/object_stage.h"

// Table 3 of the paper: joints and supports found by three ways of grouping the same primitives.
namespace topple::evaluation {

// A generated room, parsed as far as grouping starts.
struct RoomParts {
    scenes::World world;
    ScenePoints points;              // with their primitives
    std::vector<std::int32_t> part;  // the true part of each point, -1 for none
    std::shared_ptr<const SolidScene> solids;
    vdb::VoxelFrame frame;
    PartStage parts;
};
RoomParts scan_parts(const RoomOptions& options);

// The joints whose truth is known, with what they look like; not those within the shell.
struct JointExamples {
    std::vector<JointFeatures> joints;
    std::vector<bool> fixed;
};
void add_examples(const RoomParts& room, JointExamples& examples);

struct Groupings {
    std::uint64_t seed = 0;
    scenes::RelationScore discriminative, greedy, sampled;
    double greedy_energy = 0, sampled_energy = 0;  // of Eq. 8
};
Groupings compare_groupings(device::Device& device, const RoomParts& room,
                            const JointWeights& weights);

// Means over the rooms beside the paper's figures, and the rooms one by one.
std::string table_of(const std::vector<Groupings>& rooms);

}  // namespace topple::evaluation

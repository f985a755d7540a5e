// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "device/stage_clock.h"
#include "objects/object_stage.h"
#include "safety/advise.h"
#include "safety/fields.h"
#include "safety/landing.h"
#include "safety/unsafety_category.h"
#include "topple/kernels/device.h"

// Section 5 of the paper: what may disturb the objects, and what that risks. Grid frame.
namespace topple {

struct SafetyStage {
    std::vector<safety::Disturbance> disturbances;
    std::vector<std::vector<safety::Risk>> risk;  // by disturbance, then by object
    std::vector<Suggestion> advice;               // by object
    std::vector<Landing> landings;                // by object
    std::vector<double> people_share;             // by object: of walks past its landing; or empty
    std::vector<std::vector<double>> risk_error_J;  // as `risk`: one standard error of it
    std::vector<double> unsafety;                   // by object, 1 to 10
    std::vector<safety::CategoryEnds> category;     // by object
    std::vector<safety::Category> if_otherwise;     // by alternative: the category it would have
    // The same of those of ObjectStage::possible_things.
    std::vector<std::vector<safety::Risk>> possible_risk;
    std::vector<safety::CategoryEnds> possible_category;
    std::vector<double> gust_m_s;  // by object: that tips it; NaN: none does
    bool below_ceiling = false;    // most of a ceiling was scanned
};

// The objects as the fields and the risk see them.
std::vector<safety::RiskObject> risk_objects(std::span<const Body> objects);

// Where things are. solids: must stay. bodies: by primitive.
safety::Surroundings surroundings_of(const SolidScene& solids, ObjectOf object_of,
                                     TableView<PrimitiveId, physics::MassProperties> bodies);

SafetyStage assess_safety(device::Device& device, const SolidParts& parts,
                          const ObjectStage& objects, const ParseOptions& options,
                          StageClock& stage);

}  // namespace topple

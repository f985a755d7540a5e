// SPDX-License-Identifier: MIT
#pragma once

#include "core/json.h"
#include "topple/corrections.h"

// Corrections in scene.json: as a file says them, and what became of them.
namespace topple::io {

OrderedJson json_of_correction(const AppliedCorrection& applied);
// Throws nlohmann's exceptions for what is none.
AppliedCorrection correction_of(const OrderedJson& json);

}  // namespace topple::io

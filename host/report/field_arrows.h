// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "report/view_data.h"
#include "topple/scene.h"

namespace topple::report {

// The arrows of a field, in the view: `most` of them at most. The densest sample, and of these the
// strongest, of each cube of a grid that is widened until few enough are left, from `edge_m` on;
// all samples where they are few enough.
Arrows pack_arrows(const FieldSamples& field, const Rotation& view_from_input, double edge_m,
                   std::size_t most);

}  // namespace topple::report

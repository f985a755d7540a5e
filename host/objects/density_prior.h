// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "topple/materials.h"

namespace topple {

// A density that nobody measured: log-normal.
struct DensityPrior {
    double median_kg_m3 = 0;
    double spread = 0;  // standard deviation of its logarithm
    // One standard error of a mass that is reckoned with the median, as a share of it: 68.3 % of
    // such things lie within it, on either side.
    double error_share() const;
};

// The kind whose words are the longest in the name: "coffee table" before "table"; null: none.
const ThingKind* named_kind(const Materials& materials, std::string_view name);

// Of a thing with that name, or, where no kind has it, of things of that size and fill, each kind
// as likely as it is like them. size_m: of its upright box, in any order.
DensityPrior density_prior(const Materials& materials, std::string_view name, Vec3 size_m,
                           double fill);

}  // namespace topple

// SPDX-License-Identifier: MIT
#pragma once

#include "topple/kernel_testing/case.h"

namespace topple::perf {

// What a backend can do at most: all others are compared with these (apply_roofline).
Prepared triad(device::Device& device);
Prepared multiply_add(device::Device& device);
Prepared divide(device::Device& device);
Prepared gather(device::Device& device);
inline constexpr Case probes[] = {
    {"triad", triad}, {"multiply_add", multiply_add}, {"divide", divide}, {"gather", gather}};

}  // namespace topple::perf

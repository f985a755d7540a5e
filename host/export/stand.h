// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "export/body.h"

namespace topple::exports {

// Places of the bodies, what carries others first.
std::vector<std::size_t> by_level(const std::vector<Body>& bodies);

// Lets each body down until it touches what carries it, by `most_m` at most.
void settle(std::vector<Body>& bodies, double most_m);

}  // namespace topple::exports

// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "export/body.h"

namespace topple::exports {

// Lets each body down until it touches what carries it, by `most_m` at most. What nothing carries
// within that gets a fixed pad under its lowest corners, a body of its own at the end of the list;
// or is held where it is, where it would fall off that.
void settle(std::vector<Body>& bodies, double most_m);

// Makes feet flat: corners that lie within `within_m` above what carries them come down to it,
// where no other body is in their way. Parts must not overlap.
void flatten_feet(std::vector<Body>& bodies, double within_m);

}  // namespace topple::exports

// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "export/body.h"

namespace topple::exports {

struct Scenery {
    double friction = 0.3, gravity_m_s2 = 9.81;
    double thick_m = 0.01;  // of slabs of pads
};

// Puts on pads, or else holds in their places, bodies that would begin to move at once though their
// parse says that they stand, as what carries them, or what they carry, was not told apart rightly:
// a table of which two legs were taken for other things goes over with all that stands on it.
// Whether they do is statics of all bodies together, of rigid ones with dry friction. Body::firm_m
// of 0: may fall.
void keep_balance(std::vector<Body>& bodies, const Scenery& scenery);

}  // namespace topple::exports

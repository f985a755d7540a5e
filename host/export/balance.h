// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "export/body.h"

namespace topple::exports {

// Holds, in their places, bodies that would begin to move at once though their parse says that they
// stand, as what carries them, or what they carry, was not told apart rightly: a table of which two
// legs were taken for other things goes over with all that stands on it. Whether they do is statics
// of all bodies together, of rigid ones with dry friction. Body::firm_m of 0: may fall.
void hold_unbalanced(std::vector<Body>& bodies, double friction, double gravity_m_s2);

}  // namespace topple::exports

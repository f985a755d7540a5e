// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "export/body.h"

namespace topple::exports {

// Gives each body a footing as firm as its parse says (Body::firm_m), by struts: upright bars from
// its underside down to what is below, in the place of feet that were not seen. What struts can't
// hold, as it hangs on a wall, say, is held; what hangs in the air gets a fixed pad under its
// lowest corners, a body of its own at the end of the list. thick_m: of a strut.
void brace(std::vector<Body>& bodies, double thick_m);

}  // namespace topple::exports

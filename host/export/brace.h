// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "export/body.h"

namespace topple::exports {

// Gives each body a footing as firm as its parse says (Body::firm_m), by struts: upright bars from
// its underside down to what is below, in the place of feet that were not seen. What struts can't
// hold gets a fixed pad, slabs under low corners of it, as a body of its own at the end of the
// list; what hangs on a wall with nothing close below, and what no pad can hold, is held. thick_m:
// of a strut.
void brace(std::vector<Body>& bodies, double thick_m);

// Puts a body, which what carries it does not hold up, on a fixed pad, too: appended to the list.
// False where none makes it stand.
bool put_on_pad(std::vector<Body>& bodies, std::size_t body, double thick_m);

}  // namespace topple::exports

// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "export/body.h"

namespace topple::exports {

// Gives each body a footing as firm as its parse says (Body::firm_m). Feet, of a few square
// millimetres, where its underside comes within a voxel (2 thick_m) of what carries it, at the
// corners of where it does: nothing else of it touches that, so that a simulator has few contacts
// to reckon with. Where feet are not firm, struts: longer ones, in the place of what was not seen
// of the body; or ledges: what carries it goes on by a voxel at most. What these can't hold gets a
// fixed pad, slabs under low corners of it, as a body of its own at the end of the list; what hangs
// on a wall with nothing close below, and what no pad can hold, is held.
void brace(std::vector<Body>& bodies, double thick_m);

// Puts a body, which what carries it does not hold up, on a fixed pad, too: appended to the list.
// False where none makes it stand.
bool put_on_pad(std::vector<Body>& bodies, std::size_t body, double thick_m);

}  // namespace topple::exports

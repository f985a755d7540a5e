// SPDX-License-Identifier: MIT
#pragma once

namespace topple {

// What an object may be fastened to.
struct Fastening {
    bool wall = true;    // something of the building is within reach of its top
    bool floor = false;  // it stands on the floor, and not on a thing
};

}  // namespace topple

// SPDX-License-Identifier: MIT
#pragma once

#include "lab/random.h"
#include "lab/solids/scene.h"

namespace topple::scenes {

// Gives every part a colour that things of its name have: mostly one for equal parts of an object,
// often one for all of it; neighbours are alike by chance.
void paint(World& world, Random random);

}  // namespace topple::scenes

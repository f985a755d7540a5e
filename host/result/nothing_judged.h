// SPDX-License-Identifier: MIT
#pragma once

#include "topple/scene.h"

namespace topple {

// Where no object has a risk that anything is known of, as none that could move was found, or of
// none the scan shows what holds it, that is the first of the notes: with why, what the scan was
// taken for, and what to try. A list without a risk reads as if the room were safe.
void note_nothing_judged(Scene& scene);

}  // namespace topple

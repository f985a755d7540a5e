// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"
#include "topple/parse.h"

namespace topple::parses {

// What holds of every parse: in words what does not of this one, or nothing.
//   - labels name primitives and objects that are there; a point's object is its primitive's;
//     objects part the primitives among them; contacts and supports join two that are there;
//   - an object's mass is the sum of its primitives', and a primitive's voxels are in `solid`,
//     which has strays, too;
//   - masses, energies, areas, errors and risks are finite and not negative, probabilities and
//     shares are 0 to 1, the instability curve rises, unsafety is 1 to 10 or not known;
//   - reasons, categories and advice are those of the numbers;
//   - nothing holds itself up: the supports, from supporter to supported, have no cycle but of two
//     that each carry the other.
std::string what_is_wrong(const Scene& scene);

// The same of what write_outputs() left in a folder: scene.json says what the scene says, and
// points and voxels have its labels.
std::string what_is_wrong(const Scene& scene, const std::filesystem::path& folder);

}  // namespace topple::parses

// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lab/solids/scene.h"

// Families of rooms, each with sizes, contents and arrangement by chance.
namespace topple::scenes {

// Names that make_world() takes.
const std::vector<std::string>& kinds();

// The room of a seed, painted. The same seed gives the same room everywhere. Throws Error(usage)
// for a kind that there is not.
World make_world(const std::string& kind, std::uint64_t seed);

}  // namespace topple::scenes

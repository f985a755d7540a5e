// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "lab/solids/scene.h"

// One plan for each family of make_world(), unpainted.
namespace topple::scenes {

World make_kitchen(std::uint64_t seed);
World make_bathroom(std::uint64_t seed);
World make_bedroom(std::uint64_t seed);
World make_living_room(std::uint64_t seed);
World make_office(std::uint64_t seed);
World make_corridor(std::uint64_t seed);
World make_shop(std::uint64_t seed);
World make_storage(std::uint64_t seed);
World make_precarious(std::uint64_t seed);
World make_tabletop(std::uint64_t seed);
World make_library(std::uint64_t seed);
World make_meeting(std::uint64_t seed);
World make_lounge(std::uint64_t seed);
World make_laundry(std::uint64_t seed);
World make_depot(std::uint64_t seed);

}  // namespace topple::scenes

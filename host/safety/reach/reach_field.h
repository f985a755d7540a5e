// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "safety/disturbances.h"
#include "safety/fields.h"
#include "safety/people.h"

namespace topple::safety {

// What people who reach for things may do to those that they get hold of from where they stand. One
// event is one hold: someone of one of the kinds, each as likely, stands at a place of the walkable
// map, any as likely, from where a thing is in reach: what a level line from there, in one of 16
// directions and at a height that the kind reaches, meets first within an arm's length. One of the
// things in reach, any as likely, is pulled at as high as can be reached, leaned on at 0.6 m,
// climbed, opened or fallen against, one as likely as the other but for falls (PersonKind). What is
// at least as high and heavy as the furniture of ASTM F2057-23 and stands on their floor, or on a
// step, children climb, and of what may have drawers all are pulled out from before it, onto which
// children climb.
Disturbance reach_field(device::Device& device, const Surroundings& surroundings,
                        std::span<const RiskObject> objects,
                        std::span<const PersonKind* const> kinds);

const DisturbanceKind& reach_kind();

}  // namespace topple::safety

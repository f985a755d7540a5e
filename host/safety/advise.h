// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "objects/object_stage.h"
#include "safety/fields.h"
#include "safety/find_fastenings.h"

// What would lower the risk of each object to what is tolerated. Grid frame.
namespace topple {

struct Suggestion {
    // nothing: its risk is tolerated. see: nothing that holds it was seen, and no risk reckoned.
    // check: it stands, but its barrier can't be told from 0, so that its risk may be the scan's
    // fault.
    enum class Kind { nothing, see, check, move, fix };
    Kind kind = Kind::nothing;
    Vec3 move_m{};               // move: horizontal
    double risk_J = 0;           // its largest afterwards
    safety::Push hold{};         // fix: what a fixing must take, at the top of the object
    std::string hold_against{};  // the disturbance that asks for most of that
    Fastening fasten{};          // what it may be fastened to (find_fastenings.h)
    std::int32_t leg_of = -1;    // the object that it may be a leg of (legs.h); -1: none
};

// `move` is the smallest way on the object's support to a place from where all disturbances bring
// tolerable_J at most: without an edge to tip over within its height, far from edges to slide
// off, out of the reach of walkers. What it carries is taken to move along. Places up to 1.5 m away
// are looked at, for the `most_moved` riskiest. Else `fix`: the moment of the strongest push less
// what its own weight holds, over its height, or the push less friction, if that is more.
inline constexpr std::size_t most_moved = 16;
std::vector<Suggestion> advise(const SolidScene& solids,
                               std::span<const std::int32_t> object_of_primitive,
                               std::span<const Body> objects,
                               std::span<const safety::RiskObject> at_risk,
                               std::span<const safety::Disturbance> disturbances,
                               std::span<const std::vector<safety::Risk>> risk, double tolerable_J,
                               const Unseen& unseen = {});

// Whether what is known of object o, and with it its category, is to be doubted: how it stands is
// one of several readings of the scan, none of them likelier than not; or it stood when it was
// scanned, although a lean by three degrees would upset it, or one in twenty events of a kind that
// has happened before.
bool stands_against_odds(const Body& object, std::span<const safety::Disturbance> disturbances,
                         std::span<const std::vector<safety::Risk>> risk, std::size_t o);

}  // namespace topple

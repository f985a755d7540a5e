// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "topple/scene.h"
#include "topple/session.h"

namespace topple::live {

// The objects of a scene that pixels of some frames show, frame by frame; -1: none. Pixels of one
// frame show the same things whatever was made of its pose and of the others since.
using ShownObjects = std::map<FrameId, std::vector<std::int32_t>>;

// Which objects of one scene are which of the one before: those that most of the same pixels show;
// of what then is left, those of the same size and weight, which have moved.
class KnownThings {
  public:
    // What the objects are, and what of those before has vanished.
    std::vector<Thing> name(const Scene& scene, const ShownObjects& shown);

  private:
    struct Before {
        ThingId id;
        Vec3 middle_m, size_m;
        double mass_kg;
        std::vector<ThingId> stands_on;  // ascending
        std::string category;
    };
    std::vector<Before> before_;  // by object of the scene before
    ShownObjects shown_before_;
    ThingId next_ = 1;
};

}  // namespace topple::live

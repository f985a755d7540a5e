// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "topple/scene.h"
#include "topple/session.h"

namespace topple::live {

// What spots of a frame, its pixels or some of its points, show of a scene: its objects, -1: none;
// whether later frames see through what is there, so that it has gone since; and whether frames of
// before saw through it, so that it has come.
struct Shown {
    std::vector<std::int32_t> object;
    std::vector<bool> gone, came;
};
// By frame: the same pixels whatever was made of its pose, and of the others, since.
using ShownObjects = std::map<FrameId, Shown>;
using Showed = std::map<FrameId, std::vector<std::int32_t>>;  // the objects alone

// Which objects of one scene are which of the one before: those that most of the same pixels show;
// of what then is left, what came and is like what has gone.
class KnownThings {
  public:
    // What the objects are, and what of those before has vanished.
    std::vector<Thing> name(const Scene& scene, const ShownObjects& shown);
    // For both ways (core/fields.h). spots: of each frame, where all have as many.
    template <class Io, class Self>
    static void fields(Io& io, Self& known, std::optional<std::size_t> spots);

  private:
    struct Before {
        ThingId id;
        Vec3 middle_m, size_m;
        double mass_kg;
        std::vector<ThingId> stands_on;  // ascending
        std::string category;
    };
    std::vector<Before> before_;  // by object of the scene before
    Showed showed_;
    ThingId next_ = 1;
};

}  // namespace topple::live

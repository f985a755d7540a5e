// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "live/gone_things.h"
#include "live/seen_through.h"
#include "topple/scene.h"
#include "topple/session.h"

namespace topple::live {

// What spots of a frame, its pixels or some of its points, show of a scene: its objects, -1: none;
// what later frames say of it, which see through what has gone since; and what frames of before
// the last update say, which saw through what has come.
struct Shown {
    std::vector<std::int32_t> object;
    std::vector<Says> later, earlier;
};
// By frame: the same pixels whatever was made of its pose, and of the others, since.
using ShownObjects = std::map<FrameId, Shown>;
using Showed = std::map<FrameId, std::vector<std::int32_t>>;  // the objects alone

// Which objects of one scene are which of the one before: those that most of the same pixels show;
// of what then is left, what came and is like what has gone.
class KnownThings {
  public:
    // Of each object of the scene before, the building aside, which pixels showed it. pixels_of: of
    // a frame, those of its spots; none of one that is no longer there.
    std::vector<ThingPixels> pixels(
        const std::function<std::vector<std::uint32_t>(FrameId)>& pixels_of) const;
    // What the objects are, and what of those before has vanished. no_longer: those of the scene
    // before that are not where they were (gone_from()); empty: none.
    std::vector<Thing> name(const Scene& scene, const ShownObjects& shown,
                            const std::vector<bool>& no_longer = {});
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

// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "live/projection.h"
#include "live/seen_through.h"
#include "topple/session.h"

namespace topple::live {

// By frame, the pixels of its image that show one thing.
using ThingPixels = std::map<FrameId, std::vector<std::uint32_t>>;

// A session's frames, and what later ones say of each; what is referred to must stay.
struct FramesLooked {
    const Projection& projection;
    const std::vector<FrameId>& ids;  // ascending
    const std::vector<DepthFrame>& images;
    const std::vector<Looked>& later;
    std::size_t number_of(FrameId id) const {
        return static_cast<std::size_t>(std::ranges::lower_bound(ids, id) - ids.begin());
    }
};

// Where later frames see through enough of what shows a thing, that thing is no longer there: it
// has gone, or stands elsewhere. What they can't tell of it, as its foot is too near the floor
// behind it, is not there either. Of each such thing those frames that were taken before; of others
// none. Of none where more than a few seem to have gone at once, and many of all that is looked at:
// then it is poses that are off.
std::vector<ThingPixels> gone_of(std::vector<ThingPixels> things, const FramesLooked& frames);
// Those of what had gone before that are still seen through: poses may have been corrected since.
std::vector<ThingPixels> still_gone(std::vector<ThingPixels> things, const FramesLooked& frames);

// Adds to what is seen through of each frame the pixels that show these things in frames that were
// taken before they went.
void add_things(std::span<const ThingPixels> gone, const FramesLooked& frames,
                std::vector<Gone>& through);

}  // namespace topple::live

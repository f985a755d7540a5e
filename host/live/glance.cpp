// SPDX-License-Identifier: MIT
#include "live/glance.h"

#include <algorithm>
#include <utility>

#include "live/appeared.h"
#include "topple/device.h"
#include "topple/kernels/device.h"

namespace topple::live {

std::vector<Appeared> Glance::operator()(const LiveScene& scene, const FrameLabeller& labeller,
                                         const Frames& frames, const ParseOptions& options) const {
    constexpr std::size_t most_frames = 4;
    const std::lock_guard one_at_a_time(mutex_);
    if (!device_) device_ = device::open_device("native", threads_);
    std::vector<Vec3> places;
    std::size_t glanced = 0;
    for (auto at = frames.rbegin(); at != frames.rend() && glanced < most_frames; ++at) {
        const auto& [id, frame] = *at;
        if (std::ranges::binary_search(scene.frames, id)) continue;
        ++glanced;
        const std::vector<Vec3> came =
            places_that_came(*scene.result, labeller, kind_.points(frame), frame.pose,
                             kind_.projection(), came_in(frame, frames, scene.frames), threads_);
        places.insert(places.end(), came.begin(), came.end());
    }
    return judge_bodies(*device_, *scene.result, new_bodies(*scene.result, places), options);
}

// By pixel of its image: whether frames of an update saw through what it shows.
std::vector<bool> Glance::came_in(const PosedFrame& frame, const Frames& frames,
                                  const std::vector<FrameId>& parsed) const {
    const Projection& by = kind_.projection();
    std::vector<DepthFrame> seen;
    for (auto id = parsed.rbegin(); id != parsed.rend() && seen.size() < most_asked; ++id) {
        const auto kept = frames.find(*id);
        if (kept != frames.end() && look_alike(by, frame.pose, kept->second.pose))
            seen.push_back(posed_image(kept->second));
    }
    std::ranges::reverse(seen);
    seen.push_back(posed_image(frame));
    const std::size_t last = seen.size() - 1;
    const Looks looks(by, seen, device_->threads());
    const auto came =
        looks.look([&](std::size_t n) { return std::pair(std::size_t{0}, n == last ? last : 0); });
    std::vector<bool> out;
    for (const Says says : came[last].says) out.push_back(says == Says::through);
    return out;
}

}  // namespace topple::live

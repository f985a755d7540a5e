// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "core/place.h"
#include "live/projection.h"
#include "topple/frame_labels.h"
#include "topple/parse.h"
#include "topple/session.h"

// Things that stand where a scene is known to be free: told apart from all else by that alone,
// before a parse knows of them.
namespace topple::live {

// Of a frame's readings those at what came, by pixel of its image by `projection`, that lie in
// voxels that were seen to be free, and at nothing that is known: grid frame. None of a frame whose
// pose is too far off to tell. points: in the sensor's axes.
std::vector<Vec3> places_that_came(const ParseResult& scene, const FrameLabeller& labeller,
                                   const PointCloud& points, const Mat4& sensor_to_world,
                                   const Projection& projection, const std::vector<bool>& came,
                                   unsigned threads);

// Clusters of the voxels that new readings lie in, each as it is taken to be solid: in each layer,
// down to what carries it, what lies within the convex outline of all that is as high. Of voxels
// whose edge is the scene's over `finer`, as noise allows it of what is new. What nothing carries
// that was seen is none. Sorted, the largest cluster first. places: of readings,
// grid frame.
inline constexpr std::int32_t finer = 2;
// The scene's voxel that such a one lies in.
constexpr Place coarse(const Place& fine) {
    Place out{};
    for (std::size_t a = 0; a < 3; ++a)
        out[a] = fine[a] >= 0 ? fine[a] / finer : -((finer - 1 - fine[a]) / finer);
    return out;
}
std::vector<std::vector<Place>> new_bodies(const ParseResult& scene, std::span<const Vec3> places);

// What they weigh, stand on and risk amid the scene, judged as find_objects() and assess_safety()
// judge bodies, of whole voxels. Categories are those at the worse end of errors. Without those of
// which it was not seen what holds them.
std::vector<Appeared> judge_bodies(device::Device& device, const ParseResult& scene,
                                   std::span<const std::vector<Place>> bodies,
                                   const ParseOptions& options);

}  // namespace topple::live

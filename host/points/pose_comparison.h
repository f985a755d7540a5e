// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "points/small_frames.h"
#include "topple/input.h"

namespace topple::geometry {

// What the numbers of a camera's pose may mean; `camera_to_world`, x right, y down, z ahead, is
// what they have to.
enum class PoseConvention : std::uint8_t {
    camera_to_world,
    world_to_camera,
    opengl,  // y up, z back: OpenGL, Blender, ARKit
    world_to_camera_opengl,
    body,  // x ahead, y left, z up: a robot's
    world_to_camera_body,
    w_first,     // a quaternion w, x, y, z, read as x, y, z, w
    transposed,  // the rotation alone: column-major, or of conjugated quaternions
};
inline constexpr std::size_t pose_conventions = 8;

// Frames whose poses do not fit those before: the same place is seen by both, and one looks through
// what the other shows. What moves in the room is a part of what they see, and poses that are off
// all of it.
struct PoseContradiction {
    std::size_t from = 0;        // the first of them, counted from 0
    std::size_t until = 0;       // the first that fits again; as many as there are frames: none
    std::size_t against = 0;     // a frame before, which it contradicts
    std::size_t pairs = 0;       // of frames that look at the same place
    std::size_t contradict = 0;  // of these
    bool same_pose = false;      // `from` has that of the frame before it
    // By how much they are off: how far, and by what turn, a camera is to be moved so that the
    // surfaces meet; 0: no such motion was found.
    double way_m = 0, turn_deg = 0;
    double doubled_m = 0;  // how far apart things before the camera then lie twice
};

// Tells from depth frames whether their poses fit: each is compared with the one before it, and
// with those farthest back in time that look at the same place, so that both jumps and drift show.
// Frames that contradict each other are compared in other conventions, too: readings of one,
// carried into another, meet the surfaces that it sees there in the right convention alone.
class PoseComparison {
  public:
    // poses: of each frame, as given, rigid, metres. typical_depth_m: of their readings.
    PoseComparison(const Intrinsics& intrinsics, std::span<const Mat4> poses,
                   double typical_depth_m);

    // Frame `number` of them; a small copy is kept, of at most a thousand frames.
    void add(const DepthFrame& frame, std::size_t number);

    struct Verdict {
        std::optional<PoseContradiction> contradiction;
        // Looked for where there is one, among frames that turn against each other by a part of
        // the field of view, by which conventions come apart.
        std::size_t pairs = 0;
        std::array<Agreement, pose_conventions> agreement;  // in each convention
        // The conventions, best first, in which the frames agree where they clearly do not in
        // `camera_to_world`; of several the frames do not tell which. Mostly none.
        std::vector<PoseConvention> better;
    };
    Verdict verdict() const;

  private:
    struct Pair {
        std::size_t a, b;
        auto operator<=>(const Pair&) const = default;
    };
    struct Compared;
    std::vector<Pair> pairs_in_time() const;
    std::vector<Pair> turned_pairs() const;
    std::optional<PoseContradiction> find_contradiction() const;
    using ComparedPairs = std::vector<std::pair<Pair, Compared>>;
    bool look_at_one_place(std::size_t a, std::size_t b) const;
    static bool mends(const SmallFrames::Cells& given, const SmallFrames::Cells& moved);
    bool has_witnesses(const Pair& pair, const Eigen::Isometry3d& moved) const;
    Compared compare(const Pair& pair) const;
    void find_first(PoseContradiction& out) const;
    std::size_t fits_again(std::size_t from, const ComparedPairs& compared) const;

    double field_of_view_, typical_depth_m_;
    std::size_t every_;  // of how many frames one is kept
    std::vector<Eigen::Isometry3d> poses_;
    SmallFrames frames_;
};

}  // namespace topple::geometry

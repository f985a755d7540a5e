// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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

// The pose that was meant. given: rigid.
Mat4 pose_meant(const Mat4& given, PoseConvention convention);

// Tells in which convention the poses of depth frames were given, from the frames: the readings of
// one, carried into another that looks at the same place, meet the surfaces that it sees there in
// the right convention alone. Pairs are frames that turn against each other by a part of the field
// of view, by which conventions come apart, and are nearest then; among frames that do not turn
// those that move as far. By how much two frames turn is the same in all conventions but `w_first`.
class PoseComparison {
  public:
    // poses: of each frame, as given, rigid, metres. typical_depth_m: of their readings.
    PoseComparison(const Intrinsics& intrinsics, std::span<const Mat4> poses,
                   double typical_depth_m);

    // Frame `number` of them; a small copy is kept of those that are in pairs.
    void add(const DepthFrame& frame, std::size_t number);

    // Of the readings that were carried from one frame of a pair into the other.
    struct Agreement {
        std::uint64_t carried = 0;      // all
        std::uint64_t compared = 0;     // that fall on a surface there, which both see or one hides
        std::uint64_t agreeing = 0;     // that lie on it, to three standard deviations of readings
        std::uint64_t before = 0;       // that lie before it, where the other frame looks through
        double agreeing_share() const;  // of those compared; 0 of none
        double before_share() const;    // of those compared; 0 of none
        double common_share() const;    // of all, that agree; 0 of none
    };
    // Over the pairs whose frames were both added.
    struct Verdict {
        std::size_t pairs = 0;
        std::array<Agreement, pose_conventions> agreement;  // in each convention
        // The conventions, best first, in which the frames agree where they clearly do not in
        // `camera_to_world`; of several the frames do not tell which. Mostly none.
        std::vector<PoseConvention> better;
        // Whether the frames contradict each other, as they are given: few readings agree, and many
        // lie where others look through. Without a better convention the poses are of other images,
        // or the intrinsics are wrong.
        bool contradict = false;
        // Of all frames so many have one and the same pose, where half of them or more do, and are
        // compared as they are; `moved`: mostly they see something else, as a camera that stands
        // still does not.
        std::size_t frames = 0, same_poses = 0;
        Agreement at_one_pose;
        bool moved = false;
    };
    Verdict verdict() const;

  private:
    struct Pair {
        std::size_t a, b;
    };
    struct Kept {
        std::size_t number;
        std::vector<std::uint16_t> depth;  // every step_-th pixel, row by row; empty: not added yet
    };
    void choose_pairs(double typical_depth_m);
    void choose_same_poses();
    const Kept* kept(std::size_t number) const;
    void carry(const Kept& from, const Kept& to, const Mat4& to_from_from, Agreement& into) const;

    Intrinsics intrinsics_;
    std::uint32_t step_, width_, height_;  // of the small copies
    std::vector<Mat4> poses_;
    std::vector<Pair> pairs_;
    std::vector<std::size_t> same_;  // frames of one pose to compare, of same_poses_
    std::size_t same_poses_ = 0;
    std::vector<Kept> kept_;  // by number
};

}  // namespace topple::geometry

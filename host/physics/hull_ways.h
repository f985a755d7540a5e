// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "physics/hull_polytope.h"
#include "physics/landscape.h"

// The exact landscape of a hull as seen from one pose. Heights are U / (M g), metres.
namespace topple::physics {

// One pass out of the start's basin, and the deepest minimum that it opens beyond those that lower
// passes open (paper, Defs. 1 and 2).
struct PosePass {
    double height_m = 0;         // at the pass
    Vec3 direction{};            // up in the body's frame at the pass
    double deepest_m = 0;        // lowest height behind this pass or lower ones
    Vec3 deepest{};              // and its direction
    std::optional<Ends> edge{};  // over which it balances, relative to the centre of mass
};

class HullWays {
  public:
    // Vertices are relative to the centre of mass; `start` is up in the pose, unit. Throws
    // Error(input) as hull_landscape does.
    HullWays(std::span<const Vec3> vertices, const Vec3& start);

    const HullPolytope& hull() const { return hull_; }
    double start_height() const { return start_height_m_; }
    // The pose at the end of the steepest way down from the start; settling makes it the start.
    Vec3 rest() const { return direction(rest_); }
    double rest_height() const { return hull_.face[rest_].height * hull_.radius; }
    void settle();

    // The passes behind which a descent of more than noise_m lies, by rising height: the lowest,
    // and those that open something deeper than lower ones do.
    std::vector<PosePass> passes(double noise_m) const;
    // Height at a direction, and the least highest point of all ways there from the start.
    double height(const Vec3& up) const;
    double level(const Vec3& up) const;
    // Whether the body can turn by 90 degrees and more with its height all the way within noise_m
    // of the start's.
    bool rolls(double noise_m) const;

  private:
    Vec3 direction(std::uint32_t node) const;
    std::optional<Ends> edge(std::uint32_t node) const;
    HullPolytope hull_;
    MergeTree tree_;
    Vec3 start_;
    double start_height_m_;
    std::uint32_t rest_;  // face at the end of the steepest way down from the start
};

}  // namespace topple::physics

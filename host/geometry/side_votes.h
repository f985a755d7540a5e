// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/thread_pool.h"
#include "geometry/surfel_views.h"
#include "geometry/surfels.h"

namespace topple::geometry {

// Which side of each surfel was free, by what is seen from eyes in free space. Surfels without a
// normal have no sides.
class SideVotes {
  public:
    // radii_m: of the surfels' discs.
    SideVotes(const Surfels& surfels, std::span<const float> radii_m, ThreadPool& pool);

    // 1: the normal points to the free side, -1: away from it, 0: not known.
    int side(std::size_t i) const { return side_[i]; }
    // Cosine between the surfel's normal and the direction to the eye.
    double facing(std::size_t i, const Vec3& eye) const;
    // Whether it is no edge, nor both faces of a thin board.
    bool one_sided(std::size_t i) const;
    bool from_behind(std::size_t i, const Vec3& eye) const;

    // All normals point to the free side; or no side is known.
    void believe_normals();
    void forget();
    // What an eye sees first faces it.
    void face(std::size_t i, double facing) { side_[i] = facing > 0 ? 1 : -1; }

    // Sight leaks through gaps between surfels and meets the insides of faces, here and there one
    // surfel: of which little of the surface around is seen, that is not seen at all, and is taken
    // from the view. The vote of an eye on a surfel's side counts by the square of the share that
    // it sees of that surface, times that of what the surfel stands for: of a narrow rim the back
    // of a disc's margin may be in view.
    void count(CubeView& view);
    // The side of a surfel becomes that for which it and its neighbours in one surface have more
    // votes; what only leaks speak of is not known.
    void agree();
    // From the surfels whose side is known to the others, first to those of which the known ones
    // around say most, all together: where a face stands on a floor that goes on below it, those
    // before it and behind it cancel, and the other edges tell.
    void spread();

  private:
    float view_share(std::size_t i, std::uint32_t pixels, const Vec3& eye) const;
    float cosine(std::size_t i, std::size_t j) const;
    float agreement(std::size_t i, std::size_t j) const;

    const Surfels& s_;
    std::span<const float> radii_;
    ThreadPool& pool_;
    std::vector<std::int8_t> side_;
    std::vector<float> votes_;  // of the eyes for the normal's side, less those for the other
};

}  // namespace topple::geometry

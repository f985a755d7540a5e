// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "geometry/surfels.h"

namespace topple::geometry {

// The space around a scene in coarse cubic cells, to find places in that a sensor could have stood
// at. Input frame, metres.
class FreePlaces {
  public:
    // Cells of a 48th of the scene's longest side, or three surfels where that is more, with a
    // margin on all sides to look in from. Surfels of the outer thousandth on each side don't
    // count.
    explicit FreePlaces(const Surfels& surfels);

    double cell_m() const { return cell_m_; }
    double longest_m() const;  // longest side of the grid
    double volume_m3() const;  // of the scene's box
    // Cells that something may stand in: two steps from anything occupied. For each its middle.
    std::size_t size() const { return middle_.size(); }
    const Vec3& middle(std::size_t place) const { return middle_[place]; }
    bool is_within(std::size_t place) const { return within_[place]; }  // the scene's box
    // Along the axes to the nearest occupied cell.
    double clearance_m(std::size_t place) const { return clearance_[place]; }

    // Marks places that are known to be free: only these are chosen from then on. Different places
    // may be marked by different threads.
    void set_free(std::size_t place) { free_[place] = 1; }
    bool is_free(std::size_t place) const { return free_[place] != 0; }

    // The place with the most room around it that sees the most of the scene around it, far from
    // those chosen before; size() where there is none left. As the first one any place that was not
    // passed over, outside of the scene's box only where there is none in it; then of those that
    // are known to be free; of those that are not, closed in on almost all sides with so much
    // clearance, and not passed over; or of those outside of the box that may be chosen.
    std::size_t choose_first() const;
    std::size_t choose_free() const;
    std::size_t choose_closed(double clearance_m) const;
    std::size_t choose_outside(const std::function<bool(std::size_t)>& may) const;
    // This place is chosen neither as the first nor as a closed one.
    void pass_over(std::size_t place) { passed_over_[place] = true; }
    // Places near this one are not chosen again.
    void leave_out(const Vec3& chosen);

  private:
    void occupy(const Surfels& surfels);
    void find_places();
    // Of each cell, in how many of the 26 directions to its neighbours and on there is something.
    std::vector<std::uint8_t> directions_hit() const;
    std::size_t best(const std::function<bool(std::size_t)>& may) const;
    bool inside(const std::array<int, 3>& c) const;
    std::size_t at(const std::array<int, 3>& c) const;

    Vec3 low_{};
    double cell_m_ = 0;
    std::array<int, 3> size_{};
    std::vector<bool> occupied_;
    std::vector<Vec3> middle_;       // of each place
    std::vector<double> clearance_;  // steps along the axes to the nearest occupied cell, metres
    std::vector<double> enclosure_;  // share of 26 directions in which something is seen
    std::vector<double> apart_;      // from the nearest chosen one
    std::vector<bool> within_;       // the scene's box
    std::vector<bool> passed_over_;
    std::vector<std::uint8_t> free_;  // bytes, which several threads may set
};

}  // namespace topple::geometry

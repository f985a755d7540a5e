// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "topple/input.h"

namespace topple::io {

// How a file stores its points' colours. Of all but bytes it says nowhere what full brightness is:
// that is 255 or 65535 of whole numbers, 1 too of real ones.
enum class ColourValues : std::uint8_t { none, bytes, whole, real };

// Takes a file's colours to a cloud's bytes. Full brightness is the least of the above that 99 of a
// hundred values reach, of those that are not 0, among the file's first.
class ColourScale {
  public:
    explicit ColourScale(ColourValues values) : values_(values) {}
    // Of the cloud's next point. A value that is negative or not finite makes it unknown.
    void add(const std::array<double, 3>& colour, PointCloud& cloud);
    // Before the cloud's arrays are used: what waits for more values waits no longer.
    void settle(PointCloud& cloud);

  private:
    void put(const std::array<double, 3>& colour, PointCloud& cloud) const;

    ColourValues values_;
    double full_ = 0;                            // 0: not known yet
    std::vector<std::array<float, 3>> waiting_;  // until it is
    std::uint64_t bright_ = 0;                   // of those, with a value above 0
};

}  // namespace topple::io

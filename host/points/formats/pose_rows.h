// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace topple::io {

// Tells files of cameras' poses, which are rows of numbers as well, from those of points: rows of
// TUM (t x y z qx qy qz qw, at times that rise), of KITTI (three rows [R | t]), and matrices of
// four rows, before each of which one of three may stand, as Open3D writes them.
class PoseRows {
  public:
    // The next row of the file, of its first numbers. `columns`: how many it has.
    void add(std::span<const double> values, std::size_t columns);
    // Enough were added.
    bool full() const { return rows_ == most_rows; }
    // Whether all of them are of poses; not of a file without rows.
    bool are_poses() const;

    static constexpr std::size_t most_rows = 10, most_columns = 12;

  private:
    using Row = std::array<double, most_columns>;
    bool tum() const;
    bool kitti() const;
    bool matrices() const;

    std::array<Row, most_rows> row_{};
    std::array<std::size_t, most_rows> columns_{};
    std::size_t rows_ = 0;
};

}  // namespace topple::io

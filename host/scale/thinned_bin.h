// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scale/point_spill.h"

namespace topple::tiles {

// The cells of the cubic grid of cell_m that hold points of a bin, in the order of their indices
// (x, then y, then z): the mean of each cell's points, in the input's frame, metres. cell_m divides
// bin_edge_m, so that each cell is in one bin.
struct ThinnedBin {
    std::vector<float> x, y, z;
    std::vector<std::uint32_t> points;  // of each cell
    // Mean of those whose colour is known, 0, 0, 0 where none is; or empty, as of PointCloud.
    std::vector<std::uint8_t> red{}, green{}, blue{};
    std::size_t size() const { return x.size(); }
};

// The largest size that divides bin_edge_m and is not above `cell_m`.
double dividing_cell(double cell_m);

// Thins a bin and writes it to `folder`, with the cell of each of its points. Holds the cells, and
// a portion of the points at a time.
void thin_bin(const SpilledPoints& points, std::size_t bin, double cell_m,
              const std::filesystem::path& folder);

// The file that comes last: where it is in the folder, the bin is done.
std::string thinned_name(const Bin& bin);
ThinnedBin read_thinned(const std::filesystem::path& folder, const Bin& bin);

// The cells of a bin's points, in the points' order, a portion at a time.
class CellsOfPoints {
  public:
    CellsOfPoints(const std::filesystem::path& folder, const Bin& bin);
    // Throws Error(input) beyond the last point.
    std::uint32_t next();
    std::uint64_t points() const { return points_; }
    std::size_t cells() const { return cell_of_place_.size(); }

  private:
    std::filesystem::path file_;
    std::uint64_t points_ = 0, read_ = 0;
    std::vector<std::uint32_t> cell_of_place_, portion_;
    std::vector<std::uint64_t> sums_;  // of the portions
    std::size_t at_ = 0;
};

// Throws Error(input) naming the file where some of a bin's is not what was written.
void check_thinned(const std::filesystem::path& folder, const Bin& bin);

// The bin whose file thinned_name() names so; nothing where it names none.
std::optional<Bin> bin_of_name(const std::string& name);
// Removes all files of a bin.
void remove_thinned(const std::filesystem::path& folder, const Bin& bin);

}  // namespace topple::tiles

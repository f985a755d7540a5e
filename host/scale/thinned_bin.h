// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
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

// Appends a cell's mean to a cloud, or a scene's points.
template <class Points>
void add_cell(const ThinnedBin& bin, std::size_t n, Points& to) {
    to.x.push_back(bin.x[n]);
    to.y.push_back(bin.y[n]);
    to.z.push_back(bin.z[n]);
    if (bin.red.empty()) return;
    to.red.push_back(bin.red[n]);
    to.green.push_back(bin.green[n]);
    to.blue.push_back(bin.blue[n]);
}

// The largest size that divides bin_edge_m and is not above `cell_m`.
double dividing_cell(double cell_m);

// Thins a bin and writes it to `folder`. Holds the cells, and a portion of the points at a time.
void thin_bin(const SpilledPoints& points, std::size_t bin, double cell_m,
              const std::filesystem::path& folder);

// The file that comes last: where it is in the folder, the bin is done.
std::string thinned_name(const Bin& bin);
// All files of the bin whose file thinned_name() names so; none where it names none.
std::vector<std::string> files_of_thinned(const std::string& name);
ThinnedBin read_thinned(const std::filesystem::path& folder, const Bin& bin);

// A bin's cells by number: cell (x, y, z) of it is (x * side + y) * side + z.
class BinGrid {
  public:
    BinGrid(const Bin& bin, double cell_m)
        : side(static_cast<std::uint64_t>(std::llround(bin_edge_m / cell_m))),
          low_{bin[0] * bin_edge_m, bin[1] * bin_edge_m, bin[2] * bin_edge_m},
          cell_m_(cell_m) {}
    const std::uint64_t side;  // cells along an edge
    // Relative to the bin's lowest corner, so that means keep the floats' accuracy; and back.
    Vec3 inside(const Point& p) const { return {p.x - low_[0], p.y - low_[1], p.z - low_[2]}; }
    float outside(double inside, std::size_t axis) const {
        return static_cast<float>(low_[axis] + inside);
    }
    std::uint64_t cell_at(const Vec3& inside) const {
        std::uint64_t cell = 0;
        for (const double c : inside) {
            const auto last = static_cast<std::int64_t>(side) - 1;
            cell = cell * side + static_cast<std::uint64_t>(std::clamp<std::int64_t>(
                                     static_cast<std::int64_t>(std::floor(c / cell_m_)), 0, last));
        }
        return cell;
    }

  private:
    Vec3 low_;
    double cell_m_;
};

// Which of a thinned bin's cells a point is in.
class CellsOfPoints {
  public:
    CellsOfPoints(const std::filesystem::path& folder, const Bin& bin, double cell_m);
    // None: the bin was thinned without this point.
    std::optional<std::uint32_t> find(const Point& point) const;
    std::size_t size() const { return in_slab_.size(); }

  private:
    BinGrid grid_;
    // Cells by x, and of each of these slabs the rest of their numbers, ascending.
    std::vector<std::uint32_t> slab_, in_slab_;
};

}  // namespace topple::tiles

// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/colour_space.h"
#include "scale/binary_file.h"
#include "topple/input.h"

// Clouds larger than memory: sorted into cubes on disk, thinned there to one point a cell, and
// taken up again block by block.
namespace topple::tiles {

// A cube of the input's frame: bin (x, y, z) spans [x, x + 1] * bin_edge_m per axis.
using Bin = std::array<std::int32_t, 3>;

// About the size of a room: a bin's points fit into memory, and a building has few of them.
inline constexpr double bin_edge_m = 5;

inline Bin bin_of(float x, float y, float z) {
    return {static_cast<std::int32_t>(std::floor(x / bin_edge_m)),
            static_cast<std::int32_t>(std::floor(y / bin_edge_m)),
            static_cast<std::int32_t>(std::floor(z / bin_edge_m))};
}

// Points in the input's frame, metres.
struct Point {
    float x = 0, y = 0, z = 0;
};

// Is there once all points are sorted.
inline constexpr const char* bins_name = "bins.bin";

// A cloud on disk, sorted into bins. Within a bin the points keep their order.
class SpilledPoints {
  public:
    struct Portion {
        std::uint64_t before = 0, points = 0;   // points of other portions before it in the file
        std::uint64_t sum = 0, colour_sum = 0;  // checksums
    };
    struct BinPoints {
        Bin bin{};
        std::uint64_t points = 0;
        std::vector<Portion> portions;
    };

    // Opens what a PointSpill wrote. Throws Error(input) naming the file where it is damaged.
    explicit SpilledPoints(const std::filesystem::path& folder);

    const std::vector<BinPoints>& bins() const { return bins_; }  // ascending
    std::uint64_t points() const { return points_; }
    std::uint64_t dropped() const { return dropped_; }  // points that were not finite
    const Vec3& offset_m() const { return offset_m_; }  // see PointCloud

    bool coloured() const { return coloured_; }  // some point's colour is known

    // Calls use(points, colours) for the bin's portions in order, without colours where the cloud
    // has none. Throws Error(input) naming the file where one is not what was written.
    using Use = std::function<void(std::span<const Point>, std::span<const Rgb8>)>;
    void read(std::size_t bin, const Use& use) const;

  private:
    std::filesystem::path file_, colour_file_;
    std::vector<BinPoints> bins_;
    bool coloured_ = false;
    std::uint64_t points_ = 0, dropped_ = 0;
    Vec3 offset_m_{};
};

// Writes points into `folder` as they come, sorted into bins: points.bin, colours.bin with those of
// the same points where the first have any, and bins_name when all are in.
class PointSpill {
  public:
    // Holds at most about `buffer_bytes` of points.
    PointSpill(const std::filesystem::path& folder, std::uint64_t buffer_bytes);

    // Throws Error(input) naming `source` where the points lie in more bins than a building has.
    void add(const PointCloud& portion, const std::string& source);
    void finish(const Vec3& offset_m = {});
    std::uint64_t points() const { return points_; }

  private:
    struct Open {
        SpilledPoints::BinPoints written;
        std::vector<Point> buffer;
        std::vector<Rgb8> colours;
    };
    void flush(Open& bin);

    std::filesystem::path folder_;
    PortionWriter writer_;
    std::unique_ptr<PortionWriter> colour_writer_;
    bool any_colour_ = false;
    std::vector<Open> bins_;
    std::unordered_map<std::uint64_t, std::size_t> place_;
    std::uint64_t buffer_bytes_, buffered_ = 0, written_ = 0, points_ = 0, dropped_ = 0;
};

}  // namespace topple::tiles

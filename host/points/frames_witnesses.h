// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/thread_pool.h"
#include "topple/cloud_view.h"

namespace topple::geometry {

// Points that frames were fused to: where they are, and the standard deviation of the best reading
// that made each; metres.
struct FusedPoints {
    std::vector<float> x, y, z, sigma;
    std::size_t size() const { return x.size(); }
};

// What a sequence of depth frames says about the points fused from it. A far reading is centimetres
// off, and not by chance alone: depths are bent by the sensor, and poses drift. So a wall comes
// with copies of itself before and behind it, which nearer frames look through, or stop short of.
class Witnesses {
  public:
    explicit Witnesses(const Intrinsics& intrinsics);

    // At most so many frames, spread evenly over the sequence, are kept.
    static constexpr std::size_t most_frames = 96;
    void add(const DepthFrame& frame);

    // One flag per point: whether the readings that deny it outweigh, by their inverse variances,
    // those that confirm it.
    std::vector<std::uint8_t> deny(const FusedPoints& points, ThreadPool& pool) const;

  private:
    // Of a pixel and its eight neighbours in the grid that is kept; as stored in the frame, 0 where
    // there is no reading, or, of the bounds, where one of the nine has none.
    struct Pixel {
        std::uint16_t depth = 0, least = 0, greatest = 0;
    };
    struct Frame {
        std::array<float, 16> camera_to_world{};
        std::vector<Pixel> pixels;
    };
    // Of points: sums of inverse variances.
    struct Votes {
        std::vector<float> confirm, deny;
    };
    Frame keep(const DepthFrame& frame) const;
    // Of a run of points: their depths in a frame, the pixels that they lie in, -1 for those out of
    // its view, and what these hold, 0 there.
    struct Projected {
        std::vector<float> depth;
        std::vector<std::int32_t> pixel, stored, least, greatest;
        explicit Projected(std::size_t count)
            : depth(count), pixel(count), stored(count), least(count), greatest(count) {}
    };
    struct Box {
        std::array<double, 3> centre{}, half{};
    };
    static Box box_of(const FusedPoints& points, std::size_t first, std::size_t count);
    // False where no point of the box can lie in the frame's view.
    bool may_see(const Frame& frame, const Box& box) const;
    void project(const Frame& frame, const FusedPoints& points, std::size_t first,
                 std::size_t count, Projected& out) const;
    void vote(const Frame& frame, const FusedPoints& points, std::size_t first, std::size_t count,
              Projected& at, Votes& votes) const;

    std::uint32_t step_, width_, height_;  // pixels of the frames from one kept to the next; counts
    std::uint32_t row_;                    // pixels in a row of the frames
    float fx_, fy_, cx_, cy_;              // pixels kept; row and column are rounded down
    float metres_;                         // per unit of stored depth
    std::size_t stride_ = 1, seen_ = 0;    // frames from one kept to the next; frames added
    std::vector<Frame> frames_;
};

}  // namespace topple::geometry

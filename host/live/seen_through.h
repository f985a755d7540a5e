// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/thread_pool.h"
#include "live/projection.h"
#include "topple/input.h"

namespace topple::live {

// A pixel, the depth that it holds, and how many looks saw through its place: most of the first
// three, and most of the first three of frames that fit this one.
struct GonePixel {
    std::uint32_t u, v;
    std::uint16_t stored;
    std::uint8_t through, through_of_fitting;
    // Of one look, noise and poses may be too far off.
    bool is_sure() const { return through >= 2; }
};
// What is left out with it lies around it, and is about as far away.
inline constexpr double alike_depth_m = 0.05;
using Gone = std::vector<GonePixel>;

// Which others are asked about a frame: [first, last) of those given, the last ones first.
using Asked = std::function<std::pair<std::size_t, std::size_t>(std::size_t frame)>;

// Frames that are asked about one, of those that look the same way.
inline constexpr std::size_t most_asked = 16;
// Whether sensors with these poses do: all that is around is seen whichever way one is turned.
bool look_alike(const Projection& by, const Mat4& a, const Mat4& b);

// Images by one projection that are asked about one another; all must stay.
class Looks {
  public:
    // frames: their depths, by the projection, and poses, sensor to world. earlier: the frames'
    // poses at an earlier time, of those that were there; none: of no frame.
    Looks(const Projection& projection, std::span<const DepthFrame> frames, ThreadPool& threads,
          std::vector<std::optional<Mat4>> earlier = {});
    // Of each frame the pixels that show places which those asked see through: of later ones, what
    // was there has gone since; of earlier ones, it has come. It takes most of the first three
    // looks. `through` depends on the frames and their poses alone, through_of_fitting on the
    // earlier poses, too.
    std::vector<Gone> seen_through(const Asked& asked) const;

  private:
    struct Camera;
    struct Shared {
        double seen = 0, through = 0;
    };
    Shared shared(std::size_t frame, const Camera& camera, std::size_t other,
                  const Camera& from) const;
    bool fit(std::size_t frame, std::size_t other) const;

    Projection projection_;
    std::span<const DepthFrame> frames_;
    ThreadPool& threads_;
    std::vector<std::optional<Mat4>> earlier_;
    // Of each frame, by pixel: the nearest reading of the nine around; 0 where one is missing.
    std::vector<std::vector<std::uint16_t>> nearest_;
};

}  // namespace topple::live

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

// A pixel, the depth that it holds, and how many looks see through its place: most of the first
// three.
struct GonePixel {
    std::uint32_t u, v;
    std::uint16_t stored;
    std::uint8_t through;
    // Of one look, noise and poses may be too far off.
    bool is_sure() const { return through >= 2; }
};
// What is left out with it lies around it, and is about as far away.
inline constexpr double alike_depth_m = 0.05;
using Gone = std::vector<GonePixel>;
// What most of the first three looks of frames that fit say of a place: that it is as it was, that
// they see through it; nothing, too, where they are undecided.
enum class Says : std::uint8_t { nothing, same, through };
// What those asked about a frame say of its image.
struct Looked {
    Gone through;
    std::vector<Says> says;  // by pixel
};

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
    // Of each frame. What later ones see through has gone since; what earlier ones do, has come. It
    // takes most of the first three looks. `through` depends on the frames and their poses alone,
    // what those say that fit on the earlier poses, too.
    std::vector<Looked> look(const Asked& asked) const;

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

// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "report/camera.h"

namespace topple::report {

// What of many triangles is in front, pixel by pixel.
class DepthImage {
  public:
    static constexpr std::uint32_t nothing = UINT32_MAX;

    DepthImage(int width, int height);

    // Draws a triangle of the value `what` where nothing nearer is. Triangles that reach behind the
    // camera are left out. Places in metres.
    void triangle(const Camera& camera, const Vec3& a, const Vec3& b, const Vec3& c,
                  std::uint32_t what);

    int width() const { return width_; }
    int height() const { return height_; }
    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * width_ + x); }
    std::uint32_t what(std::size_t at) const { return what_[at]; }
    double depth(std::size_t at) const { return 1 / double{nearness_[at]}; }  // infinite: nothing

  private:
    int width_, height_;
    std::vector<float> nearness_;  // 1 / depth, which is linear in the picture; 0: nothing
    std::vector<std::uint32_t> what_;
};

}  // namespace topple::report

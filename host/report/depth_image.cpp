// SPDX-License-Identifier: MIT
#include "report/depth_image.h"

#include <algorithm>
#include <cmath>

namespace topple::report {

DepthImage::DepthImage(int width, int height)
    : width_(width),
      height_(height),
      nearness_(index(0, height), 0),
      what_(nearness_.size(), nothing) {}

void DepthImage::triangle(const Camera& camera, const Vec3& a, const Vec3& b, const Vec3& c,
                          std::uint32_t what) {
    constexpr double nearest_m = 1e-3;
    std::array<std::array<double, 3>, 3> p{camera.project(a), camera.project(b), camera.project(c)};
    for (auto& corner : p) {
        if (!(corner[2] > nearest_m)) return;
        corner[2] = 1 / corner[2];
    }
    const double area =
        (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]);
    if (!(std::abs(area) > 1e-12)) return;
    // Nearness is nx * x + ny * y + n0.
    const double nx =
        ((p[1][2] - p[0][2]) * (p[2][1] - p[0][1]) - (p[2][2] - p[0][2]) * (p[1][1] - p[0][1])) /
        area;
    const double ny =
        ((p[2][2] - p[0][2]) * (p[1][0] - p[0][0]) - (p[1][2] - p[0][2]) * (p[2][0] - p[0][0])) /
        area;
    const double n0 = p[0][2] - nx * p[0][0] - ny * p[0][1];
    const auto [top, bottom] = std::minmax({p[0][1], p[1][1], p[2][1]});
    const int first = static_cast<int>(std::ceil(std::clamp(top - 0.5, 0.0, double(height_))));
    const int last = static_cast<int>(std::floor(std::clamp(bottom - 0.5, -1.0, height_ - 1.0)));
    for (int row = first; row <= last; ++row) {
        // Where the row's middle crosses the sides.
        const double y = row + 0.5;
        double from = 1e300, to = -1e300;
        for (std::size_t n = 0; n < 3; ++n) {
            const auto &u = p[n], &v = p[(n + 1) % 3];
            if ((u[1] < y) == (v[1] < y)) continue;
            const double x = u[0] + (v[0] - u[0]) * (y - u[1]) / (v[1] - u[1]);
            from = std::min(from, x);
            to = std::max(to, x);
        }
        const int left = static_cast<int>(std::ceil(std::clamp(from - 0.5, 0.0, double(width_))));
        const int right = static_cast<int>(std::floor(std::clamp(to - 0.5, -1.0, width_ - 1.0)));
        for (int column = left; column <= right; ++column) {
            const auto nearness = static_cast<float>(nx * (column + 0.5) + ny * y + n0);
            const std::size_t at = index(column, row);
            if (nearness <= nearness_[at]) continue;
            nearness_[at] = nearness;
            what_[at] = what;
        }
    }
}

}  // namespace topple::report

// SPDX-License-Identifier: MIT
#include "geometry/surfel_views.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace topple::geometry {
namespace {

// Nearer than this a surfel fills the view and tells nothing.
constexpr double nearest_cells = 1.5;

// One image while it is drawn.
class Image {
  public:
    Image(const Surfels& surfels, std::span<const float> radii_m, const Vec3& eye,
          std::size_t image)
        : s_(surfels), radii_(radii_m), eye_(eye), f_(image / 2), sign_(image % 2 == 0 ? 1 : -1) {
        depth.assign(std::size_t{CubeView::side} * CubeView::side,
                     std::numeric_limits<float>::infinity());
        surfel.assign(depth.size(), CubeView::nothing);
    }

    void draw(std::size_t i) {
        // In the image's axes: right, down, forward.
        const Vec3 p = turned({s_.x[i] - eye_[0], s_.y[i] - eye_[1], s_.z[i] - eye_[2]});
        const double radius = radii_[i], near = nearest_cells * s_.cell_m;
        if (!(p[2] > near) || std::abs(p[0]) > p[2] + 2 * radius ||
            std::abs(p[1]) > p[2] + 2 * radius) {
            return;
        }
        const Vec3 n = turned({s_.nx[i], s_.ny[i], s_.nz[i]});
        const bool plane = n[0] != 0 || n[1] != 0 || n[2] != 0;
        const double offset = n[0] * p[0] + n[1] * p[1] + n[2] * p[2];
        const double half = CubeView::focal * radius / (p[2] - radius);
        const double u = CubeView::focal * p[0] / p[2] + CubeView::centre;
        const double v = CubeView::focal * p[1] / p[2] + CubeView::centre;
        const auto [u0, u1] = span(u, half);
        const auto [v0, v1] = span(v, half);
        for (int y = v0; y <= v1; ++y) {
            const double ry = (y - CubeView::centre) / CubeView::focal;
            for (int x = u0; x <= u1; ++x) {
                const double rx = (x - CubeView::centre) / CubeView::focal;
                const double along = n[0] * rx + n[1] * ry + n[2];
                const double z = plane ? offset / along : p[2];
                const double dx = z * rx - p[0], dy = z * ry - p[1], dz = z - p[2];
                // Seen edge-on, a disc has no width: z is not finite, or far off.
                if (!(dx * dx + dy * dy + dz * dz <= radius * radius)) continue;
                const auto at =
                    static_cast<std::size_t>(y) * CubeView::side + static_cast<std::size_t>(x);
                if (static_cast<float>(z) < depth[at]) {
                    depth[at] = static_cast<float>(z);
                    surfel[at] = static_cast<std::uint32_t>(i);
                }
            }
        }
    }

    std::vector<float> depth;
    std::vector<std::uint32_t> surfel;

  private:
    Vec3 turned(const Vec3& d) const {
        return {sign_ * d[(f_ + 1) % 3], d[(f_ + 2) % 3], sign_ * d[f_]};
    }
    static std::array<int, 2> span(double middle, double half) {
        const auto clip = [](double value) {
            return static_cast<int>(std::clamp(value, -1.0, double{CubeView::side}));
        };
        return {std::max(clip(std::ceil(middle - half)), 0),
                std::min(clip(std::floor(middle + half)), static_cast<int>(CubeView::side) - 1)};
    }

    const Surfels& s_;
    std::span<const float> radii_;
    Vec3 eye_;
    std::size_t f_;
    double sign_;
};

}  // namespace

CubeView::Pixel CubeView::pixel_of(std::size_t image, const Vec3& point) const {
    const std::size_t f = image / 2;
    const double sign = image % 2 == 0 ? 1 : -1;
    Pixel out;
    out.depth = sign * (point[f] - eye[f]);
    if (!(out.depth > 0)) return out;
    const double u =
        std::round(focal * sign * (point[(f + 1) % 3] - eye[(f + 1) % 3]) / out.depth + centre);
    const double v =
        std::round(focal * (point[(f + 2) % 3] - eye[(f + 2) % 3]) / out.depth + centre);
    out.inside = u >= 0 && v >= 0 && u < side && v < side;
    if (out.inside) out.index = static_cast<std::size_t>(v) * side + static_cast<std::size_t>(u);
    return out;
}

std::size_t CubeView::image_of(const Vec3& point) const {
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a) {
        if (std::abs(point[a] - eye[a]) > std::abs(point[axis] - eye[axis])) axis = a;
    }
    return 2 * axis + (point[axis] < eye[axis]);
}

Mat4 CubeView::pose(std::size_t image) const {
    const std::size_t f = image / 2;
    const double sign = image % 2 == 0 ? 1 : -1;
    Mat4 m{};
    m[4 * ((f + 1) % 3)] = sign;
    m[4 * ((f + 2) % 3) + 1] = 1;
    m[4 * f + 2] = sign;
    m[3] = eye[0];
    m[7] = eye[1];
    m[11] = eye[2];
    m[15] = 1;
    return m;
}

CubeView view_surfels(const Surfels& surfels, std::span<const float> radii_m, const Vec3& eye,
                      ThreadPool& pool) {
    CubeView view;
    view.eye = eye;
    pool.run(6, 1, [&](std::uint64_t first, std::uint64_t last) {
        for (std::uint64_t k = first; k < last; ++k) {
            Image image(surfels, radii_m, eye, static_cast<std::size_t>(k));
            for (std::size_t i = 0; i < surfels.size(); ++i) image.draw(i);
            view.depth[k] = std::move(image.depth);
            view.surfel[k] = std::move(image.surfel);
        }
    });
    return view;
}

}  // namespace topple::geometry

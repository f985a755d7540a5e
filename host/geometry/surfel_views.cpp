// SPDX-License-Identifier: MIT
#include "geometry/surfel_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace topple::geometry {
namespace {

// Nearer than this a surfel fills the view and tells nothing.
constexpr double nearest_cells = 1.5;

// Pixels side by side are drawn at once, without branches: which of them a disc covers is no more
// to be foreseen than which of two discs is the nearer.
constexpr int lanes = 4;
using Lanes [[gnu::vector_size(lanes * sizeof(double))]] = double;
using Depths [[gnu::vector_size(lanes * sizeof(float))]] = float;
using Marks [[gnu::vector_size(lanes * sizeof(std::int32_t))]] = std::int32_t;
constexpr std::size_t beyond = lanes - 1;  // elements after the last that are read with it

// How far the rays of the pixels of a row, or of a column, go aside for each metre along the axis.
constexpr auto slopes = [] {
    std::array<double, CubeView::side + beyond> of{};
    for (std::uint32_t x = 0; x < of.size(); ++x) of[x] = (x - CubeView::centre) / CubeView::focal;
    return of;
}();

// One image while it is drawn.
class Image {
  public:
    Image(const Surfels& surfels, std::span<const float> radii_m, const Vec3& eye,
          std::size_t image)
        : s_(surfels), radii_(radii_m), eye_(eye), f_(image / 2), sign_(image % 2 == 0 ? 1 : -1) {
        depth.assign(pixels + beyond, std::numeric_limits<float>::infinity());
        surfel.assign(pixels + beyond, CubeView::nothing);
    }

    // Those that may be in the image, in their order.
    void draw_all() {
        constexpr std::size_t at_once = 1024;
        std::array<std::uint32_t, at_once> within{};
        for (std::size_t first = 0; first < s_.size(); first += at_once) {
            const std::size_t last = std::min(first + at_once, s_.size());
            std::size_t count = 0;
            for (std::size_t i = first; i < last; ++i) {
                within[count] = static_cast<std::uint32_t>(i);
                count += may_show(place(i), radii_[i]);
            }
            for (std::size_t n = 0; n < count; ++n) draw(within[n]);
        }
        depth.resize(pixels);
        surfel.resize(pixels);
    }

    std::vector<float> depth;
    std::vector<std::uint32_t> surfel;

  private:
    static constexpr std::size_t pixels = std::size_t{CubeView::side} * CubeView::side;

    // In the image's axes: right, down, forward.
    Vec3 place(std::size_t i) const {
        return turned({s_.x[i] - eye_[0], s_.y[i] - eye_[1], s_.z[i] - eye_[2]});
    }
    bool may_show(const Vec3& p, double radius) const {
        return bool(int{p[2] > nearest_cells * s_.cell_m} &
                    int{!(std::abs(p[0]) > p[2] + 2 * radius)} &
                    int{!(std::abs(p[1]) > p[2] + 2 * radius)});
    }

    void draw(std::uint32_t i) {
        const Vec3 p = place(i);
        const double radius = radii_[i];
        Vec3 n = turned({s_.nx[i], s_.ny[i], s_.nz[i]});
        const double half = CubeView::focal * radius / (p[2] - radius);
        Span columns = span(pixel(p[0], p[2]), half), rows = span(pixel(p[1], p[2]), half);
        if (n == Vec3{}) {
            n = {0, 0, 1};
        } else if (p[2] > 1.001 * radius) {
            tighten(p, n, radius, columns, rows);
        }
        fill(i, p, n, radius, columns, rows);
    }

    Vec3 turned(const Vec3& d) const {
        return {sign_ * d[(f_ + 1) % 3], d[(f_ + 2) % 3], sign_ * d[f_]};
    }
    // Pixels from the first to the last.
    struct Span {
        int first = 0, last = 0;
    };
    static double pixel(double aside, double ahead) {
        return CubeView::focal * aside / ahead + CubeView::centre;
    }
    static Span between(double low, double high) {
        const auto clip = [](double value) {
            return static_cast<int>(std::clamp(value, -1.0, double{CubeView::side}));
        };
        return {std::max(clip(std::ceil(low)), 0),
                std::min(clip(std::floor(high)), static_cast<int>(CubeView::side) - 1)};
    }
    static Span span(double middle, double half) { return between(middle - half, middle + half); }

    // Leaves out pixels that look past the box around a disc, which is as flat as that is. Wider
    // than all that rounding does.
    static void tighten(const Vec3& p, const Vec3& n, double radius, Span& columns, Span& rows) {
        const double square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        Vec3 reach{};
        for (std::size_t a = 0; a < 3; ++a)
            reach[a] = radius * (std::sqrt(std::max(0.0, 1 - n[a] * n[a] / square)) + 1e-6);
        const double front = p[2] - reach[2], back = p[2] + reach[2];
        const auto narrow = [&](std::size_t a, Span& to) {
            const double low = p[a] - reach[a], high = p[a] + reach[a];
            const Span box =
                between(pixel(low, low > 0 ? back : front), pixel(high, high > 0 ? front : back));
            to = {std::max(to.first, box.first), std::min(to.last, box.last)};
        };
        narrow(0, columns);
        narrow(1, rows);
    }

    // Pixels whose rays meet the disc nearer than all discs before it.
    void fill(std::uint32_t i, const Vec3& p, const Vec3& n, double radius, const Span& columns,
              const Span& rows) {
        const double offset = n[0] * p[0] + n[1] * p[1] + n[2] * p[2], most = radius * radius;
        constexpr Marks places{0, 1, 2, 3};
        for (int y = rows.first; y <= rows.last; ++y) {
            const double ry = slopes[static_cast<std::size_t>(y)], n_down = n[1] * ry;
            for (int x = columns.first; x <= columns.last; x += lanes) {
                const auto column = static_cast<std::size_t>(x),
                           at = static_cast<std::size_t>(y) * CubeView::side + column;
                Lanes rx;
                Depths there;
                Marks before;
                std::memcpy(&rx, &slopes[column], sizeof(rx));
                std::memcpy(&there, &depth[at], sizeof(there));
                std::memcpy(&before, &surfel[at], sizeof(before));
                const Lanes z = offset / (n[0] * rx + n_down + n[2]);
                const Lanes dx = z * rx - p[0], dy = z * ry - p[1], dz = z - p[2];
                // Seen edge-on, a disc has no width: z is not finite, or far off.
                const auto meets = dx * dx + dy * dy + dz * dz <= most;
                const auto here = __builtin_convertvector(z, Depths);
                const Marks nearer = __builtin_convertvector(meets, Marks) & (here < there) &
                                     (places <= columns.last - x);
                const Depths nearest = nearer ? here : there;
                const Marks shown = nearer ? static_cast<std::int32_t>(i) + Marks{} : before;
                std::memcpy(&depth[at], &nearest, sizeof(nearest));
                std::memcpy(&surfel[at], &shown, sizeof(shown));
            }
        }
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
    const double u = focal * sign * (point[(f + 1) % 3] - eye[(f + 1) % 3]) / out.depth + centre;
    const double v = focal * (point[(f + 2) % 3] - eye[(f + 2) % 3]) / out.depth + centre;
    constexpr double rim = 0.5, far_rim = side - 0.5;
    out.inside = u > -rim && v > -rim && u < far_rim && v < far_rim;
    if (out.inside) out.index = std::size_t{nearest_index(v)} * side + nearest_index(u);
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
            image.draw_all();
            view.depth[k] = std::move(image.depth);
            view.surfel[k] = std::move(image.surfel);
        }
    });
    return view;
}

}  // namespace topple::geometry

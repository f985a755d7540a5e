// SPDX-License-Identifier: MIT
#include "geometry/surfel_views.h"

#include <algorithm>
#include <bit>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/vectors.h"

namespace topple::geometry {
namespace {

// Nearer than this a surfel fills the view and tells nothing.
constexpr double nearest_cells = 1.5;

// A disc around p, with unit normal n, before an eye at the origin. The ray (x, y, 1) meets its
// plane at z (x, y, 1), z = n.p / (n1 x + n2 y + n3), and the disc where that lies within the
// radius of p. Times the denominator's square this is a quadratic in x.
class Disc {
  public:
    Disc(const Vec3& n, const Vec3& p, double radius)
        : n_(n), p_(p), offset_(dot(n, p)), beyond_(dot(p, p) - radius * radius) {}

    double offset() const { return offset_; }

    struct Rays {
        double first, last;
    };
    // What is kept of it: p with normal . p >= least.
    struct Cut {
        Vec3 normal{};
        double least = 0;
    };
    // Seen edge-on it has no width, of which rounding leaves anything.
    bool edge_on() const { return std::abs(offset_) <= 1e-6 * length(p_); }
    // The x of the rays with this y that meet the disc, all of which lies ahead of the eye.
    std::optional<Rays> along_row(double y) const {
        const double row = n_[1] * y + n_[2], ahead = p_[1] * y + p_[2];
        const double a = offset_ * (offset_ - 2 * n_[0] * p_[0]) + n_[0] * n_[0] * beyond_;
        const double b = n_[0] * row * beyond_ - offset_ * (n_[0] * ahead + row * p_[0]);
        const double c = offset_ * (offset_ * (y * y + 1) - 2 * row * ahead) + row * row * beyond_;
        const double square = b * b - a * c;
        if (!(square >= 0)) return std::nullopt;
        const double root = std::sqrt(square), middle = -b / a, to_side = root / a;
        return Rays{middle - to_side, middle + to_side};
    }
    // Leaves of the rays with this y those that meet its plane in what is kept: normal . z ray >=
    // least, z = offset / (n . ray), of which both have one sign ahead of the eye.
    void clip(const Cut& cut, double y, Rays& rays) const {
        const Vec3& m = cut.normal;
        const double sign = offset_ < 0 ? -1 : 1;
        const double slope = sign * (offset_ * m[0] - cut.least * n_[0]);
        const double at_0 = sign * (offset_ * (m[1] * y + m[2]) - cut.least * (n_[1] * y + n_[2]));
        if (slope > 0) rays.first = std::max(rays.first, -at_0 / slope);
        if (slope < 0) rays.last = std::min(rays.last, -at_0 / slope);
        if (slope == 0 && at_0 < 0) rays.last = rays.first - 1;
    }

  private:
    Vec3 n_, p_;
    double offset_, beyond_;
};

// One image while it is drawn.
class Image {
  public:
    Image(const Surfels& surfels, std::span<const float> radii_m, std::span<const DiscCuts> cuts,
          const Vec3& eye, std::size_t image)
        : s_(surfels),
          radii_(radii_m),
          cuts_(cuts),
          eye_(eye),
          near_(nearest_cells * surfels.cell_m),
          f_(image / 2),
          sign_(image % 2 == 0 ? 1 : -1) {
        nearest_.assign(std::size_t{CubeView::side} * CubeView::side,
                        nearness(std::numeric_limits<float>::infinity()) << 32 | CubeView::nothing);
    }

    // Whether any of a patch may be in the image, and be drawn.
    bool may_show(const SurfelViews::Patch& patch) const {
        const Vec3 low = turned(minus(patch.low, eye_)), high = turned(minus(patch.high, eye_));
        const double deep = std::max(low[2], high[2]), most = deep + 2 * patch.largest_radius;
        if (!(deep > near_)) return false;
        for (const std::size_t a : {0, 1})
            if (std::min(low[a], high[a]) > most || std::max(low[a], high[a]) < -most) return false;
        return true;
    }

    void draw(std::size_t i) {
        // In the image's axes: right, down, forward.
        const Vec3 p = turned({s_.x[i] - eye_[0], s_.y[i] - eye_[1], s_.z[i] - eye_[2]});
        const double radius = radii_[i];
        if (!(p[2] > std::max(near_, radius)) || std::abs(p[0]) > p[2] + 2 * radius ||
            std::abs(p[1]) > p[2] + 2 * radius) {
            return;
        }
        Vec3 n = turned({s_.nx[i], s_.ny[i], s_.nz[i]});
        if (n == Vec3{}) n = {0, 0, 1};
        const double half = CubeView::focal * radius / (p[2] - radius);
        const double scale = CubeView::focal / p[2];
        const double u = scale * p[0] + CubeView::centre, v = scale * p[1] + CubeView::centre;
        const Span columns = span(u - half, u + half), rows = span(v - half, v + half);
        const Disc disc(n, p, radius);
        if (columns.first > columns.last || disc.edge_on()) return;
        const auto cuts = cuts_of(i);
        for (int y = rows.first; y <= rows.last; ++y) {
            const double ry = ray(y);
            auto seen = disc.along_row(ry);
            if (!seen) continue;
            for (const Disc::Cut& cut : cuts) disc.clip(cut, ry, *seen);
            const Span row = span(pixel(seen->first), pixel(seen->last));
            fill(row, y, n[1] * ry + n[2], n[0], disc.offset(), static_cast<std::uint32_t>(i));
        }
    }

    void finish(std::vector<float>& depth, std::vector<std::uint32_t>& surfel) const {
        depth.resize(nearest_.size());
        surfel.resize(nearest_.size());
        for (std::size_t at = 0; at < nearest_.size(); ++at) {
            depth[at] = std::bit_cast<float>(static_cast<std::uint32_t>(nearest_[at] >> 32));
            surfel[at] = static_cast<std::uint32_t>(nearest_[at]);
        }
    }

  private:
    // Numbers that ascend with positive depths; those of all others are higher.
    static std::uint64_t nearness(float depth) { return std::bit_cast<std::uint32_t>(depth); }
    Vec3 turned(const Vec3& d) const {
        return {sign_ * d[(f_ + 1) % 3], d[(f_ + 2) % 3], sign_ * d[f_]};
    }
    struct Span {
        int first, last;
    };
    // The pixels from low to high.
    static Span span(double low, double high) {
        const auto clip = [](double value) {
            return std::clamp(value, -1.0, double{CubeView::side});
        };
        const double from = clip(low), to = clip(high);
        const int first = static_cast<int>(from), last = static_cast<int>(to);
        return {std::max(first + (first < from), 0),
                std::min(last - (last > to), static_cast<int>(CubeView::side) - 1)};
    }
    // Between a column or row and the slope of its ray.
    static double ray(int pixel) { return (pixel - CubeView::centre) / CubeView::focal; }
    static double pixel(double ray) { return CubeView::focal * ray + CubeView::centre; }

    // Of a surfel's disc, in the image's axes and from the eye.
    boost::container::static_vector<Disc::Cut, 2> cuts_of(std::size_t i) const {
        boost::container::static_vector<Disc::Cut, 2> out;
        for (const DiscCut& cut : cuts_[i]) {
            if (cut.normal == std::array<float, 3>{}) continue;
            const Vec3 normal{cut.normal[0], cut.normal[1], cut.normal[2]};
            out.push_back({turned(normal), cut.least - dot(normal, eye_)});
        }
        return out;
    }

    // Columns of a row, where the surfel's plane lies at offset / (row + across * ray).
    void fill(const Span& columns, int y, double row, double across, double offset,
              std::uint32_t i) {
        std::uint64_t* const nearest = &nearest_[static_cast<std::size_t>(y) * CubeView::side];
        const double per_column = across / CubeView::focal;
        const double from = row - CubeView::centre * per_column;
        const auto ahead = static_cast<float>(offset);
        for (int x = columns.first; x <= columns.last; ++x) {
            const float z = ahead / static_cast<float>(from + per_column * x);
            nearest[x] = std::min(nearest[x], nearness(z) << 32 | i);
        }
    }

    const Surfels& s_;
    std::span<const float> radii_;
    std::span<const DiscCuts> cuts_;
    Vec3 eye_;
    double near_;
    std::size_t f_;
    double sign_;
    // Of each pixel the nearness of what is nearest, and below it the surfel, of several the first:
    // which of two is nearer no branch foretells.
    std::vector<std::uint64_t> nearest_;
};

}  // namespace

CubeView::Pixel CubeView::pixel_of(std::size_t image, const Vec3& point) const {
    const std::size_t f = image / 2;
    const double sign = image % 2 == 0 ? 1 : -1;
    Pixel out;
    out.depth = sign * (point[f] - eye[f]);
    if (!(out.depth > 0)) return out;
    const double scale = focal / out.depth, to_nearest = centre + 0.5;
    const double u = scale * sign * (point[(f + 1) % 3] - eye[(f + 1) % 3]) + to_nearest;
    const double v = scale * (point[(f + 2) % 3] - eye[(f + 2) % 3]) + to_nearest;
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

SurfelViews::SurfelViews(const Surfels& surfels, std::vector<float> radii_m, ThreadPool& pool)
    : s_(surfels),
      radii_(std::move(radii_m)),
      cuts_(cuts_at_edges(surfels, radii_, pool)),
      pool_(pool) {
    for (std::size_t first = 0; first < s_.size(); first += patch_size) {
        constexpr double infinite = std::numeric_limits<double>::infinity();
        Patch patch{{infinite, infinite, infinite}, {-infinite, -infinite, -infinite}, 0};
        for (std::size_t i = first; i < std::min(first + patch_size, s_.size()); ++i) {
            const Vec3 at{s_.x[i], s_.y[i], s_.z[i]};
            for (std::size_t a = 0; a < 3; ++a) {
                patch.low[a] = std::min(patch.low[a], at[a]);
                patch.high[a] = std::max(patch.high[a], at[a]);
            }
            patch.largest_radius = std::max(patch.largest_radius, double{radii_[i]});
        }
        patches_.push_back(patch);
    }
}

CubeView SurfelViews::from(const Vec3& eye) const {
    CubeView view;
    view.eye = eye;
    pool_.each(6, 1, [&](std::size_t k) {
        Image image(s_, radii_, cuts_, eye, k);
        for (std::size_t p = 0; p < patches_.size(); ++p) {
            if (!image.may_show(patches_[p])) continue;
            const std::size_t first = p * patch_size;
            for (std::size_t i = first; i < std::min(first + patch_size, s_.size()); ++i)
                image.draw(i);
        }
        image.finish(view.depth[k], view.surfel[k]);
    });
    return view;
}

}  // namespace topple::geometry

// SPDX-License-Identifier: MIT
#include "solids/cell_shape.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "core/ranked.h"

namespace topple::solids {
namespace {

constexpr double slack = 1e-6;     // of a voxel: of what is computed
constexpr double on_patch = 1e-3;  // what lies so close to a patch as it was fitted is on it

double bend(const SurfacePatch& patch) {
    double most = 0;
    for (std::size_t n = 4; n < patch.c.size(); ++n)
        most = std::max(most, (n < 7 ? 2 : 1) * std::abs(patch.c[n]));
    return most;
}

// A part of a voxel, and the patches that pass it.
class Part {
  public:
    Part(const BoundaryCells& b, std::size_t n, double voxel_m, const Vec3& low, double edge,
         std::vector<Vec3>& out)
        : b_(b), n_(n), slack_(slack * voxel_m), low_(low), edge_(edge), out_(out) {
        const Vec3 middle{low[0] + edge / 2, low[1] + edge / 2, low[2] + edge / 2};
        for (std::size_t s = 0; s < b.slots_used(n); ++s) {
            const SurfacePatch& patch = b.patches[b.slot[s][n]];
            // The cube's half diagonal, and as much again for what is curved.
            if (std::abs(patch.distance(middle)) < (patch.flat() ? 0.87 : 1.3) * edge)
                patches_.push_back(&patch);
        }
    }

    void add_corners() {
        for (unsigned c = 0; c < 8; ++c) keep(at(c & 1, c >> 1 & 1, c >> 2));
        for (std::size_t p = 0; p < patches_.size(); ++p) {
            add_edges(*patches_[p]);
            for (std::size_t q = p + 1; q < patches_.size(); ++q) {
                add_sides(*patches_[p], *patches_[q]);
                for (std::size_t r = q + 1; r < patches_.size(); ++r)
                    add_meeting(*patches_[p], *patches_[q], *patches_[r]);
            }
        }
    }
    bool passed() const { return !patches_.empty(); }

  private:
    Vec3 at(double u, double v, double w) const {
        return {low_[0] + u * edge_, low_[1] + v * edge_, low_[2] + w * edge_};
    }
    bool within(const Vec3& p) const {
        for (std::size_t a = 0; a < 3; ++a)
            if (!(p[a] >= low_[a] - slack_ && p[a] <= low_[a] + edge_ + slack_)) return false;
        return true;
    }
    // Where planes meet is known but for rounding after one round: no more of them lead back.
    bool beyond(const Vec3& p) const {
        const double rounding = 1e-6 * edge_ + slack_;
        for (std::size_t a = 0; a < 3; ++a)
            if (p[a] < low_[a] - rounding || p[a] > low_[a] + edge_ + rounding) return true;
        return false;
    }
    void keep(const Vec3& p) {
        if (b_.solid(n_, p, slack_)) out_.push_back(p);
    }

    // Along an edge a patch's value is a polynomial of degree two.
    void add_edges(const SurfacePatch& patch) {
        std::array<double, 8> value{};  // at the corners
        for (unsigned c = 0; c < 8; ++c) value[c] = patch.value(at(c & 1, c >> 1 & 1, c >> 2));
        Vec3 bent{};
        for (std::size_t a = 0; a < 3; ++a) bent[a] = std::abs(patch.c[4 + a]) * edge_ * edge_;
        for (unsigned axis = 0; axis < 3; ++axis) {
            const unsigned u = (axis + 1) % 3, v = (axis + 2) % 3;
            for (unsigned c = 0; c < 4; ++c) {
                const unsigned first = (c & 1) << u | (c >> 1) << v;
                const double f0 = value[first], f1 = value[first | 1U << axis];
                // Most edges lie to one side: between its ends a patch's value is off the straight
                // line by a quarter of the second difference at most.
                if (f0 * f1 > 0 && std::min(std::abs(f0), std::abs(f1)) >
                                       2 * slack * std::abs(f1 - f0) + 0.5 * bent[axis])
                    continue;
                Vec3 from = low_;
                from[u] += (c & 1) * edge_;
                from[v] += (c >> 1) * edge_;
                Vec3 half = from;
                half[axis] += edge_ / 2;
                const double fh = patch.value(half);
                const double a = 2 * (f0 + f1 - 2 * fh), b = f1 - f0 - a;
                each_root(a, b, f0, [&](double t) {
                    if (!(t >= -slack && t <= 1 + slack)) return;
                    Vec3 p = from;
                    p[axis] += t * edge_;
                    keep(p);
                });
            }
        }
    }
    template <class Visit>
    static void each_root(double a, double b, double c, const Visit& visit) {
        if (std::abs(a) < 1e-9 * std::abs(b)) {
            if (b != 0) visit(-c / b);
            return;
        }
        const double root = b * b - 4 * a * c;
        if (a == 0 || root < 0) return;
        const double q = -0.5 * (b + std::copysign(std::sqrt(root), b));
        visit(q / a);
        if (q != 0) visit(c / q);
    }

    // Whether a patch passes no point of the side around `middle` along axes u and v: by its Taylor
    // series, and a hundredth of the side for what lies on its rim.
    bool passes_by(const SurfacePatch& patch, const Vec3& middle, std::size_t u,
                   std::size_t v) const {
        const Vec3 g = patch.gradient(middle);
        const double reach = 0.51 * (std::abs(g[u]) + std::abs(g[v])) + bend(patch) * edge_ + 0.01;
        return std::abs(patch.value(middle)) > reach * edge_;
    }
    // Newton's method from the middle of a side, within its plane.
    void add_sides(const SurfacePatch& p, const SurfacePatch& q) {
        const bool flat = p.flat() && q.flat();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const double end : {0.0, 1.0}) {
                Vec3 x = at(0.5, 0.5, 0.5);
                x[axis] = low_[axis] + end * edge_;
                const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
                if (passes_by(p, x, u, v) || passes_by(q, x, u, v)) continue;
                for (int round = 0; round < 4; ++round) {
                    const Vec3 before = x;
                    const Vec3 gp = p.gradient(x), gq = q.gradient(x);
                    const double det = gp[u] * gq[v] - gp[v] * gq[u];
                    if (std::abs(det) < 1e-3) break;
                    const double fp = p.value(x), fq = q.value(x);
                    x[u] -= (fp * gq[v] - fq * gp[v]) / det;
                    x[v] -= (gp[u] * fq - gq[u] * fp) / det;
                    if (x == before || (flat && beyond(x))) break;
                }
                settle({&p, &q}, x);
            }
        }
    }
    void add_meeting(const SurfacePatch& p, const SurfacePatch& q, const SurfacePatch& r) {
        const bool flat = p.flat() && q.flat() && r.flat();
        Vec3 x = at(0.5, 0.5, 0.5);
        for (int round = 0; round < 4; ++round) {
            Eigen::Matrix3d g;
            Eigen::Vector3d f;
            int row = 0;
            for (const SurfacePatch* patch : {&p, &q, &r}) {
                const Vec3 gradient = patch->gradient(x);
                g.row(row) << gradient[0], gradient[1], gradient[2];
                f[row++] = patch->value(x);
            }
            if (std::abs(g.determinant()) < 1e-3) return;
            const Eigen::Vector3d step = g.inverse() * f;
            const Vec3 before = x;
            for (std::size_t a = 0; a < 3; ++a) x[a] -= step[static_cast<int>(a)];
            if (x == before || (flat && beyond(x))) break;
        }
        settle({&p, &q, &r}, x);
    }
    void settle(std::initializer_list<const SurfacePatch*> on, const Vec3& x) {
        if (!within(x)) return;
        for (const SurfacePatch* patch : on)
            if (!(std::abs(patch->distance(x)) < slack_)) return;
        keep(x);
    }

    const BoundaryCells& b_;
    std::size_t n_;
    double slack_;
    Vec3 low_;
    double edge_;
    std::vector<Vec3>& out_;
    boost::container::static_vector<const SurfacePatch*, BoundaryCells::slots> patches_;
};

// The patch that bounds a voxel from below, if one does.
const SurfacePatch* bound_below(const BoundaryCells& b, std::size_t n, double h) {
    constexpr double facing = 0.7;  // cosine
    const Vec3 middle = middle_of(place_of(b, n), h);
    for (std::size_t s = 0; s < b.slots_used(n); ++s) {
        const SlotUse use = b.use(n, s);
        const SurfacePatch& patch = b.patches[b.slot[s][n]];
        const Vec3 g = patch.gradient(middle);
        const double down = use.outside ? g[2] : -g[2];
        if (use.bounds && down >= facing * std::hypot(g[0], g[1], g[2])) return &patch;
    }
    return nullptr;
}

// Of the patches that pass a corner and are not level.
double error_beside(const BoundaryCells& b, std::size_t n, const Vec3& corner, double h) {
    constexpr double level = 0.7;  // cosine
    double most = 0;
    bool any = false;
    for (std::size_t s = 0; s < b.slots_used(n); ++s) {
        const SurfacePatch& patch = b.patches[b.slot[s][n]];
        const Vec3 g = patch.gradient(corner);
        if (std::abs(g[2]) > level * std::hypot(g[0], g[1], g[2]) ||
            std::abs(patch.distance(corner)) > on_patch * h)
            continue;
        any = true;
        most = std::max(most, patch.offset_m);
    }
    return any ? most : voxel_error * h;
}

}  // namespace

void add_corners(const BoundaryCells& b, std::size_t n, double h, std::vector<Vec3>& out) {
    if (b.share[n] == 0) return;
    double most = 0;
    for (std::size_t s = 0; s < b.slots_used(n); ++s)
        most = std::max(most, bend(b.patches[b.slot[s][n]]));
    // A chord of an arc lies so far inside of it, in voxels, and what of that is too much.
    constexpr double tolerance = 0.01;
    constexpr int most_parts = 4;
    const int parts =
        std::clamp(static_cast<int>(std::ceil(std::sqrt(most * h / 8 / tolerance))), 1, most_parts);
    const double edge = h / parts;
    for (int u = 0; u < parts; ++u) {
        for (int v = 0; v < parts; ++v) {
            for (int w = 0; w < parts; ++w) {
                Part part(b, n, h,
                          {b.i[n] * h + u * edge, b.j[n] * h + v * edge, b.k[n] * h + w * edge},
                          edge, out);
                if (parts == 1 || part.passed()) part.add_corners();
            }
        }
    }
    if (parts > 1) {
        const Vec3 low{b.i[n] * h, b.j[n] * h, b.k[n] * h};
        for (unsigned c = 0; c < 8; ++c) {
            const Vec3 corner{low[0] + (c & 1) * h, low[1] + (c >> 1 & 1) * h,
                              low[2] + (c >> 2) * h};
            if (b.solid(n, corner, slack * h)) out.push_back(corner);
        }
    }
}

std::vector<UndersideCorner> underside_of(const BoundaryCells& b, std::int32_t i, std::int32_t j,
                                          std::int32_t k, std::int32_t p, double h) {
    std::size_t n = b.find(i, j, k - 1, p);
    if (n == BoundaryCells::absent || b.share[n] == 0) n = b.find(i, j, k, p);
    // What it stands on reaches higher than that.
    if (n != BoundaryCells::absent && b.share[n] == 0) {
        if (!bound_below(b, n, h)) return {};
        n = b.find(i, j, ++k, p);
        if (n != BoundaryCells::absent && b.share[n] == 0) return {};
    }
    if (n == BoundaryCells::absent) {
        std::vector<UndersideCorner> out;
        for (const int di : {0, 1})
            for (const int dj : {0, 1})
                out.push_back({{(i + di) * h, (j + dj) * h, k * h}, voxel_error * h});
        return out;
    }
    std::vector<Vec3> corners;
    add_corners(b, n, h, corners);
    const SurfacePatch* below = bound_below(b, n, h);
    double lowest = std::numeric_limits<double>::infinity(), nearest = lowest;
    for (const Vec3& c : corners) {
        lowest = std::min(lowest, c[2]);
        if (below) nearest = std::min(nearest, std::abs(below->distance(c)));
    }
    constexpr double even = 0.1;  // of a voxel
    // A patch along the voxel's lowest side may pass just below it: then that side is the
    // underside.
    const double on_below = nearest < on_patch * h ? on_patch * h : nearest + even * h;
    std::vector<UndersideCorner> out;
    for (const Vec3& c : corners) {
        const bool on = below ? std::abs(below->distance(c)) < on_below : c[2] <= lowest + even * h;
        if (on) out.push_back({c, error_beside(b, n, c, h), below != nullptr});
    }
    return out;
}

std::vector<BorderColumn> border_columns(const SolidCells& cells, const BoundaryCells& b) {
    std::vector<BorderColumn> out;
    std::vector<std::int32_t> known;  // primitives of a column
    std::size_t cell = 0;
    for (std::size_t n = 0; n < b.size();) {
        const std::pair column(b.i[n], b.j[n]);
        while (cell < cells.size() && std::pair(cells.i[cell], cells.j[cell]) < column) ++cell;
        known.clear();
        for (; cell < cells.size() && std::pair(cells.i[cell], cells.j[cell]) == column; ++cell)
            known.push_back(cells.primitive[cell]);
        for (; n < b.size() && std::pair(b.i[n], b.j[n]) == column; ++n) {
            if (b.share[n] == 0 || std::ranges::find(known, b.primitive[n]) != known.end())
                continue;
            known.push_back(b.primitive[n]);
            out.push_back({b.i[n], b.j[n], b.k[n], b.primitive[n]});
        }
    }
    std::ranges::stable_sort(out, {}, &BorderColumn::primitive);
    return out;
}

double top_of(const BoundaryCells& b, std::int32_t i, std::int32_t j, std::int32_t k,
              std::int32_t p, double h) {
    const auto share = [&](std::int32_t at, double otherwise) {
        const std::size_t n = b.find(i, j, at, p);
        return n == BoundaryCells::absent ? otherwise : b.share[n] / double{BoundaryCells::whole};
    };
    return (k - 1 + share(k - 1, 1) + share(k, 1) + share(k + 1, 0)) * h;
}

double form_error_m(const BoundaryCells& b, double h) {
    std::vector<double> noise;
    for (std::size_t n = 0; n < b.size(); ++n)
        if (b.slots_used(n) > 0) noise.push_back(b.patches[b.slot[0][n]].noise_m);
    return noise.empty() ? h : std::clamp(3 * upper_median(noise), 0.01 * h, h);
}

}  // namespace topple::solids

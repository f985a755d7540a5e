// SPDX-License-Identifier: MIT
#include "solids/patches.h"

#include <Eigen/Dense>
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "geometry/algebraic_model.h"

namespace topple::solids {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr std::size_t most_points = 4000;  // of a patch: more say no more of where it lies
constexpr double outlier = 3;              // standard deviations
constexpr int rounds = 3;
constexpr double common_share = 0.25;   // of the noise that all of a patch's points have in common
constexpr double least_noise_m = 2e-5;  // of coordinates in single precision

Eigen::Vector3d rotated(const std::array<Vec3, 3>& axes, double x, double y, double z) {
    Eigen::Vector3d out;
    for (int a = 0; a < 3; ++a) {
        const Vec3& row = axes[static_cast<std::size_t>(a)];
        out[a] = row[0] * x + row[1] * y + row[2] * z;
    }
    return out;
}

geometry::AlgebraicModel rotated(const geometry::AlgebraicModel& model,
                                 const std::array<Vec3, 3>& axes) {
    Eigen::Matrix3d r, q;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
            r(a, b) = axes[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)];
    const auto& c = model.coefficients;
    q << c[4], c[7] / 2, c[8] / 2, c[7] / 2, c[5], c[9] / 2, c[8] / 2, c[9] / 2, c[6];
    q = (r * q * r.transpose()).eval();
    const Eigen::Vector3d b = r * Eigen::Vector3d(c[1], c[2], c[3]);
    const Eigen::Vector3d o =
        r * Eigen::Vector3d(model.origin[0], model.origin[1], model.origin[2]);
    geometry::AlgebraicModel out = model;
    out.origin = {o.x(), o.y(), o.z()};
    out.coefficients = {c[0],    b.x(),   b.y(),       b.z(),       q(0, 0),
                        q(1, 1), q(2, 2), 2 * q(0, 1), 2 * q(0, 2), 2 * q(1, 2)};
    if (model.degree == 1) std::fill(out.coefficients.begin() + 4, out.coefficients.end(), 0.0);
    return out;
}

double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// The points near the model, and how far these scatter about it.
struct Near {
    Points points;
    double noise_m = 0;
};
Near near(const geometry::AlgebraicModel& model, const Points& points) {
    std::vector<double> off;
    for (const auto& p : points) off.push_back(std::abs(geometry::distance(model, p)));
    std::vector<double> sorted = off;
    Near out;
    out.noise_m = std::max(1.4826 * median(sorted), least_noise_m);
    for (std::size_t n = 0; n < points.size(); ++n)
        if (off[n] <= outlier * out.noise_m) out.points.push_back(points[n]);
    return out;
}

// Nothing where the points span no plane.
std::optional<geometry::AlgebraicModel> plane_of(const geometry::AlgebraicModel& before,
                                                 const Points& points) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& p : points) mean += p;
    mean /= static_cast<double>(points.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const auto& p : points) spread += (p - mean) * (p - mean).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
    constexpr double least_ratio = 16;  // of the squares of the plane's width and its noise
    if (!(solver.eigenvalues()[1] > least_ratio * solver.eigenvalues()[0])) return std::nullopt;
    Eigen::Vector3d n = solver.eigenvectors().col(0);
    if (n.dot(geometry::gradient(before, mean)) < 0) n = -n;
    geometry::AlgebraicModel out;
    out.origin = {mean.x(), mean.y(), mean.z()};
    out.coefficients = {0, n.x(), n.y(), n.z(), 0, 0, 0, 0, 0, 0};
    return out;
}

// The layers of the fit lie close to the surface, and it is moved to where the points are: a
// quadric's value is no distance away from it.
geometry::AlgebraicModel quadric_of(const geometry::AlgebraicModel& before, const Points& points,
                                    double layer_m) {
    Points normals;
    for (const auto& p : points) normals.push_back(geometry::gradient(before, p).normalized());
    geometry::AlgebraicModel out = geometry::fit_quadric(points, normals, layer_m);
    double sum = 0;
    for (const auto& p : points) sum += out.value(p.x(), p.y(), p.z());
    out.coefficients[0] -= sum / static_cast<double>(points.size());
    return out;
}

// The quadric of least squares of distances to first order, over all points (Taubin 1991): exact of
// exact points, but of noisy ones on a narrow arc it follows the noise.
std::optional<geometry::AlgebraicModel> taubin_fit(const geometry::AlgebraicModel& before,
                                                   const Points& points) {
    using Matrix = Eigen::Matrix<double, 10, 10>;
    using Row = Eigen::Matrix<double, 10, 1>;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& p : points) mean += p;
    mean /= static_cast<double>(points.size());
    double size = 0;
    for (const auto& p : points) size += (p - mean).squaredNorm();
    size = std::sqrt(size / static_cast<double>(points.size()));
    if (!(size > 0)) return std::nullopt;
    Matrix values = Matrix::Zero(), slopes = Matrix::Zero();
    for (const auto& point : points) {
        const Eigen::Vector3d p = (point - mean) / size;
        const double x = p.x(), y = p.y(), z = p.z();
        Row f, fx, fy, fz;
        f << 1, x, y, z, x * x, y * y, z * z, x * y, x * z, y * z;
        fx << 0, 1, 0, 0, 2 * x, 0, 0, y, z, 0;
        fy << 0, 0, 1, 0, 0, 2 * y, 0, x, 0, z;
        fz << 0, 0, 0, 1, 0, 0, 2 * z, 0, x, y;
        values += f * f.transpose();
        slopes += fx * fx.transpose() + fy * fy.transpose() + fz * fz.transpose();
    }
    // Least of c' V c for c' S c = 1; S is singular along the constant, which is eliminated first.
    const Eigen::Matrix<double, 9, 1> cross = values.block<9, 1>(1, 0) / values(0, 0);
    const Eigen::Matrix<double, 9, 9> v =
        values.block<9, 9>(1, 1) - values(0, 0) * cross * cross.transpose();
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(
        v, slopes.block<9, 9>(1, 1));
    if (solver.info() != Eigen::Success) return std::nullopt;
    const Eigen::Matrix<double, 9, 1> c = solver.eigenvectors().col(0);
    geometry::AlgebraicModel out;
    out.degree = 2;
    out.origin = {mean.x(), mean.y(), mean.z()};
    out.coefficients[0] = -cross.dot(c);
    for (int n = 0; n < 9; ++n)
        out.coefficients[static_cast<std::size_t>(n) + 1] = c[n] / (n < 3 ? size : size * size);
    // Of mean gradient 1, and facing as before.
    double slope = 0, along = 0;
    for (const auto& p : points) {
        const Eigen::Vector3d g = geometry::gradient(out, p);
        slope += g.norm();
        along += g.dot(geometry::gradient(before, p));
    }
    if (!(slope > 0)) return std::nullopt;
    const double scale = std::copysign(static_cast<double>(points.size()) / slope, along);
    for (double& value : out.coefficients) value *= scale;
    return out;
}

double scatter(const geometry::AlgebraicModel& model, const Points& points) {
    double sum = 0;
    for (const auto& p : points) sum += std::pow(geometry::distance(model, p), 2);
    return std::sqrt(sum / static_cast<double>(points.size()));
}

SurfacePatch fit(const geometry::Region& region, const std::array<Vec3, 3>& axes,
                 const Points& points) {
    constexpr std::size_t least = 12;  // points that fit a quadric
    geometry::AlgebraicModel model = rotated(region.model, axes);
    double noise = region.residual_m;
    std::size_t inliers = points.size();
    for (int round = 0; round < rounds && points.size() >= least; ++round) {
        const Near own = near(model, points);
        if (own.points.size() < least) break;
        if (model.degree == 1) {
            const auto plane = plane_of(model, own.points);
            if (!plane) break;
            model = *plane;
        } else {
            const auto quadric =
                quadric_of(model, own.points, std::max(3 * own.noise_m, 0.1 * region.residual_m));
            if (!(scatter(quadric, own.points) <= 1.2 * scatter(model, own.points))) break;
            model = quadric;
            // Where the layers leave much of the distances, these are no noise.
            constexpr double clearly = 0.7;
            const auto exact = taubin_fit(model, own.points);
            if (exact && scatter(*exact, own.points) < clearly * scatter(model, own.points))
                model = *exact;
        }
        noise = own.noise_m;
        inliers = own.points.size();
    }
    SurfacePatch out;
    out.origin = model.origin;
    out.c = model.coefficients;
    out.noise_m = noise;
    out.offset_m =
        std::hypot(noise / std::sqrt(static_cast<double>(std::max<std::size_t>(inliers, 1))),
                   common_share * noise);
    return out;
}

// The patches seen in each cell of a coarse grid.
class PatchMap {
  public:
    explicit PatchMap(double cell_m) : cell_m_(cell_m) {}
    std::array<std::int32_t, 3> cell_of(const Eigen::Vector3d& p) const {
        std::array<std::int32_t, 3> out{};
        for (int a = 0; a < 3; ++a)
            out[static_cast<std::size_t>(a)] =
                static_cast<std::int32_t>(std::clamp(std::floor(p[a] / cell_m_), -2e9, 2e9));
        return out;
    }
    void add(const Eigen::Vector3d& p, std::int32_t patch) {
        std::vector<std::int32_t>& here = cells_[key(cell_of(p))];
        if (std::ranges::find(here, patch) == here.end()) here.push_back(patch);
    }
    // In the cell of a point, and those beside it.
    void around(const Eigen::Vector3d& p, std::vector<std::int32_t>& out) const {
        out.clear();
        const auto at = cell_of(p);
        for (std::int32_t n = 0; n < 27; ++n) {
            const auto found =
                cells_.find(key({at[0] + n / 9 - 1, at[1] + n / 3 % 3 - 1, at[2] + n % 3 - 1}));
            if (found == cells_.end()) continue;
            for (const std::int32_t patch : found->second)
                if (std::ranges::find(out, patch) == out.end()) out.push_back(patch);
        }
    }

  private:
    // 21 bits of each; cells that share a key are far from one another.
    static std::uint64_t key(const std::array<std::int32_t, 3>& at) {
        std::uint64_t out = 0;
        for (const std::int32_t a : at)
            out = out << 21 | (static_cast<std::uint32_t>(a) & 0x1fffff);
        return out;
    }
    double cell_m_;
    std::unordered_map<std::uint64_t, std::vector<std::int32_t>> cells_;
};

double distance_to(const SurfacePatch& patch, const Eigen::Vector3d& p) {
    return patch.distance({p.x(), p.y(), p.z()});
}

Eigen::Vector3d normal_of(const SurfacePatch& patch, const Eigen::Vector3d& p) {
    const Vec3 g = patch.gradient({p.x(), p.y(), p.z()});
    return Eigen::Vector3d(g[0], g[1], g[2]).normalized();
}

// The patch of more points that lies nearest to a point, within its noise; -1 where none does.
struct Explainer {
    std::span<const SurfacePatch> patches;
    const std::vector<std::size_t>& points;  // of each patch
    const std::vector<bool>& dropped;

    std::int32_t operator()(const Eigen::Vector3d& p, std::int32_t own,
                            std::span<const std::int32_t> near) const {
        std::int32_t best = -1;
        double least = 1;
        for (const std::int32_t other : near) {
            const auto o = static_cast<std::size_t>(other), mine = static_cast<std::size_t>(own);
            if (other == own || dropped[o] ||
                std::pair(points[o], other) < std::pair(points[mine], own))
                continue;
            const double off = std::abs(distance_to(patches[o], p)) /
                               (outlier * std::max(patches[o].noise_m, least_noise_m));
            if (off > least || (off == least && best >= 0 && best < other)) continue;
            least = off;
            best = other;
        }
        return best;
    }
};

// Whether a patch is the rounded edge of two much larger ones, A and B: where depth readings of
// both sides mix, its points lie between them. All of them are near both, and it faces between
// them.
bool is_edge(const Eigen::Vector3d& normal, std::span<const Eigen::Vector3d> beside) {
    const auto angle = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
        return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
    };
    constexpr double slack = 0.26, least = 0.5, most = 2.6;  // radians
    for (std::size_t a = 0; a < beside.size(); ++a) {
        for (std::size_t b = a + 1; b < beside.size(); ++b) {
            const double whole = angle(beside[a], beside[b]);
            if (whole > least && whole < most &&
                angle(beside[a], normal) + angle(normal, beside[b]) < whole + slack)
                return true;
        }
    }
    return false;
}

// Every so many of the points, the same ones in whatever order they come.
bool is_chosen(const CloudView& cloud, std::size_t n, std::size_t step) {
    std::uint64_t mixed = 0;
    for (const float v : {cloud.x[n], cloud.y[n], cloud.z[n]})
        mixed = (mixed ^ std::bit_cast<std::uint32_t>(v)) * 0x9e3779b97f4a7c15U;
    return (mixed >> 32) % step == 0;
}

void sort(Points& points) {
    std::ranges::sort(points, {},
                      [](const Eigen::Vector3d& p) { return std::tuple(p.x(), p.y(), p.z()); });
}

struct SeenPoint {
    std::int32_t i, j, k, primitive, patch;
    float x, y, z;
    auto key() const { return std::tie(i, j, k, primitive, patch); }
    auto order() const { return std::tie(i, j, k, primitive, patch, x, y, z); }
};

}  // namespace

std::vector<SurfacePatch> fit_patches(const CloudView& cloud,
                                      std::span<const geometry::Region> regions,
                                      std::span<const std::int32_t> region_of_point,
                                      const std::array<Vec3, 3>& axes,
                                      device::ThreadPool& threads) {
    std::vector<std::size_t> first(regions.size() + 1, 0);
    for (const std::int32_t r : region_of_point)
        if (r >= 0) ++first[static_cast<std::size_t>(r) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::uint32_t> order(first.back());
    std::vector<std::size_t> at(first.begin(), first.end() - 1);
    for (std::size_t n = 0; n < region_of_point.size(); ++n)
        if (region_of_point[n] >= 0)
            order[at[static_cast<std::size_t>(region_of_point[n])]++] =
                static_cast<std::uint32_t>(n);
    std::vector<SurfacePatch> out(regions.size());
    threads.each(regions.size(), 16, [&](std::size_t r) {
        const std::size_t count = first[r + 1] - first[r], step = count / most_points + 1;
        Points points;
        for (std::size_t m = first[r]; m < first[r + 1]; ++m) {
            const std::uint32_t n = order[m];
            if (is_chosen(cloud, n, step))
                points.push_back(rotated(axes, cloud.x[n], cloud.y[n], cloud.z[n]));
        }
        sort(points);
        out[r] = fit(regions[r], axes, points);
    });
    return out;
}

void drop_explained(const CloudView& cloud, std::span<const SurfacePatch> patches,
                    const std::array<Vec3, 3>& axes, double cell_m,
                    std::vector<std::int32_t>& primitive_of_point,
                    std::vector<std::int32_t>& patch_of_point) {
    constexpr double explained = 0.8;       // share of its points that makes a patch none
    constexpr std::size_t looked_at = 200;  // of them
    constexpr std::size_t much_larger = 4;
    std::vector<std::vector<std::uint32_t>> members(patches.size());
    PatchMap map(cell_m);
    const auto point = [&](std::size_t n) {
        return rotated(axes, cloud.x[n], cloud.y[n], cloud.z[n]);
    };
    for (std::size_t n = 0; n < patch_of_point.size(); ++n) {
        if (patch_of_point[n] < 0) continue;
        members[static_cast<std::size_t>(patch_of_point[n])].push_back(
            static_cast<std::uint32_t>(n));
        map.add(point(n), patch_of_point[n]);
    }
    std::vector<std::size_t> size, order(patches.size());
    for (const auto& m : members) size.push_back(m.size());
    std::vector<std::int32_t> primitive(patches.size(), -1);
    for (std::size_t p = 0; p < patches.size(); ++p)
        for (const std::uint32_t n : members[p])
            primitive[p] = std::max(primitive[p], primitive_of_point[n]);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t p) { return size[p]; });
    std::vector<bool> dropped(patches.size(), false);
    const Explainer explain{patches, size, dropped};
    std::vector<std::int32_t> near;
    for (const std::size_t p : order) {
        const auto own = static_cast<std::int32_t>(p);
        std::size_t looked = 0, met = 0;
        std::map<std::int32_t, std::size_t> beside;  // much larger patches: points near them
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (const std::uint32_t n : members[p]) {
            if (!is_chosen(cloud, n, size[p] / looked_at + 1)) continue;
            ++looked;
            const Eigen::Vector3d at = point(n);
            middle += at;
            map.around(at, near);
            met += explain(at, own, near) >= 0;
            for (const std::int32_t other : near) {
                const auto o = static_cast<std::size_t>(other);
                if (!dropped[o] && size[o] > much_larger * size[p])
                    beside[other] += std::abs(distance_to(patches[o], at)) < cell_m / 2;
            }
        }
        if (looked == 0) continue;
        const double enough = explained * static_cast<double>(looked);
        middle /= static_cast<double>(looked);
        std::vector<Eigen::Vector3d> sides;
        for (const auto& [other, count] : beside) {
            if (static_cast<double>(count) >= enough)
                sides.push_back(normal_of(patches[static_cast<std::size_t>(other)], middle));
        }
        if (static_cast<double>(met) < enough && !is_edge(normal_of(patches[p], middle), sides))
            continue;
        for (const std::uint32_t n : members[p]) {
            const Eigen::Vector3d at = point(n);
            map.around(at, near);
            const std::int32_t other = explain(at, own, near);
            patch_of_point[n] = other;
            if (other >= 0) primitive_of_point[n] = primitive[static_cast<std::size_t>(other)];
        }
        dropped[p] = true;
    }
}

SeenCells seen_cells(const CloudView& cloud, std::span<const std::int32_t> primitive_of_point,
                     std::span<const std::int32_t> patch_of_point, const std::array<Vec3, 3>& axes,
                     double voxel_m) {
    std::vector<SeenPoint> places;
    for (std::size_t n = 0; n < cloud.size(); ++n) {
        if (primitive_of_point[n] < 0 || patch_of_point[n] < 0) continue;
        const Eigen::Vector3d p = rotated(axes, cloud.x[n], cloud.y[n], cloud.z[n]);
        const auto cell = [&](double v) {
            return static_cast<std::int32_t>(std::clamp(std::floor(v / voxel_m), -2e9, 2e9));
        };
        places.push_back({cell(p.x()), cell(p.y()), cell(p.z()), primitive_of_point[n],
                          patch_of_point[n], static_cast<float>(p.x()), static_cast<float>(p.y()),
                          static_cast<float>(p.z())});
    }
    std::ranges::sort(places, {}, &SeenPoint::order);
    SeenCells out;
    for (std::size_t n = 0; n < places.size();) {
        std::size_t end = n;
        double sum[3] = {0, 0, 0};
        for (; end < places.size() && places[end].key() == places[n].key(); ++end) {
            sum[0] += places[end].x;
            sum[1] += places[end].y;
            sum[2] += places[end].z;
        }
        const auto count = static_cast<double>(end - n);
        out.i.push_back(places[n].i);
        out.j.push_back(places[n].j);
        out.k.push_back(places[n].k);
        out.primitive.push_back(places[n].primitive);
        out.patch.push_back(places[n].patch);
        out.count.push_back(static_cast<float>(count));
        out.x.push_back(static_cast<float>(sum[0] / count));
        out.y.push_back(static_cast<float>(sum[1] / count));
        out.z.push_back(static_cast<float>(sum[2] / count));
        n = end;
    }
    return out;
}

std::vector<bool> one_sided(const SeenCells& seen, std::span<const SurfacePatch> patches,
                            std::size_t primitives) {
    constexpr double least = 0.95;  // length of the mean normal
    std::vector<Eigen::Vector3d> sum(primitives, Eigen::Vector3d::Zero());
    std::vector<double> count(primitives, 0.0);
    for (std::size_t n = 0; n < seen.size(); ++n) {
        const auto p = static_cast<std::size_t>(seen.primitive[n]);
        const Vec3 g = patches[static_cast<std::size_t>(seen.patch[n])].gradient(
            {seen.x[n], seen.y[n], seen.z[n]});
        sum[p] += seen.count[n] * Eigen::Vector3d(g[0], g[1], g[2]).normalized();
        count[p] += seen.count[n];
    }
    std::vector<bool> out;
    for (std::size_t p = 0; p < primitives; ++p) out.push_back(sum[p].norm() >= least * count[p]);
    return out;
}

}  // namespace topple::solids

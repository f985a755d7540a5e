// SPDX-License-Identifier: MIT
#include "solids/patches.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

#include "core/ranked.h"
#include "core/rows.h"
#include "geometry/algebraic_model.h"
#include "solids/plane_through.h"

namespace topple::solids {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr std::size_t most_points = 4000;  // of a patch: more say no more of where it lies
constexpr int rounds = 3;
constexpr double common_share = 0.25;   // of the noise that all of a patch's points have in common
constexpr double least_noise_m = 2e-5;  // of coordinates in single precision

geometry::AlgebraicModel rotated(const geometry::AlgebraicModel& model,
                                 const std::array<Vec3, 3>& axes) {
    Eigen::Matrix3d r, q;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) r(a, b) = axes[a][b];
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

// The points near the model, and how far these scatter about it.
struct Near {
    Points points;
    double noise_m = 0;
};
Near near(const geometry::AlgebraicModel& model, std::span<const Eigen::Vector3d> points) {
    std::vector<double> off;
    for (const auto& p : points) off.push_back(std::abs(geometry::distance(model, p)));
    std::vector<double> sorted = off;
    Near out;
    out.noise_m = std::max(1.4826 * upper_median(sorted), least_noise_m);
    for (std::size_t n = 0; n < points.size(); ++n)
        if (off[n] <= outlier * out.noise_m) out.points.push_back(points[n]);
    return out;
}

// Nothing where the points span no plane.
std::optional<geometry::AlgebraicModel> plane_of(const geometry::AlgebraicModel& before,
                                                 const Points& points) {
    PlaneThrough plane(points);
    constexpr double least_ratio = 16;  // of the squares of the plane's width and its noise
    if (!(plane.squares[1] > least_ratio * plane.squares[0])) return std::nullopt;
    if (plane.normal.dot(geometry::gradient(before, plane.mean)) < 0) plane.normal = -plane.normal;
    return plane.model();
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

// Whether it bends by radii of more than 10 um: points that span no surface, as those of one row,
// leave a quadric's coefficients open, and what comes of them is anything.
bool is_surface(const geometry::AlgebraicModel& model) {
    constexpr double most_per_m = 1e5;
    return std::all_of(model.coefficients.begin() + 4, model.coefficients.end(),
                       [](double c) { return std::abs(c) < most_per_m; });
}

double scatter(const geometry::AlgebraicModel& model, const Points& points) {
    double sum = 0;
    for (const auto& p : points) sum += std::pow(geometry::distance(model, p), 2);
    return std::sqrt(sum / static_cast<double>(points.size()));
}

void sort(Points& points) {
    std::ranges::sort(points, {},
                      [](const Eigen::Vector3d& p) { return std::tuple(p.x(), p.y(), p.z()); });
}

}  // namespace

SurfacePatch fit_patch(geometry::AlgebraicModel model, double residual_m,
                       std::span<const Eigen::Vector3d> points) {
    if (!is_surface(model))
        model = points.empty() ? geometry::AlgebraicModel{} : PlaneThrough(points).model();
    double noise = residual_m;
    std::size_t inliers = points.size();
    for (int round = 0; round < rounds && points.size() >= least_points; ++round) {
        const Near own = near(model, points);
        if (own.points.size() < least_points) break;
        if (model.degree == 1) {
            const auto plane = plane_of(model, own.points);
            if (!plane) break;
            model = *plane;
        } else {
            const auto quadric =
                quadric_of(model, own.points, std::max(3 * own.noise_m, 0.1 * residual_m));
            if (!is_surface(quadric) ||
                !(scatter(quadric, own.points) <= 1.2 * scatter(model, own.points)))
                break;
            model = quadric;
            // Where the layers leave much of the distances, these are no noise.
            constexpr double clearly = 0.7;
            const auto exact = taubin_fit(model, own.points);
            if (exact && is_surface(*exact) &&
                scatter(*exact, own.points) < clearly * scatter(model, own.points))
                model = *exact;
        }
        noise = own.noise_m;
        inliers = own.points.size();
    }
    SurfacePatch out;
    out.origin = model.origin;
    out.c = model.coefficients;
    out.noise_m = std::max(noise, least_noise_m);
    out.offset_m =
        std::hypot(noise / std::sqrt(static_cast<double>(std::max<std::size_t>(inliers, 1))),
                   common_share * noise);
    return out;
}

std::vector<SurfacePatch> fit_patches(const GridPoints& points,
                                      std::span<const geometry::Region> regions,
                                      std::span<const std::int32_t> region_of_point,
                                      ThreadPool& threads) {
    const auto members = places_by_label(region_of_point, regions.size());
    std::vector<SurfacePatch> out(regions.size());
    threads.each(regions.size(), 16, [&](std::size_t r) {
        const std::size_t step = members[r].size() / most_points + 1;
        Points chosen;
        for (const std::uint32_t n : members[r])
            if (points.is_chosen(n, step)) chosen.push_back(points[n]);
        sort(chosen);
        out[r] = fit_patch(rotated(regions[r].model, points.axes()), regions[r].residual_m, chosen);
    });
    return out;
}

}  // namespace topple::solids

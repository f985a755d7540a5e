// SPDX-License-Identifier: MIT
#include "geometry/shell_faces.h"

#include <Eigen/Dense>
#include <algorithm>

#include "core/room_measures.h"

namespace topple::geometry {

std::vector<Face> faces(const Surfels& s, const std::vector<std::int32_t>& label, std::size_t count,
                        const Vec3& up) {
    using Eigen::Vector3d;
    std::vector<Face> out(count);
    std::vector<Eigen::Matrix3d> moment(count, Eigen::Matrix3d::Zero());
    const auto normal = [&](std::size_t n) { return Vector3d(s.nx[n], s.ny[n], s.nz[n]); };
    for (std::size_t n = 0; n < s.size(); ++n) {
        if (label[n] < 0) continue;
        const auto k = static_cast<std::size_t>(label[n]);
        Face& f = out[k];
        f.area_m2 += s.area_m2;
        f.nx += s.nx[n], f.ny += s.ny[n], f.nz += s.nz[n];
        f.px += s.x[n], f.py += s.y[n], f.pz += s.z[n];
        moment[k] += normal(n) * normal(n).transpose();
        const double height = component(up, s.x[n], s.y[n], s.z[n]);
        f.lowest_m = std::min(f.lowest_m, height);
        f.highest_m = std::max(f.highest_m, height);
    }
    std::vector<Vector3d> axis(count), folded(count, Vector3d::Zero());
    for (std::size_t k = 0; k < count; ++k) {
        axis[k] = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moment[k]).eigenvectors().col(2);
        if (axis[k].dot(Vector3d(out[k].nx, out[k].ny, out[k].nz)) < 0) axis[k] = -axis[k];
    }
    for (std::size_t n = 0; n < s.size(); ++n) {
        if (label[n] < 0) continue;
        const auto k = static_cast<std::size_t>(label[n]);
        const bool against = normal(n).dot(axis[k]) < 0;
        folded[k] += against ? -normal(n) : normal(n);
        out[k].against += against;
    }
    for (std::size_t k = 0; k < count; ++k) {
        Face& f = out[k];
        const double surfels = std::max(1.0, f.area_m2 / s.area_m2);
        const Vector3d sum(f.nx, f.ny, f.nz);
        f.flatness = sum.norm() / surfels;
        f.sheetness = folded[k].norm() / surfels;
        f.against /= surfels;
        const bool two_sided = f.flatness <= flat && f.is_sheet();
        const Vector3d mean = (two_sided ? folded[k] : sum).normalized();
        f.nx = mean[0], f.ny = mean[1], f.nz = mean[2];
        f.px /= surfels, f.py /= surfels, f.pz /= surfels;
    }
    return out;
}

Vec3 level_axis(const Face& f, const Vec3& up) {
    const Vec3 along{up[1] * f.nz - up[2] * f.ny, up[2] * f.nx - up[0] * f.nz,
                     up[0] * f.ny - up[1] * f.nx};
    const double length = std::hypot(along[0], along[1], along[2]);
    return {along[0] / length, along[1] / length, along[2] / length};
}

std::vector<LevelSpan> level_spans(const Surfels& s, const std::vector<std::int32_t>& label,
                                   const std::vector<Face>& faces, const Vec3& up) {
    std::vector<Vec3> axis;
    for (const Face& f : faces) axis.push_back(level_axis(f, up));
    std::vector<LevelSpan> out(faces.size());
    for (std::size_t n = 0; n < s.size(); ++n) {
        if (label[n] < 0) continue;
        const auto k = static_cast<std::size_t>(label[n]);
        const double along = component(axis[k], s.x[n], s.y[n], s.z[n]);
        out[k].low_m = std::min(out[k].low_m, along);
        out[k].high_m = std::max(out[k].high_m, along);
    }
    return out;
}

double gap_m(const LevelSpan& a, const LevelSpan& b, bool opposite) {
    if (opposite) return std::max(a.low_m, -b.high_m) - std::min(a.high_m, -b.low_m);
    return std::max(a.low_m, b.low_m) - std::min(a.high_m, b.high_m);
}

double ceiling_height(const std::vector<Face>& faces, const Vec3& up, double floor_m,
                      double top_m) {
    double height = -INFINITY;
    for (const Face& f : faces) {
        if (f.level(up) < -horizontal_cos && f.area_m2 >= wall_area_m2 &&
            f.lowest_m - floor_m >= lowest_room_m && f.highest_m < top_m)
            height = std::max({height, f.lowest_m, f.height_m(up) - below_ceiling_m});
    }
    return std::isfinite(height) ? height : INFINITY;
}

}  // namespace topple::geometry

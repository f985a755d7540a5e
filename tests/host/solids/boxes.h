// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>

#include "clouds.h"
#include "core/boundary_cells.h"
#include "core/solid_cells.h"
#include "core/thread_pool.h"
#include "solids/patches.h"
#include "topple/cloud_view.h"

// Boxes, anyhow turned, with what a scan would hold of them: points on the faces in view, the
// faces' planes, and the voxels that they or the inside touch.
namespace topple::solids {

struct Box {
    Eigen::Vector3d middle, half;
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // columns: the box's own
    unsigned seen = 63;                                  // bits of the faces -x +x -y +y -z +z

    bool holds(const Eigen::Vector3d& p, double slack = 0) const {
        const Eigen::Vector3d q = (axes.transpose() * (p - middle)).cwiseAbs();
        return (q.array() <= half.array() + slack).all();
    }
    double volume() const { return 8 * half.prod(); }
};

inline Eigen::Matrix3d turned(double yaw, double pitch, double roll) {
    return (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
        .toRotationMatrix();
}

struct Scanned {
    PointCloud cloud;
    std::vector<std::int32_t> primitive, patch;  // of points
    std::vector<SurfacePatch> patches;
    SolidCells cells;

    SeenCells seen() const {
        ThreadPool threads(2);
        return seen_cells({cloud, {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}},
                          {primitive, patch}, cells.voxel_m, threads);
    }
};

inline SurfacePatch plane(const Eigen::Vector3d& at, const Eigen::Vector3d& outwards) {
    SurfacePatch out;
    out.origin = {at.x(), at.y(), at.z()};
    out.c = {0, outwards.x(), outwards.y(), outwards.z(), 0, 0, 0, 0, 0, 0};
    out.noise_m = 1e-4;
    out.offset_m = 3e-5;
    return out;
}

inline void add_points(const Box& box, std::int32_t primitive, double spacing, Scanned& out) {
    for (int face = 0; face < 6; ++face) {
        if (!(box.seen >> face & 1)) continue;
        const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        const Eigen::Vector3d normal = (face % 2 ? 1 : -1) * box.axes.col(axis);
        const Eigen::Vector3d at = box.middle + normal * box.half[axis];
        const auto patch = static_cast<std::int32_t>(out.patches.size());
        out.patches.push_back(plane(at, normal));
        const auto steps = [&](int a) {
            return static_cast<int>(std::ceil(2 * box.half[a] / spacing));
        };
        for (int m = 0; m < steps(u); ++m) {
            for (int n = 0; n < steps(v); ++n) {
                const Eigen::Vector3d p =
                    at + ((m + 0.5) / steps(u) * 2 - 1) * box.half[u] * box.axes.col(u) +
                    ((n + 0.5) / steps(v) * 2 - 1) * box.half[v] * box.axes.col(v);
                test::add(out.cloud, p.x(), p.y(), p.z());
                out.primitive.push_back(primitive);
                out.patch.push_back(patch);
            }
        }
    }
}

// As the pipeline has them: a voxel with points is solid, and so is one whose middle is within.
// Where several claim one, the first box has it.
inline Scanned scan(const std::vector<Box>& boxes, double voxel_m, double spacing = 0.004) {
    Scanned out;
    std::map<std::array<std::int32_t, 3>, std::pair<std::int32_t, Basis>> cells;
    const auto index = [&](double v) { return static_cast<std::int32_t>(std::floor(v / voxel_m)); };
    for (std::size_t b = 0; b < boxes.size(); ++b)
        add_points(boxes[b], static_cast<std::int32_t>(b), spacing, out);
    for (std::size_t n = 0; n < out.cloud.size(); ++n)
        cells.try_emplace({index(out.cloud.x[n]), index(out.cloud.y[n]), index(out.cloud.z[n])},
                          out.primitive[n], Basis::surface);
    for (std::size_t b = 0; b < boxes.size(); ++b) {
        const double reach = boxes[b].half.norm();
        const Eigen::Vector3d low = boxes[b].middle.array() - reach,
                              high = boxes[b].middle.array() + reach;
        for (std::int32_t i = index(low.x()); i <= index(high.x()); ++i) {
            for (std::int32_t j = index(low.y()); j <= index(high.y()); ++j) {
                for (std::int32_t k = index(low.z()); k <= index(high.z()); ++k) {
                    const Eigen::Vector3d middle =
                        voxel_m * Eigen::Vector3d(i + .5, j + .5, k + .5);
                    if (boxes[b].holds(middle))
                        cells.try_emplace({i, j, k}, static_cast<std::int32_t>(b), Basis::enclosed);
                }
            }
        }
    }
    out.cells.voxel_m = voxel_m;
    for (const auto& [at, what] : cells) out.cells.add(at, what.first, what.second);
    return out;
}

}  // namespace topple::solids

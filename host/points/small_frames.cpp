// SPDX-License-Identifier: MIT
#include "points/small_frames.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/depth_noise.h"

namespace topple::geometry {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr std::uint32_t kept_columns = 80;
constexpr double near_m = 0.05;
constexpr unsigned compared_stride = 2, aligned_stride = 3;

// How far from a surface a reading of it may lie: three standard deviations of both, and what poses
// and cameras are off without harm; but no more than a share of the depth.
double tolerance_m(double depth_m) {
    constexpr double sigmas = 3, harmless_m = 0.01, most_share = 0.06;
    return std::min(sigmas * std::numbers::sqrt2 * depth_sigma(depth_m) + harmless_m,
                    most_share * depth_m);
}

Eigen::Isometry3d motion_of(const Vector6& turn_and_way) {
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    const Eigen::Vector3d turn = turn_and_way.head<3>();
    if (const double angle = turn.norm(); angle > 0)
        motion.linear() = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
    motion.translation() = turn_and_way.tail<3>();
    return motion;
}

}  // namespace

Agreement sum(std::span<const Agreement> cells) {
    Agreement out;
    for (const Agreement& cell : cells) out += cell;
    return out;
}

Agreement& Agreement::operator+=(const Agreement& other) {
    carried += other.carried;
    compared += other.compared;
    agreeing += other.agreeing;
    before += other.before;
    return *this;
}

SmallFrames::SmallFrames(const Intrinsics& intrinsics, std::size_t count)
    : intrinsics_(intrinsics),
      step_(std::max(1U, std::max(intrinsics.width, intrinsics.height) / kept_columns)),
      width_((intrinsics.width - 1) / step_ + 1),
      height_((intrinsics.height - 1) / step_ + 1),
      depth_(count) {}

void SmallFrames::add(const DepthFrame& frame, std::size_t number) {
    std::vector<std::uint16_t>& kept = depth_[number];
    kept.clear();
    kept.reserve(std::size_t{width_} * height_);
    for (std::uint32_t v = 0; v < intrinsics_.height; v += step_)
        for (std::uint32_t u = 0; u < intrinsics_.width; u += step_)
            kept.push_back(frame.depth[std::size_t{v} * intrinsics_.width + u]);
}

Eigen::Vector3d SmallFrames::point(std::uint32_t column, std::uint32_t row,
                                   std::uint16_t stored) const {
    const Intrinsics& k = intrinsics_;
    const double z = stored / k.depth_scale;
    return {(column * step_ - k.cx) / k.fx * z, (row * step_ - k.cy) / k.fy * z, z};
}

std::optional<SmallFrames::Patch> SmallFrames::patch(std::size_t frame, std::uint32_t column,
                                                     std::uint32_t row) const {
    // Two readings of one surface differ by no more than this share of their depth; beyond that and
    // their noise there is an edge between them.
    constexpr double edge_share = 0.06, edge_sigmas = 4;
    const std::uint16_t* upper = &depth_[frame][std::size_t{row} * width_ + column];
    const std::uint16_t* lower = upper + width_;
    const auto [least, most] = std::minmax({upper[0], upper[1], lower[0], lower[1]});
    if (least == 0) return std::nullopt;
    const double low = least / intrinsics_.depth_scale, high = most / intrinsics_.depth_scale;
    if (high - low > edge_share * high + edge_sigmas * depth_sigma(high)) return std::nullopt;
    const Eigen::Vector3d a = point(column, row, upper[0]), b = point(column + 1, row, upper[1]),
                          c = point(column, row + 1, lower[0]),
                          d = point(column + 1, row + 1, lower[1]);
    Eigen::Vector3d normal = (d - a).cross(c - b).normalized();
    if (normal.z() > 0) normal = -normal;
    return Patch{normal, (a + b + c + d) / 4};
}

std::optional<SmallFrames::Patch> SmallFrames::patch_at(std::size_t frame,
                                                        const Eigen::Vector3d& p) const {
    if (!(p.z() > near_m)) return std::nullopt;
    const double u = (p.x() / p.z() * intrinsics_.fx + intrinsics_.cx) / step_;
    const double v = (p.y() / p.z() * intrinsics_.fy + intrinsics_.cy) / step_;
    if (!(u >= 0 && v >= 0 && u < width_ - 1.0 && v < height_ - 1.0)) return std::nullopt;
    return patch(frame, static_cast<std::uint32_t>(u), static_cast<std::uint32_t>(v));
}

template <class Use>
void SmallFrames::each_met(std::size_t from, std::size_t to, const Eigen::Isometry3d& motion,
                           unsigned stride, Use use, Agreement* cells) const {
    // What is turned away from the other camera it can't see, nor see through.
    constexpr double least_facing = 0.15;
    for (std::uint32_t row = 0; row + 1 < height_; row += stride) {
        for (std::uint32_t column = 0; column + 1 < width_; column += stride) {
            const auto read = patch(from, column, row);
            if (!read) continue;
            const Eigen::Vector3d there = motion * read->middle;
            const std::size_t cell =
                row * cells_up / height_ * cells_across + column * cells_across / width_;
            if (cells != nullptr) ++cells[cell].carried;
            if (-(motion.linear() * read->normal).dot(there) < least_facing * there.norm())
                continue;
            if (const auto seen = patch_at(to, there))
                use(cell, there, seen->normal, seen->normal.dot(there - seen->middle),
                    std::max(read->middle.z(), there.z()));
        }
    }
}

void SmallFrames::carry_cells(std::size_t from, std::size_t to, const Eigen::Isometry3d& motion,
                              unsigned stride, Agreement* cells) const {
    const auto count = [&](std::size_t cell, const Eigen::Vector3d&, const Eigen::Vector3d&,
                           double before_m, double depth_m) {
        const double tolerance = tolerance_m(depth_m);
        ++cells[cell].compared;
        cells[cell].agreeing += std::abs(before_m) <= tolerance;
        cells[cell].before += before_m > tolerance;
    };
    each_met(from, to, motion, stride, count, cells);
}

Agreement SmallFrames::carry(std::size_t from, std::size_t to, const Eigen::Isometry3d& motion,
                             unsigned stride) const {
    std::array<Agreement, cells_across * cells_up> cells;
    carry_cells(from, to, motion, stride, cells.data());
    return sum(cells);
}

SmallFrames::Cells SmallFrames::compare(std::size_t a, std::size_t b,
                                        const Eigen::Isometry3d& motion) const {
    Cells out;
    carry_cells(a, b, motion, compared_stride, out.data());
    carry_cells(b, a, motion.inverse(), compared_stride, out.data() + cells_across * cells_up);
    return out;
}

Eigen::Isometry3d SmallFrames::align(std::size_t from, std::size_t to,
                                     Eigen::Isometry3d guess) const {
    constexpr std::size_t least_met = 20;
    // What surfaces leave open, such as a way along a wall, stays as it is.
    constexpr double turn_damping = 0.02, way_damping = 0.005;
    for (const double reach_m : {0.9, 0.7, 0.5, 0.4, 0.3, 0.2, 0.15, 0.1, 0.07, 0.07}) {
        Matrix6 normal = Matrix6::Zero();
        Vector6 right = Vector6::Zero();
        std::size_t met = 0;
        const auto add = [&](std::size_t, const Eigen::Vector3d& there,
                             const Eigen::Vector3d& facing, double before_m, double depth_m) {
            const double far = before_m / reach_m;
            if (std::abs(far) > 1) return;
            constexpr double floor_m = 0.01;
            const double noise = depth_sigma(depth_m) / floor_m;
            const double weight = (1 - far * far) * (1 - far * far) / (1 + noise * noise);
            Vector6 slope;
            slope << there.cross(facing), facing;
            normal += weight * slope * slope.transpose();
            right -= weight * before_m * slope;
            ++met;
        };
        each_met(from, to, guess, aligned_stride, add);
        if (met < least_met) break;
        const auto count = static_cast<double>(met);
        normal.diagonal().head<3>().array() += turn_damping * count;
        normal.diagonal().tail<3>().array() += way_damping * count;
        guess = motion_of(normal.ldlt().solve(right)) * guess;
    }
    return guess;
}

}  // namespace topple::geometry

// SPDX-License-Identifier: MIT
#include "geometry/pose_comparison.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "core/depth_noise.h"

namespace topple::geometry {
namespace {

using Matrix = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

// What is kept of a frame, and how many of its readings in a row are carried.
constexpr std::uint32_t kept_columns = 160, carried_columns = 40;
// Frames to which others are looked for, spread over the sequence.
constexpr std::size_t anchors = 8;
// Frames of a pair turn by this share of the smaller field of view at least, and twice that at
// most: conventions then differ by more than noise, and two thirds of what is seen is common.
constexpr double turn_share = 0.3;
// Another convention is better if so many of the readings that it compares agree, and so many of
// all, and in the given one less than these shares of that. On 11 scans in the right convention 82
// to 98 % agree, or 35 to 74 % of all; in any other at most 38 % of these shares, or 22 % of all.
constexpr double least_agreeing = 0.5, least_common = 0.1;
constexpr double most_given_agreeing = 0.5, most_given_common = 1.0 / 3;
// Frames contradict each other if fewer agree, and more lie before what the other frame sees, of at
// least so many that are compared. On scans of 17 rooms with right poses and intrinsics, each with
// all its frames and with every third to twelfth, fewer agree where little is common, and then
// none lies before; with poses in another order or of another scale, or another focal length or
// principal point, mostly 30 to 50 % do.
constexpr double most_before = 0.1, least_compared = 0.05;
constexpr std::size_t least_compared_pairs = 3;
// Frames of one pose moved if fewer agree. On five scans and three generated rooms, with one pose
// for all frames or for 20 in a row, 1 to 44 % do; of a camera that stands still at least 94 %,
// with up to three times the noise of core/depth_noise.h.
constexpr double most_of_moved = 0.5;
// Those that are nearly as good as the best are not told apart from it.
constexpr double as_good = 0.75;

Eigen::Isometry3d isometry(const Mat4& pose) {
    return Eigen::Isometry3d(Eigen::Map<const Matrix>(pose.data()).eval());
}

Mat4 pose_of(const Eigen::Isometry3d& isometry) {
    Mat4 out;
    Eigen::Map<Matrix>(out.data()) = isometry.matrix();
    return out;
}

// What turns poses of a camera with other axes into those of one with topple's: the directions of
// these, x right, y down and z ahead, as columns.
Eigen::Isometry3d axes_of(PoseConvention convention) {
    Eigen::Isometry3d axes = Eigen::Isometry3d::Identity();
    switch (convention) {
        case PoseConvention::opengl:
        case PoseConvention::world_to_camera_opengl:
            axes.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
            break;
        case PoseConvention::body:
        case PoseConvention::world_to_camera_body:
            axes.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
            break;
        default:
            break;
    }
    return axes;
}

Eigen::Isometry3d meant(const Eigen::Isometry3d& given, PoseConvention convention) {
    switch (convention) {
        case PoseConvention::world_to_camera:
        case PoseConvention::world_to_camera_opengl:
        case PoseConvention::world_to_camera_body:
            return given.inverse() * axes_of(convention);
        case PoseConvention::w_first: {
            const Eigen::Quaterniond q(given.linear());
            Eigen::Isometry3d out = given;
            out.linear() = Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()).toRotationMatrix();
            return out;
        }
        case PoseConvention::transposed: {
            Eigen::Isometry3d out = given;
            out.linear() = given.linear().transpose();
            return out;
        }
        default:
            return given * axes_of(convention);
    }
}

double turn_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    const double trace = (a.linear().transpose() * b.linear()).trace();
    return std::acos(std::clamp((trace - 1) / 2, -1.0, 1.0));
}

double field_of_view(const Intrinsics& k) {
    return 2 * std::atan(std::min(k.width / k.fx, k.height / k.fy) / 2);
}

double share_of(std::uint64_t part, std::uint64_t of) {
    return of == 0 ? 0 : static_cast<double>(part) / static_cast<double>(of);
}

}  // namespace

Mat4 pose_meant(const Mat4& given, PoseConvention convention) {
    return pose_of(meant(isometry(given), convention));
}

double PoseComparison::Agreement::agreeing_share() const {
    return share_of(agreeing, compared);
}

double PoseComparison::Agreement::before_share() const {
    return share_of(before, compared);
}

double PoseComparison::Agreement::common_share() const {
    return share_of(agreeing, carried);
}

PoseComparison::PoseComparison(const Intrinsics& intrinsics, std::span<const Mat4> poses,
                               double typical_depth_m)
    : intrinsics_(intrinsics),
      step_(std::max(1U, std::max(intrinsics.width, intrinsics.height) / kept_columns)),
      width_((intrinsics.width - 1) / step_ + 1),
      height_((intrinsics.height - 1) / step_ + 1),
      poses_(poses.begin(), poses.end()) {
    choose_pairs(typical_depth_m);
    choose_same_poses();
    std::vector<std::size_t> numbers = same_;
    for (const Pair& pair : pairs_) numbers.insert(numbers.end(), {pair.a, pair.b});
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    for (const std::size_t number : numbers) kept_.push_back({number, {}});
}

void PoseComparison::choose_pairs(double typical_depth_m) {
    const double least = turn_share * field_of_view(intrinsics_);
    // How far apart frames are depends on what their poses mean, but for the camera's axes.
    for (const PoseConvention convention :
         {PoseConvention::camera_to_world, PoseConvention::world_to_camera,
          PoseConvention::w_first}) {
        std::vector<Eigen::Isometry3d> cameras;
        for (const Mat4& pose : poses_) cameras.push_back(meant(isometry(pose), convention));
        const std::size_t count = std::min(anchors, cameras.size());
        for (std::size_t n = 0; n < count; ++n) {
            const std::size_t a = count == 1 ? 0 : n * (cameras.size() - 1) / (count - 1);
            double nearest_turned = std::numeric_limits<double>::infinity();
            double nearest_moved = nearest_turned;
            std::optional<std::size_t> best_turned, best_moved;
            for (std::size_t b = 0; b < cameras.size(); ++b) {
                const double angle = turn_between(cameras[a], cameras[b]);
                const double way = (cameras[a].translation() - cameras[b].translation()).norm();
                if (angle >= least && angle <= 2 * least && way < nearest_turned) {
                    nearest_turned = way;
                    best_turned = b;
                } else if (angle < least && way >= least * typical_depth_m &&
                           way <= 2 * least * typical_depth_m && way < nearest_moved) {
                    nearest_moved = way;
                    best_moved = b;
                }
            }
            if (const auto b = best_turned ? best_turned : best_moved)
                pairs_.push_back({std::min(a, *b), std::max(a, *b)});
        }
    }
    const auto key = [](const Pair& pair) { return std::pair(pair.a, pair.b); };
    std::sort(pairs_.begin(), pairs_.end(),
              [&](const Pair& p, const Pair& q) { return key(p) < key(q); });
    pairs_.erase(std::unique(pairs_.begin(), pairs_.end(),
                             [&](const Pair& p, const Pair& q) { return key(p) == key(q); }),
                 pairs_.end());
}

void PoseComparison::choose_same_poses() {
    std::map<Mat4, std::vector<std::size_t>> of_pose;
    for (std::size_t n = 0; n < poses_.size(); ++n) of_pose[poses_[n]].push_back(n);
    for (const auto& [pose, frames] : of_pose) {
        if (frames.size() < 2 || 2 * frames.size() < poses_.size() || frames.size() <= same_poses_)
            continue;
        same_poses_ = frames.size();
        const std::size_t count = std::min(anchors, frames.size());
        same_.clear();
        for (std::size_t n = 0; n < count; ++n)
            same_.push_back(frames[n * (frames.size() - 1) / (count - 1)]);
    }
}

void PoseComparison::add(const DepthFrame& frame, std::size_t number) {
    const auto at =
        std::lower_bound(kept_.begin(), kept_.end(), number,
                         [](const Kept& kept, std::size_t wanted) { return kept.number < wanted; });
    if (at == kept_.end() || at->number != number) return;
    at->depth.clear();
    at->depth.reserve(std::size_t{width_} * height_);
    for (std::uint32_t v = 0; v < intrinsics_.height; v += step_)
        for (std::uint32_t u = 0; u < intrinsics_.width; u += step_)
            at->depth.push_back(frame.depth[std::size_t{v} * intrinsics_.width + u]);
}

const PoseComparison::Kept* PoseComparison::kept(std::size_t number) const {
    const auto at =
        std::lower_bound(kept_.begin(), kept_.end(), number,
                         [](const Kept& one, std::size_t wanted) { return one.number < wanted; });
    return at == kept_.end() || at->number != number || at->depth.empty() ? nullptr : &*at;
}

void PoseComparison::carry(const Kept& from, const Kept& to, const Mat4& to_from_from,
                           Agreement& into) const {
    constexpr double sigmas = 3, near_m = 0.05;
    // Two readings of one surface differ by no more than this share of their depth; beyond that and
    // their noise there is an edge between them.
    constexpr double edge_share = 0.05;
    const Intrinsics& k = intrinsics_;
    const Eigen::Isometry3d turn = isometry(to_from_from);
    const std::uint32_t stride = std::max(1U, width_ / carried_columns);
    for (std::uint32_t row = 0; row < height_; row += stride) {
        for (std::uint32_t column = 0; column < width_; column += stride) {
            const std::uint16_t stored = from.depth[std::size_t{row} * width_ + column];
            if (stored == 0) continue;
            ++into.carried;
            const double z = stored / k.depth_scale;
            const Eigen::Vector3d p = turn * Eigen::Vector3d((column * step_ - k.cx) / k.fx * z,
                                                             (row * step_ - k.cy) / k.fy * z, z);
            if (!(p.z() > near_m)) continue;
            const double u = (p.x() / p.z() * k.fx + k.cx) / step_;
            const double v = (p.y() / p.z() * k.fy + k.cy) / step_;
            if (!(u >= 0 && v >= 0 && u < width_ - 1.0 && v < height_ - 1.0)) continue;
            const std::size_t at =
                static_cast<std::size_t>(v) * width_ + static_cast<std::size_t>(u);
            const auto [least, most] = std::minmax(
                {to.depth[at], to.depth[at + 1], to.depth[at + width_], to.depth[at + width_ + 1]});
            if (least == 0) continue;
            const double low = least / k.depth_scale, high = most / k.depth_scale;
            const double noise = std::min(
                sigmas * std::hypot(depth_sigma(p.z()), depth_sigma(high)), edge_share * p.z());
            if (high - low > edge_share * high + 2 * noise) continue;
            ++into.compared;
            into.agreeing += p.z() >= low - noise && p.z() <= high + noise;
            into.before += p.z() < low - noise;
        }
    }
}

namespace {

using Agreements = std::array<PoseComparison::Agreement, pose_conventions>;

std::vector<PoseConvention> better_than_given(const Agreements& found) {
    const auto common = [&](std::size_t n) { return found[n].common_share(); };
    std::vector<std::size_t> order;
    for (std::size_t n = 0; n < pose_conventions; ++n) order.push_back(n);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return common(a) > common(b); });
    const PoseComparison::Agreement &best = found[order[0]], &given = found[0];
    if (best.agreeing_share() < least_agreeing || best.common_share() < least_common ||
        given.agreeing_share() > most_given_agreeing * best.agreeing_share() ||
        given.common_share() > most_given_common * best.common_share())
        return {};
    std::vector<PoseConvention> out;
    for (const std::size_t n : order)
        if (common(n) >= as_good * best.common_share())
            out.push_back(static_cast<PoseConvention>(n));
    return out;
}

}  // namespace

PoseComparison::Verdict PoseComparison::verdict() const {
    Verdict out;
    for (const Pair& pair : pairs_) {
        const Kept *a = kept(pair.a), *b = kept(pair.b);
        if (!a || !b) continue;
        ++out.pairs;
        for (std::size_t n = 0; n < pose_conventions; ++n) {
            const auto convention = static_cast<PoseConvention>(n);
            const Eigen::Isometry3d to_b = meant(isometry(poses_[pair.b]), convention).inverse() *
                                           meant(isometry(poses_[pair.a]), convention);
            carry(*a, *b, pose_of(to_b), out.agreement[n]);
            carry(*b, *a, pose_of(to_b.inverse()), out.agreement[n]);
        }
    }
    out.frames = poses_.size();
    out.same_poses = same_poses_;
    const Mat4 stays = pose_of(Eigen::Isometry3d::Identity());
    for (std::size_t n = 1; n < same_.size(); ++n) {
        const Kept *a = kept(same_[n - 1]), *b = kept(same_[n]);
        if (!a || !b) continue;
        carry(*a, *b, stays, out.at_one_pose);
        carry(*b, *a, stays, out.at_one_pose);
    }
    out.moved = share_of(out.at_one_pose.compared, out.at_one_pose.carried) >= least_compared &&
                out.at_one_pose.agreeing_share() < most_of_moved;
    out.better = better_than_given(out.agreement);
    const Agreement& given = out.agreement[0];
    out.contradict = out.pairs >= least_compared_pairs &&
                     share_of(given.compared, given.carried) >= least_compared &&
                     given.agreeing_share() < least_agreeing && given.before_share() > most_before;
    return out;
}

}  // namespace topple::geometry

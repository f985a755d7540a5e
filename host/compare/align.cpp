// SPDX-License-Identifier: MIT
#include "compare/align.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compare/eigen.h"
#include "compare/overlay.h"
#include "compare/refine.h"
#include "core/short_number.h"
#include "points/formats/rigid_pose.h"
#include "topple/error.h"

namespace topple::comparing {
namespace {

using Points = std::vector<SurfacePoint>;
using Motion = Eigen::Isometry3d;

Motion motion_of(const Mat4& m) {
    Mat4 copy = m;
    Motion out;
    out.matrix() = io::RowMajorPose(copy.data());
    return out;
}
Motion quarters(int count) {
    Motion out = Motion::Identity();
    out.rotate(Eigen::AngleAxisd(count * M_PI / 2, Eigen::Vector3d::UnitZ()));
    return out;
}

// Where surfaces across an axis lie along it, apart by the way they face.
class Profile {
  public:
    Profile(const Points& points, const Motion& turn, int axis) {
        for (const SurfacePoint& point : points) {
            if (!point.building) continue;
            const double facing = (turn.linear() * mapped(point.normal))[axis];
            constexpr double across = 0.9;
            if (std::abs(facing) < across) continue;
            const double at = (turn * mapped(point.place_m))[axis];
            places_[facing > 0 ? 1 : 0].push_back(static_cast<int>(std::floor(at / bin_m)));
        }
        for (std::vector<int>& side : places_) {
            std::ranges::sort(side);
            for (std::size_t first = 0, next; first < side.size(); first = next) {
                next = first;
                while (next < side.size() && side[next] == side[first]) ++next;
                counts_[&side == &places_[1] ? 1 : 0].emplace_back(
                    side[first], std::sqrt(static_cast<double>(next - first)));
            }
        }
    }
    // Shifts of the other one that lay most of it on this, metres, the best first.
    std::vector<double> shifts(const Profile& other) const {
        std::map<int, double> fits;
        for (std::size_t side = 0; side < 2; ++side)
            for (const auto& [bin, count] : counts_[side])
                for (const auto& [from, many] : other.counts_[side])
                    fits[bin - from] += count * many;
        std::vector<std::pair<double, int>> best;
        for (const auto& [shift, fit] : fits) best.emplace_back(-fit, shift);
        std::ranges::sort(best);
        std::vector<double> out;
        for (const auto& [fit, shift] : best) {
            const double at = shift * bin_m;
            if (std::ranges::any_of(out,
                                    [&](double taken) { return std::abs(taken - at) < apart_m; }))
                continue;
            out.push_back(at);
            constexpr std::size_t most = 8;
            if (out.size() == most) break;
        }
        if (out.empty()) out.push_back(0);
        return out;
    }

  private:
    static constexpr double bin_m = 0.05, apart_m = 0.12;
    std::array<std::vector<int>, 2> places_;
    std::array<std::vector<std::pair<int, double>>, 2> counts_;
};

// Surfaces and free space in coarse cells, to try many motions.
class CoarseRoom {
  public:
    explicit CoarseRoom(const Side& side) : space_(side.space) {
        for (const SurfacePoint& point : side.surface) {
            const Cell at = cell_of(mapped(point.place_m));
            for (std::int64_t i = -1; i <= 1; ++i)
                for (std::int64_t j = -1; j <= 1; ++j)
                    for (std::int64_t k = -1; k <= 1; ++k)
                        near_.insert({at[0] + i, at[1] + j, at[2] + k});
        }
        for (std::size_t n = 0; n < side.surface.size(); n += 1 + side.surface.size() / most_tried)
            tried_.push_back(side.surface[n].place_m);
    }
    // How much of the other's surface lies on this one's, less what lies in its free space.
    double fit(const CoarseRoom& other, const Motion& motion) const {
        double sum = 0;
        for (const Vec3& place : other.tried_) {
            const Eigen::Vector3d at = motion * mapped(place);
            if (near_.contains(cell_of(at)))
                ++sum;
            else
                sum -= space_.at({at.x(), at.y(), at.z()}) == SeenSpace::free;
        }
        return sum / std::max(1.0, static_cast<double>(other.tried_.size()));
    }

  private:
    using Cell = std::array<std::int64_t, 3>;
    static constexpr std::size_t most_tried = 1500;
    static Cell cell_of(const Eigen::Vector3d& at) {
        constexpr double cell_m = 0.08;
        return {static_cast<std::int64_t>(std::floor(at.x() / cell_m)),
                static_cast<std::int64_t>(std::floor(at.y() / cell_m)),
                static_cast<std::int64_t>(std::floor(at.z() / cell_m))};
    }
    const SeenSpace& space_;
    std::set<Cell> near_;
    std::vector<Vec3> tried_;
};

// The likeliest motions, a few of each of the four turns.
std::vector<Motion> guesses(const Side& a, const Side& b, const std::function<void()>& poll) {
    const CoarseRoom on(a), from(b);
    const std::array profiles_a{Profile(a.surface, Motion::Identity(), 0),
                                Profile(a.surface, Motion::Identity(), 1),
                                Profile(a.surface, Motion::Identity(), 2)};
    std::vector<Motion> out;
    for (int turn = 0; turn < 4; ++turn) {
        poll();
        const Motion turned = quarters(turn);
        std::array<std::vector<double>, 3> shifts;
        for (int axis = 0; axis < 3; ++axis)
            shifts[static_cast<std::size_t>(axis)] =
                profiles_a[static_cast<std::size_t>(axis)].shifts(Profile(b.surface, turned, axis));
        std::vector<std::pair<double, Eigen::Vector3d>> tried;
        for (const double x : shifts[0])
            for (const double y : shifts[1])
                for (const double z : shifts[2]) {
                    Motion motion = Motion::Identity();
                    motion.translate(Eigen::Vector3d(x, y, z));
                    motion = motion * turned;
                    tried.emplace_back(on.fit(from, motion), Eigen::Vector3d(x, y, z));
                }
        std::ranges::stable_sort(tried, std::greater(), [](const auto& one) { return one.first; });
        constexpr std::size_t most = 2;
        for (std::size_t n = 0; n < std::min(most, tried.size()); ++n) {
            Motion motion = Motion::Identity();
            motion.translate(tried[n].second);
            out.push_back(motion * turned);
        }
    }
    return out;
}

bool are_one(const Motion& a, const Motion& b) {
    constexpr double apart_m = 0.15, apart_rad = 0.15;
    const Motion between = a.inverse() * b;
    return between.translation().norm() < apart_m &&
           Eigen::AngleAxisd(between.linear()).angle() < apart_rad;
}

struct Laid {
    Motion motion;
    Overlay overlay;
    double error_m;
};

Mat4 pose_of(const Motion& motion) {
    Mat4 out{};
    io::RowMajorPose pose(out.data());
    pose = motion.matrix();
    return out;
}

std::string percent(double share) {
    return short_number(std::round(100 * share)) + " %";
}

}  // namespace

Alignment align(const Side& a, const Side& b, const std::function<void()>& poll) {
    const auto building = [](const Side& side) {
        Points out;
        std::ranges::copy_if(side.surface, std::back_inserter(out), &SurfacePoint::building);
        return out;
    };
    const Points of_a = building(a), of_b = building(b);
    const Refinement refinement(of_a);
    const auto lay = [&](const Motion& guess) -> Laid {
        poll();
        const Refinement::Refined refined = refinement.refine(of_b, guess);
        return {refined.motion, overlay(a, b, refined.motion), refined.error_m};
    };
    const Motion grid_a = motion_of(a.scene.manhattan_from_input),
                 grid_b = motion_of(b.scene.manhattan_from_input);
    Motion offset = Motion::Identity();
    offset.translate(mapped(b.scene.offset_m) - mapped(a.scene.offset_m));
    const Laid as_they_are = lay(grid_a * offset * grid_b.inverse());
    std::vector<Laid> all;
    for (const Motion& guess : guesses(a, b, poll)) all.push_back(lay(guess));
    std::ranges::stable_sort(all, std::greater(),
                             [](const Laid& one) { return one.overlay.score(); });

    constexpr double as_good = 0.05, least_agreeing = 0.7, least_seen = 0.2;
    const bool same_frame =
        all.empty() || as_they_are.overlay.score() >= all.front().overlay.score() - as_good;
    const Laid& best = same_frame ? as_they_are : all.front();
    const auto next = std::ranges::find_if(
        all, [&](const Laid& one) { return !are_one(one.motion, best.motion); });
    const std::string both = a.scene.source + " and " + b.scene.source;
    if (best.overlay.agreeing() < least_agreeing || best.overlay.seen() < least_seen)
        throw Error(ErrorKind::input, both + ": the rooms do not match: as they fit best, " +
                                          percent(best.overlay.seen()) +
                                          " of their surfaces lie where the other scan saw, and " +
                                          percent(best.overlay.agreeing()) +
                                          " of these are surface there (at least " +
                                          percent(least_seen) + " and " + percent(least_agreeing) +
                                          "); compare two scans of one room");
    if (!same_frame && next != all.end() && next->overlay.score() >= best.overlay.score() - as_good)
        throw Error(ErrorKind::input, both + ": the rooms fit in two ways about as well (" +
                                          percent(best.overlay.agreeing()) + " and " +
                                          percent(next->overlay.agreeing()) +
                                          " of surfaces agree); give both scans in one frame");
    Alignment out;
    out.a_from_b = pose_of(grid_a.inverse() * best.motion * grid_b);
    out.same_frame = same_frame;
    out.agreeing = best.overlay.agreeing();
    out.seen = best.overlay.seen();
    out.next_agreeing = next == all.end() ? 0 : next->overlay.agreeing();
    out.error_m = best.error_m;
    return out;
}

}  // namespace topple::comparing

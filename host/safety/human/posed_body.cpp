// SPDX-License-Identifier: MIT
#include "safety/human/posed_body.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/ranked.h"
#include "safety/human/human_field.h"
#include "topple/error.h"

namespace topple::safety {
namespace {

using enum BodyJoint;

constexpr double smooth_s = 0.08;  // over which positions are averaged, against noise
constexpr double walk_s = 0.5;     // over which the body's own way is averaged

// Means over `window` frames around each.
std::vector<Vec3> smoothed(const std::vector<Vec3>& track, std::size_t window) {
    const std::size_t n = track.size(), half = window / 2;
    std::vector<Vec3> sums(n + 1, Vec3{});
    for (std::size_t f = 0; f < n; ++f) {
        for (std::size_t c = 0; c < 3; ++c) sums[f + 1][c] = sums[f][c] + track[f][c];
    }
    std::vector<Vec3> out(n);
    for (std::size_t f = 0; f < n; ++f) {
        // As far to both sides, so that a steady motion stays where it is.
        const std::size_t reach = std::min({half, f, n - 1 - f});
        const auto count = static_cast<double>(2 * reach + 1);
        for (std::size_t c = 0; c < 3; ++c)
            out[f][c] = (sums[f + reach + 1][c] - sums[f - reach][c]) / count;
    }
    return out;
}

std::size_t frames_of(double seconds, const BodyMotion& motion) {
    return static_cast<std::size_t>(std::lround(seconds / motion.step_s)) | 1;
}

class Poser {
  public:
    Poser(const BodyMotion& motion, const HumanOptions& options)
        : motion_(motion), options_(options) {
        frames_ = motion.frames();
        for (std::size_t j = 0; j < body_joint_count; ++j) {
            if (motion.track[j].empty()) continue;
            if (motion.track[j].size() != frames_)
                refuse_motion(motion, "its joints were recorded for different numbers of frames");
            track_[j] = smoothed(motion.track[j], frames_of(smooth_s, motion));
        }
        if (frames_ < 3 || !(motion.step_s > 0)) refuse_motion(motion, "holds no motion");
    }

    PosedBody posed() const {
        const std::vector<Vec3> center = smoothed(body_center(), frames_of(walk_s, motion_));
        const std::vector<Vec3> left = smoothed(body_left(), frames_of(walk_s, motion_));
        const double floor = floor_m();
        PosedBody out;
        out.frames = frames_ - 2;
        for (std::size_t j = 0; j < body_joint_count; ++j) {
            if (track_[j].empty()) continue;
            for (std::size_t f = 1; f + 1 < frames_; ++f) {
                const double length = std::hypot(left[f][0], left[f][1]);
                if (!(length > 0)) refuse_motion(motion_, "its left and right are at one place");
                const std::array<double, 2> l{left[f][0] / length, left[f][1] / length};
                const auto turned = [&](double x, double y, double z) {
                    return Vec3{x * l[1] - y * l[0], x * l[0] + y * l[1], z};
                };
                const Vec3& p = track_[j][f];
                const auto rate = [&](const std::vector<Vec3>& of, std::size_t c) {
                    return (of[f + 1][c] - of[f - 1][c]) / (2 * motion_.step_s);
                };
                out.place[j].push_back(
                    turned(p[0] - center[f][0], p[1] - center[f][1], p[2] - floor));
                Vec3 v = turned(rate(track_[j], 0) - rate(center, 0),
                                rate(track_[j], 1) - rate(center, 1), rate(track_[j], 2));
                v[0] += options_.walking_speed_m_s;
                out.velocity[j].push_back(v);
            }
        }
        return out;
    }

  private:
    const std::vector<Vec3>& track(BodyJoint joint) const {
        return track_[static_cast<std::size_t>(joint)];
    }
    std::vector<Vec3> middle(BodyJoint a, BodyJoint b) const {
        std::vector<Vec3> out;
        if (track(a).empty() || track(b).empty()) return out;
        for (std::size_t f = 0; f < frames_; ++f) {
            out.push_back({(track(a)[f][0] + track(b)[f][0]) / 2,
                           (track(a)[f][1] + track(b)[f][1]) / 2,
                           (track(a)[f][2] + track(b)[f][2]) / 2});
        }
        return out;
    }
    std::vector<Vec3> body_center() const {
        if (!track(pelvis).empty()) return track(pelvis);
        for (const auto& [a, b] : {std::pair{left_hip, right_hip},
                                   {left_shoulder, right_shoulder},
                                   {left_elbow, right_elbow}}) {
            auto out = middle(a, b);
            if (!out.empty()) return out;
        }
        refuse_motion(motion_,
                      "has no pelvis, and no pair of hips, shoulders or elbows: where the body "
                      "is can't be told");
    }
    // From its right to its left.
    std::vector<Vec3> body_left() const {
        for (const auto& [a, b] : {std::pair{left_shoulder, right_shoulder},
                                   {left_hip, right_hip},
                                   {left_elbow, right_elbow},
                                   {left_wrist, right_wrist}}) {
            if (track(a).empty() || track(b).empty()) continue;
            std::vector<Vec3> out;
            for (std::size_t f = 0; f < frames_; ++f) {
                out.push_back(
                    {track(a)[f][0] - track(b)[f][0], track(a)[f][1] - track(b)[f][1], 0});
            }
            return out;
        }
        refuse_motion(motion_,
                      "has no pair of shoulders, hips, elbows or wrists: where the body faces "
                      "can't be told");
    }
    // Its own floor, or that of a body of the recorded size (fractions as in body_parts.h).
    double floor_m() const {
        const double stature =
            motion_.stature_m() > 0 ? motion_.stature_m() : options_.body_height_m;
        struct Height {
            BodyJoint joint;
            double share;
            bool lowest;
        };
        for (const Height& h : {Height{left_toes, 0.01, true},
                                {right_toes, 0.01, true},
                                {left_ankle, 0.039, true},
                                {right_ankle, 0.039, true},
                                {pelvis, 0.53, false},
                                {left_hip, 0.53, false},
                                {left_shoulder, 0.818, false},
                                {right_shoulder, 0.818, false},
                                {left_elbow, 0.63, false}}) {
            if (track(h.joint).empty()) continue;
            std::vector<double> heights;
            for (const Vec3& p : track(h.joint)) heights.push_back(p[2]);
            return ranked(heights, h.lowest ? heights.size() / 50 : heights.size() / 2) -
                   h.share * stature;
        }
        refuse_motion(motion_,
                      "has no feet, hips, shoulders or elbows: how high it is can't be told");
    }

    const BodyMotion& motion_;
    const HumanOptions& options_;
    std::size_t frames_ = 0;
    std::array<std::vector<Vec3>, body_joint_count> track_;
};

}  // namespace

PosedBody posed_body(const BodyMotion& motion, const HumanOptions& options) {
    return Poser(motion, options).posed();
}

void refuse_motion(const BodyMotion& motion, const std::string& what) {
    throw Error(ErrorKind::input,
                (motion.source.empty() ? "the recorded motion" : motion.source) + ": " + what);
}

}  // namespace topple::safety

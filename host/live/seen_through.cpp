// SPDX-License-Identifier: MIT
#include "live/seen_through.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/depth_noise.h"

namespace topple::live {
namespace {

constexpr double most_turned_cosine = 0.5, most_moved_m = 4;
// Looks that decide, the first ones.
constexpr int most_looks = 3;
// Deviations of a reading beyond which it is another place, and what poses are off besides.
constexpr float sure = 3, pose_error_m = 0.03F;
// Frames fit where one sees through at most so much of what both show: else it is poses that are
// off. What was taken away is a smaller part.
constexpr double most_seen_through = 0.25;
// And where a correction has not made that more, by so much of what both show, of which they showed
// at least so much before.
constexpr double most_worse = 0.01, least_before = 0.5;

}  // namespace

bool look_alike(const Projection& by, const Mat4& a, const Mat4& b) {
    const double cosine = a[2] * b[2] + a[6] * b[6] + a[10] * b[10];
    const double moved = std::hypot(a[3] - b[3], a[7] - b[7], a[11] - b[11]);
    return (by.is_around() || cosine >= most_turned_cosine) && moved <= most_moved_m;
}

struct Looks::Camera {
    explicit Camera(const Mat4& pose) {
        for (std::size_t n = 0; n < 12; ++n) m[n] = static_cast<float>(pose[n]);
    }
    std::array<float, 3> world(float x, float y, float z) const {
        return {m[0] * x + m[1] * y + m[2] * z + m[3], m[4] * x + m[5] * y + m[6] * z + m[7],
                m[8] * x + m[9] * y + m[10] * z + m[11]};
    }
    std::array<float, 3> seen(const std::array<float, 3>& p) const {
        const float x = p[0] - m[3], y = p[1] - m[7], z = p[2] - m[11];
        return {m[0] * x + m[4] * y + m[8] * z, m[1] * x + m[5] * y + m[9] * z,
                m[2] * x + m[6] * y + m[10] * z};
    }
    // Where a pixel's reading lies.
    std::array<float, 3> place(const Projection& by, std::size_t u, std::size_t v, double z) const {
        const auto [x, y, ahead] = by.place(u, v, z);
        return world(x, y, ahead);
    }
    std::array<float, 12> m{};
};

namespace {

enum class Look : std::uint8_t { none, same, through };

// What a frame says of a place, in its sensor's axes.
Look look_at(const Projection& by, const std::vector<std::uint16_t>& nearest,
             const std::array<float, 3>& place) {
    const auto seen = by.see(place);
    if (!seen) return Look::none;
    const std::uint16_t stored = nearest[seen->pixel];
    if (stored == 0) return Look::none;
    const float reading = static_cast<float>(stored / by.depth_scale());
    const float margin = sure * depth_sigma(reading) + pose_error_m;
    if (reading > seen->depth_m + margin) return Look::through;
    return reading < seen->depth_m - margin ? Look::none : Look::same;
}

}  // namespace

Looks::Looks(const Projection& projection, std::span<const DepthFrame> frames, ThreadPool& threads,
             std::vector<std::optional<Mat4>> earlier)
    : projection_(projection),
      frames_(frames),
      threads_(threads),
      earlier_(std::move(earlier)),
      nearest_(frames.size()) {
    earlier_.resize(frames_.size());
    threads_.each(frames_.size(), 1, [&](std::size_t n) {
        nearest_[n] = projection_.nearest_around(frames_[n].depth);
    });
}

// Of a frame's readings, sampled, those whose place another one does not hide, with these poses.
Looks::Shared Looks::shared(std::size_t frame, const Camera& camera, std::size_t other,
                            const Camera& from) const {
    constexpr std::uint32_t step = 4;
    const Projection& by = projection_;
    Shared out;
    for (std::uint32_t v = 0; v < by.height(); v += step) {
        for (std::uint32_t u = 0; u < by.width(); u += step) {
            const std::uint16_t stored = frames_[frame].depth[std::size_t{v} * by.width() + u];
            if (stored == 0) continue;
            const Look look = look_at(by, nearest_[other],
                                      from.seen(camera.place(by, u, v, stored / by.depth_scale())));
            if (look == Look::none) continue;
            out.through += look == Look::through;
            ++out.seen;
        }
    }
    return out;
}

bool Looks::fit(std::size_t frame, std::size_t other) const {
    const Shared now = shared(frame, Camera(frames_[frame].camera_to_world), other,
                              Camera(frames_[other].camera_to_world));
    if (now.through > most_seen_through * now.seen) return false;
    if (!earlier_[frame] || !earlier_[other]) return true;
    const Shared before = shared(frame, Camera(*earlier_[frame]), other, Camera(*earlier_[other]));
    // Of frames that looked elsewhere nothing was known.
    if (before.seen < least_before * now.seen) return true;
    return now.through * before.seen <= (before.through + most_worse * before.seen) * now.seen;
}

std::vector<Looked> Looks::look(const Asked& asked) const {
    const Projection& by = projection_;
    std::vector<Camera> cameras;
    for (const DepthFrame& frame : frames_) cameras.emplace_back(frame.camera_to_world);
    struct Tally {
        int looks = 0, through = 0;
        void add(Look look) {
            if (looks == most_looks) return;
            ++looks;
            through += look == Look::through;
        }
        Says says() const {
            if (2 * through == looks) return Says::nothing;
            return 2 * through > looks ? Says::through : Says::same;
        }
    };
    struct Other {
        std::size_t frame;
        bool fits;
    };
    std::vector<Looked> out(frames_.size());
    threads_.each(frames_.size(), 1, [&](std::size_t n) {
        const auto [first, last] = asked(n);
        out[n].says.resize(by.pixels());
        std::vector<Other> others;
        for (std::size_t other = last; other-- > first && others.size() < most_asked;)
            if (look_alike(by, frames_[n].camera_to_world, frames_[other].camera_to_world))
                others.push_back({other, fit(n, other)});
        for (std::uint32_t v = 0; v < by.height(); ++v) {
            for (std::uint32_t u = 0; u < by.width(); ++u) {
                const std::uint16_t stored = frames_[n].depth[std::size_t{v} * by.width() + u];
                if (stored == 0) continue;
                const auto place = cameras[n].place(by, u, v, stored / by.depth_scale());
                Tally all, fitting;
                for (const Other& other : others) {
                    const Look look =
                        look_at(by, nearest_[other.frame], cameras[other.frame].seen(place));
                    if (look == Look::none) continue;
                    all.add(look);
                    if (other.fits) fitting.add(look);
                    if (fitting.looks == most_looks) break;
                }
                if (all.says() == Says::through)
                    out[n].through.push_back(
                        {u, v, stored, static_cast<std::uint8_t>(all.through)});
                out[n].says[std::size_t{v} * by.width() + u] = fitting.says();
            }
        }
    });
    return out;
}

}  // namespace topple::live

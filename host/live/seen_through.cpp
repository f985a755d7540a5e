// SPDX-License-Identifier: MIT
#include "live/seen_through.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/depth_noise.h"

namespace topple::live {
namespace {

// Frames that are asked, of those that look the same way.
constexpr std::size_t most_asked = 16;
constexpr double most_turned_cosine = 0.5, most_moved_m = 4;
// Looks that decide, the first ones.
constexpr int most_looks = 3;
// Deviations of a reading beyond which it is another place, and what poses are off besides.
constexpr float sure = 3, pose_error_m = 0.03F;

struct Camera {
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
    std::array<float, 12> m{};
};

bool look_alike(const Camera& a, const Camera& b) {
    const double cosine = a.m[2] * b.m[2] + a.m[6] * b.m[6] + a.m[10] * b.m[10];
    const double moved = std::hypot(a.m[3] - b.m[3], a.m[7] - b.m[7], a.m[11] - b.m[11]);
    return cosine >= most_turned_cosine && moved <= most_moved_m;
}

std::vector<std::uint16_t> nearest_around(const Intrinsics& k, const DepthFrame& frame) {
    const std::size_t width = k.width, height = k.height;
    std::vector<std::uint16_t> out(frame.depth.size(), 0);
    for (std::size_t v = 1; v + 1 < height; ++v)
        for (std::size_t u = 1; u + 1 < width; ++u) {
            std::uint16_t least = 65535;
            for (std::size_t row = v - 1; row <= v + 1; ++row)
                for (std::size_t column = u - 1; column <= u + 1; ++column)
                    least = std::min(least, frame.depth[row * width + column]);
            out[v * width + u] = least;
        }
    return out;
}

enum class Look : std::uint8_t { none, same, through };

// What a frame says of a place.
Look look_at(const Intrinsics& k, const Camera& camera, const std::vector<std::uint16_t>& nearest,
             const std::array<float, 3>& place) {
    const auto [x, y, z] = camera.seen(place);
    if (!(z > 0)) return Look::none;
    const auto u =
        static_cast<int>(std::lround(x / z * static_cast<float>(k.fx) + static_cast<float>(k.cx)));
    const auto v =
        static_cast<int>(std::lround(y / z * static_cast<float>(k.fy) + static_cast<float>(k.cy)));
    if (u < 0 || v < 0 || u >= static_cast<int>(k.width) || v >= static_cast<int>(k.height))
        return Look::none;
    const std::uint16_t stored =
        nearest[static_cast<std::size_t>(v) * k.width + static_cast<std::size_t>(u)];
    if (stored == 0) return Look::none;
    const float reading = static_cast<float>(stored / k.depth_scale);
    const float margin = sure * depth_sigma(reading) + pose_error_m;
    if (reading > z + margin) return Look::through;
    return reading < z - margin ? Look::none : Look::same;
}

}  // namespace

Looks::Looks(const Intrinsics& intrinsics, std::span<const DepthFrame> frames, ThreadPool& threads)
    : intrinsics_(intrinsics), frames_(frames), threads_(threads), nearest_(frames.size()) {
    threads_.each(frames_.size(), 1,
                  [&](std::size_t n) { nearest_[n] = nearest_around(intrinsics_, frames_[n]); });
}

std::vector<Gone> Looks::seen_through(const Asked& asked) const {
    const Intrinsics& k = intrinsics_;
    std::vector<Camera> cameras;
    for (const DepthFrame& frame : frames_) cameras.emplace_back(frame.camera_to_world);
    const auto through_at = [&](const std::vector<std::size_t>& others,
                                const std::array<float, 3>& place) {
        int looks = 0, through = 0;
        for (const std::size_t other : others) {
            const Look look = look_at(k, cameras[other], nearest_[other], place);
            if (look == Look::none) continue;
            through += look == Look::through;
            if (++looks == most_looks) break;
        }
        return static_cast<std::uint8_t>(2 * through > looks ? through : 0);
    };
    std::vector<Gone> out(frames_.size());
    threads_.each(frames_.size(), 1, [&](std::size_t n) {
        const auto [first, last] = asked(n);
        std::vector<std::size_t> others;
        for (std::size_t other = last; other-- > first && others.size() < most_asked;)
            if (look_alike(cameras[n], cameras[other])) others.push_back(other);
        for (std::uint32_t v = 0; v < k.height; ++v) {
            for (std::uint32_t u = 0; u < k.width; ++u) {
                const std::uint16_t stored = frames_[n].depth[std::size_t{v} * k.width + u];
                if (stored == 0) continue;
                const double z = stored / k.depth_scale;
                const auto place = cameras[n].world(static_cast<float>(z * (u - k.cx) / k.fx),
                                                    static_cast<float>(z * (v - k.cy) / k.fy),
                                                    static_cast<float>(z));
                if (const auto through = through_at(others, place); through > 0)
                    out[n].push_back({u, v, stored, through});
            }
        }
    });
    return out;
}

}  // namespace topple::live

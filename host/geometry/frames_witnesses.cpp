// SPDX-License-Identifier: MIT
#include "geometry/frames_witnesses.h"

#include <algorithm>
#include <cmath>

#include "core/depth_noise.h"

namespace topple::geometry {
namespace {

constexpr std::uint32_t most_columns = 320;
constexpr std::uint64_t points_at_once = 1 << 12;
// Nearer to a camera no sensor reads.
constexpr float nearest_m = 0.2F;
// How far poses that agree are off, and deviations of a reading from the surface that it is of. A
// point is seen through only where all readings around say so, by more.
constexpr float pose_error_m = 0.005F, on_surface = 2, beyond_surface = 3;
// Deviations of the point's own best reading within which it may be a copy of what lies before it.
constexpr float copy = 4;

}  // namespace

Witnesses::Witnesses(const Intrinsics& k)
    : step_(std::max(1u, (k.width + most_columns - 1) / most_columns)),
      width_(k.width / step_),
      height_(k.height / step_),
      row_(k.width),
      fx_(static_cast<float>(k.fx / step_)),
      fy_(static_cast<float>(k.fy / step_)),
      cx_(static_cast<float>(k.cx / step_ + 0.5)),
      cy_(static_cast<float>(k.cy / step_ + 0.5)),
      metres_(static_cast<float>(1 / k.depth_scale)) {}

void Witnesses::add(const DepthFrame& frame) {
    const std::size_t number = seen_++;
    if (number % stride_ != 0) return;
    if (frames_.size() == most_frames) {
        for (std::size_t k = 1; 2 * k < frames_.size(); ++k) frames_[k] = std::move(frames_[2 * k]);
        frames_.resize((frames_.size() + 1) / 2);
        stride_ *= 2;
        if (number % stride_ != 0) return;
    }
    frames_.push_back(keep(frame));
}

Witnesses::Frame Witnesses::keep(const DepthFrame& frame) const {
    Frame kept;
    std::ranges::transform(frame.camera_to_world, kept.camera_to_world.begin(),
                           [](double value) { return static_cast<float>(value); });
    kept.pixels.resize(std::size_t{width_} * height_);
    const auto depth = [&](std::uint32_t u, std::uint32_t v) {
        return frame.depth[std::size_t{v} * step_ * row_ + std::size_t{u} * step_];
    };
    // Bounds of three in a row, then of three rows.
    std::vector<Pixel> rows(kept.pixels.size());
    for (std::uint32_t v = 0; v < height_; ++v) {
        for (std::uint32_t u = 0; u < width_; ++u) {
            const auto [least, greatest] = std::minmax(
                {depth(u > 0 ? u - 1 : u, v), depth(u, v), depth(std::min(u + 1, width_ - 1), v)});
            rows[std::size_t{v} * width_ + u] = {depth(u, v), least, greatest};
        }
    }
    for (std::uint32_t v = 0; v < height_; ++v) {
        const Pixel* above = &rows[std::size_t{v > 0 ? v - 1 : v} * width_];
        const Pixel* row = &rows[std::size_t{v} * width_];
        const Pixel* below = &rows[std::size_t{std::min(v + 1, height_ - 1)} * width_];
        for (std::uint32_t u = 0; u < width_; ++u) {
            const std::uint16_t least = std::min({above[u].least, row[u].least, below[u].least});
            const std::uint16_t greatest =
                std::max({above[u].greatest, row[u].greatest, below[u].greatest});
            kept.pixels[std::size_t{v} * width_ + u] = {row[u].depth, least,
                                                        least > 0 ? greatest : std::uint16_t{0}};
        }
    }
    return kept;
}

void Witnesses::project(const Frame& frame, const FusedPoints& points, std::size_t first,
                        Projected& out) const {
    // Copies: a compiler can't know that what is written is none of them.
    const std::array<float, 16> m = frame.camera_to_world;
    const float columns = static_cast<float>(width_), rows = static_cast<float>(height_);
    const float fx = fx_, fy = fy_, cx = cx_, cy = cy_;
    const auto width = static_cast<std::int32_t>(width_);
    const float *px = &points.x[first], *py = &points.y[first], *pz = &points.z[first];
    float* const depths = out.depth.data();
    std::int32_t* const pixels = out.pixel.data();
    for (std::size_t k = 0; k < out.depth.size(); ++k) {
        const float x = px[k] - m[3], y = py[k] - m[7], z = pz[k] - m[11];
        const float depth = m[2] * x + m[6] * y + m[10] * z;
        const float u = (m[0] * x + m[4] * y + m[8] * z) / depth * fx + cx;
        const float v = (m[1] * x + m[5] * y + m[9] * z) / depth * fy + cy;
        const bool in = (depth > nearest_m) & (u >= 0) & (v >= 0) & (u < columns) & (v < rows);
        depths[k] = depth;
        const auto row = static_cast<std::int32_t>(in ? v : 0.0f),
                   column = static_cast<std::int32_t>(in ? u : 0.0f);
        pixels[k] = in ? row * width + column : -1;
    }
}

void Witnesses::vote(const Frame& frame, const FusedPoints& points, std::size_t first,
                     Projected& at, std::vector<Votes>& votes) const {
    project(frame, points, first, at);
    for (std::size_t k = 0; k < votes.size(); ++k) {
        if (at.pixel[k] < 0) continue;
        const Pixel& seen = frame.pixels[static_cast<std::size_t>(at.pixel[k])];
        if (seen.depth == 0) continue;
        const float depth = at.depth[k];
        const float reading = metres_ * seen.depth, sigma = depth_sigma(reading);
        const float weight = 1 / (sigma * sigma);
        const float least = metres_ * seen.least, greatest = metres_ * seen.greatest;
        const bool through = least > depth + beyond_surface * sigma + pose_error_m;
        const bool copied = seen.least > 0 && greatest < depth &&
                            least > depth - copy * points.sigma[first + k] - pose_error_m;
        if (std::abs(reading - depth) <= on_surface * sigma + pose_error_m)
            votes[k].confirm += weight;
        else if (through || copied)
            votes[k].deny += weight;
    }
}

std::vector<std::uint8_t> Witnesses::deny(const FusedPoints& points, ThreadPool& pool) const {
    std::vector<std::uint8_t> denied(points.x.size());
    pool.run(points.x.size(), points_at_once, [&](std::uint64_t first, std::uint64_t last) {
        std::vector<Votes> votes(last - first);
        Projected at{std::vector<float>(last - first), std::vector<std::int32_t>(last - first)};
        for (const Frame& frame : frames_) vote(frame, points, first, at, votes);
        for (std::size_t k = 0; k < votes.size(); ++k)
            denied[first + k] = votes[k].deny > votes[k].confirm;
    });
    return denied;
}

}  // namespace topple::geometry

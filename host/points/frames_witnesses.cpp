// SPDX-License-Identifier: MIT
#include "points/frames_witnesses.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/depth_noise.h"
#include "geometry/cell_grid.h"

namespace topple::geometry {
namespace {

constexpr std::uint32_t most_columns = 320;
constexpr std::uint64_t points_at_once = 1 << 16;
constexpr std::size_t most_together = 1 << 10;  // of these, in one cube
// Nearer to a camera no sensor reads.
constexpr float nearest_m = 0.2F;
// How far poses that agree are off, and deviations of a reading from the surface that it is of. A
// point is seen through only where all readings around say so, by more.
constexpr float pose_error_m = 0.005F, on_surface = 2, beyond_surface = 3;
// Deviations of the point's own best reading within which it may be a copy of what lies before it.
constexpr float copy = 4;

// Points go to the frames by what lies together, so that those that can't see it are left out, and
// of the others few pixels are looked at. In cubes, as far as these can be told apart.
std::uint64_t cube_of(float x, float y, float z) {
    constexpr float edge_m = 0.2F;
    std::uint64_t key = 0;
    for (const float at : {x, y, z}) {
        const float cube = std::clamp(std::floor(at / edge_m), -1048576.0F, 1048575.0F);
        key = key << 21 | static_cast<std::uint64_t>(static_cast<std::int64_t>(cube) + 1048576);
    }
    return key;
}

FusedPoints gathered(const FusedPoints& points, std::span<const std::uint32_t> which,
                     std::size_t from) {
    FusedPoints out;
    for (const std::uint32_t w : which) {
        out.x.push_back(points.x[from + w]);
        out.y.push_back(points.y[from + w]);
        out.z.push_back(points.z[from + w]);
        out.sigma.push_back(points.sigma[from + w]);
    }
    return out;
}

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

Witnesses::Box Witnesses::box_of(const FusedPoints& points, std::size_t first, std::size_t count) {
    Box box;
    std::size_t a = 0;
    for (const std::vector<float>* values : {&points.x, &points.y, &points.z}) {
        const auto [least, greatest] =
            std::ranges::minmax(std::span(*values).subspan(first, count));
        box.centre[a] = 0.5 * (double{least} + double{greatest});
        box.half[a++] = 0.5 * (double{greatest} - double{least});
    }
    return box;
}

bool Witnesses::may_see(const Frame& frame, const Box& box) const {
    const auto& m = frame.camera_to_world;
    std::array<double, 3> from{};
    double far = 0, beyond_rounding = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        from[a] = box.centre[a] - double{m[4 * a + 3]};
        far += std::abs(from[a]) + box.half[a];
        beyond_rounding += std::abs(box.centre[a]) + box.half[a];
    }
    // Projections in single precision are off by far less.
    const double margin = 1e-3 * far + 1e-5 * beyond_rounding;
    // Whether a corner lies on the inner side of a plane through the camera: x, y, z of the normal
    // in its own axes.
    const auto reaches = [&](double x, double y, double z, double least) {
        double at = -least, length = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            const double along =
                x * double{m[4 * a]} + y * double{m[4 * a + 1]} + z * double{m[4 * a + 2]};
            at += along * from[a] + std::abs(along) * box.half[a];
            length += along * along;
        }
        return !(at < -margin * std::sqrt(length));
    };
    const double fx = fx_, fy = fy_, cx = cx_, cy = cy_;
    return reaches(0, 0, 1, double{nearest_m}) && reaches(fx, 0, cx, 0) &&
           reaches(-fx, 0, width_ - cx, 0) && reaches(0, fy, cy, 0) &&
           reaches(0, -fy, height_ - cy, 0);
}

void Witnesses::project(const Frame& frame, const FusedPoints& points, std::size_t first,
                        std::size_t count, Projected& out) const {
    // Copies: a compiler can't know that what is written is none of them.
    const std::array<float, 16> m = frame.camera_to_world;
    const float columns = static_cast<float>(width_), rows = static_cast<float>(height_);
    const float fx = fx_, fy = fy_, cx = cx_, cy = cy_;
    const auto width = static_cast<std::int32_t>(width_);
    const float *px = &points.x[first], *py = &points.y[first], *pz = &points.z[first];
    float* const depths = out.depth.data();
    std::int32_t* const pixels = out.pixel.data();
    for (std::size_t k = 0; k < count; ++k) {
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
                     std::size_t count, Projected& at, Votes& votes) const {
    project(frame, points, first, count, at);
    for (std::size_t k = 0; k < count; ++k) {
        const bool in = at.pixel[k] >= 0;
        const Pixel& seen = frame.pixels[static_cast<std::size_t>(in ? at.pixel[k] : 0)];
        at.stored[k] = in ? seen.depth : 0;
        at.least[k] = seen.least;
        at.greatest[k] = seen.greatest;
    }
    // Plain arrays and factors of 0 or 1, which compilers vectorise.
    const float metres = metres_;
    const float *depths = at.depth.data(), *sigmas = &points.sigma[first];
    const std::int32_t *storeds = at.stored.data(), *leasts = at.least.data(),
                       *greatests = at.greatest.data();
    float *confirms = &votes.confirm[first], *denies = &votes.deny[first];
    for (std::size_t k = 0; k < count; ++k) {
        const float depth = depths[k];
        const float reading = metres * static_cast<float>(storeds[k]);
        const float sigma = depth_sigma(reading);
        const float weight = 1 / (sigma * sigma);
        const float least = metres * static_cast<float>(leasts[k]),
                    greatest = metres * static_cast<float>(greatests[k]);
        const int through = least > depth + beyond_surface * sigma + pose_error_m;
        const int copied = static_cast<int>(leasts[k] > 0) & static_cast<int>(greatest < depth) &
                           static_cast<int>(least > depth - copy * sigmas[k] - pose_error_m);
        const int same = std::abs(reading - depth) <= on_surface * sigma + pose_error_m;
        const int seen = storeds[k] > 0;
        confirms[k] += static_cast<float>(seen & same) * weight;
        denies[k] += static_cast<float>(seen & (same ^ 1) & (through | copied)) * weight;
    }
}

std::vector<std::uint8_t> Witnesses::deny(const FusedPoints& points, ThreadPool& pool) const {
    std::vector<std::uint8_t> denied(points.size());
    pool.run(points.size(), points_at_once, [&](std::uint64_t begin, std::uint64_t end) {
        std::vector<std::uint64_t> cube;
        for (std::uint64_t i = begin; i < end; ++i)
            cube.push_back(cube_of(points.x[i], points.y[i], points.z[i]));
        const KeyGroups groups = group_keys(cube);
        const FusedPoints near = gathered(points, groups.order, begin);
        Projected at(most_together);
        Votes votes{std::vector<float>(near.size()), std::vector<float>(near.size())};
        for (std::size_t g = 0; g < groups.size(); ++g) {
            for (std::size_t first = groups.first[g]; first < groups.first[g + 1];
                 first += most_together) {
                const std::size_t count = std::min(most_together, groups.first[g + 1] - first);
                const Box box = box_of(near, first, count);
                for (const Frame& frame : frames_) {
                    if (may_see(frame, box)) vote(frame, near, first, count, at, votes);
                }
            }
        }
        for (std::size_t k = 0; k < near.size(); ++k)
            denied[begin + groups.order[k]] = votes.deny[k] > votes.confirm[k];
    });
    return denied;
}

}  // namespace topple::geometry

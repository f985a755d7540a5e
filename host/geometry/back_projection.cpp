// SPDX-License-Identifier: MIT
#include "geometry/back_projection.h"

#include <algorithm>
#include <cmath>

#include "core/depth_noise.h"

namespace topple::geometry {
namespace {

// Beyond this angle between the ray and the surface's normal, neighbouring readings say little
// about each other, and a jump counts as one between two surfaces.
constexpr double grazing_tangent = 7.1;  // tan 82 degrees

// Where `count` readings lie along one axis, in the camera's row of the pose, m: those that are
// beyond the grid's reach are marked in `inside`. Plain arrays, which compilers vectorise.
void project(const double* m, double dy, double per_cell, const double* columns,
             const double* depth_m, std::size_t count, std::int32_t* cell, std::int32_t* part,
             std::uint32_t* inside) {
    constexpr auto bias = static_cast<double>(key_bias);
    const double along = m[0], across = m[1] * dy, ahead = m[2], offset = m[3];
    for (std::size_t u = 0; u < count; ++u) {
        const double at =
            ((along * columns[u] + across + ahead) * depth_m[u] + offset) * per_cell + bias;
        const bool in = (at >= 1) & (at < 2 * bias - 1);
        const double safe = in ? at : 1.0;
        const auto whole = static_cast<std::int32_t>(safe);
        cell[u] = whole;
        part[u] = static_cast<std::int32_t>((safe - whole) * cell_parts);
        inside[u] &= static_cast<std::uint32_t>(in);
    }
}

}  // namespace

RowReadings::RowReadings(std::size_t width)
    : kept(width),
      inside(width),
      weight(width),
      depth_m(width),
      limit(width),
      padded(width + 2),
      none(width) {
    for (auto* values : {&cell, &part}) {
        for (auto& axis : *values) axis.resize(width);
    }
}

BackProjection::BackProjection(const Intrinsics& intrinsics, double cell_m)
    : intrinsics_(intrinsics), per_cell_(1 / cell_m), by_depth_(65536) {
    for (std::uint32_t u = 0; u < intrinsics.width; ++u)
        columns_.push_back((u - intrinsics.cx) / intrinsics.fx);
    const double focal = std::min(intrinsics.fx, intrinsics.fy);
    for (std::size_t stored = 1; stored < by_depth_.size(); ++stored) {
        const double z = static_cast<double>(stored) / intrinsics.depth_scale;
        const double sigma = depth_sigma(z), ratio = least_depth_sigma / sigma;
        by_depth_[stored] = {
            static_cast<float>(intrinsics.depth_scale *
                               (3 * std::sqrt(2.0) * sigma + z * grazing_tangent / focal)),
            std::max(1u, static_cast<std::uint32_t>(std::lround(65535 * ratio * ratio))), z};
    }
}

// Tells which readings are to be kept, and their weights. A reading between two surfaces lies on
// neither: along a row or a column, both neighbours are too far off in depth. Missing neighbours
// don't support it either.
void BackProjection::look(const DepthFrame& frame, std::uint32_t v, RowReadings& out) const {
    const std::uint32_t width = intrinsics_.width;
    const std::uint16_t* row = frame.depth.data() + std::size_t{v} * width;
    // Beyond the image there are no readings, as where a pixel has none.
    const std::uint16_t* above = v > 0 ? row - width : out.none.data();
    const std::uint16_t* below = v + 1 < intrinsics_.height ? row + width : out.none.data();
    std::copy(row, row + width, out.padded.begin() + 1);
    for (std::uint32_t u = 0; u < width; ++u) {
        const DepthReading& reading = by_depth_[row[u]];
        out.limit[u] = reading.largest_jump;
        out.weight[u] = reading.weight;
        out.depth_m[u] = reading.depth_m;
    }
    std::uint32_t* const kept = out.kept.data();
    const std::uint16_t* const left = out.padded.data();
    const float* const limits = out.limit.data();
    for (std::uint32_t u = 0; u < width; ++u) {
        const float depth = row[u], most = limits[u];
        const auto far = [&](std::uint16_t stored) {
            const float other = stored;
            return (other == 0) | (std::fabs(other - depth) > most);
        };
        const bool between = (far(left[u]) & far(left[u + 2])) | (far(above[u]) & far(below[u]));
        kept[u] = (depth > 0) & !between;
    }
}

void BackProjection::row(const DepthFrame& frame, std::uint32_t v, RowReadings& out) const {
    look(frame, v, out);
    const double dy = (v - intrinsics_.cy) / intrinsics_.fy;
    std::fill(out.inside.begin(), out.inside.end(), 1u);
    for (std::size_t a = 0; a < 3; ++a) {
        project(&frame.camera_to_world[4 * a], dy, per_cell_, columns_.data(), out.depth_m.data(),
                columns_.size(), out.cell[a].data(), out.part[a].data(), out.inside.data());
    }
}

}  // namespace topple::geometry

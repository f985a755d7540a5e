// SPDX-License-Identifier: MIT
#include "vdb/depth_pyramid.h"

#include <algorithm>

namespace topple::vdb {

std::uint64_t pyramid_words(const Intrinsics& intrinsics) {
    std::uint64_t width = intrinsics.width - 1, height = intrinsics.height - 1;
    std::uint64_t words = width * height;
    while (width > 1 || height > 1) {
        width = (width + 1) / 2;
        height = (height + 1) / 2;
        words += width * height;
    }
    return words;
}

void build_pyramid(const Intrinsics& intrinsics, std::span<const std::uint16_t> depth,
                   std::span<std::uint32_t> out) {
    std::size_t width = intrinsics.width - 1, height = intrinsics.height - 1;
    for (std::size_t y = 0; y < height; ++y) {
        const std::uint16_t* above = depth.data() + y * intrinsics.width;
        const std::uint16_t* below = above + intrinsics.width;
        std::uint32_t* row = out.data() + y * width;
        for (std::size_t x = 0; x < width; ++x) {
            const std::uint32_t low =
                std::min(std::min(above[x], above[x + 1]), std::min(below[x], below[x + 1]));
            const std::uint32_t high =
                std::max(std::max(above[x], above[x + 1]), std::max(below[x], below[x + 1]));
            row[x] = low | high << 16;
        }
    }
    std::uint32_t* fine = out.data();
    while (width > 1 || height > 1) {
        std::uint32_t* coarse = fine + width * height;
        const std::size_t half_width = (width + 1) / 2, half_height = (height + 1) / 2;
        for (std::size_t y = 0; y < half_height; ++y) {
            const std::uint32_t* above = fine + 2 * y * width;
            const std::uint32_t* below = 2 * y + 1 < height ? above + width : above;
            for (std::size_t x = 0; x < half_width; ++x) {
                const std::size_t left = 2 * x, right = std::min(2 * x + 1, width - 1);
                const std::uint32_t words[4] = {above[left], above[right], below[left],
                                                below[right]};
                std::uint32_t low = 0xffff, high = 0;
                for (const std::uint32_t word : words) {
                    low = std::min(low, word & 0xffff);
                    high = std::max(high, word >> 16);
                }
                coarse[y * half_width + x] = low | high << 16;
            }
        }
        fine = coarse;
        width = half_width;
        height = half_height;
    }
}

std::array<float, 12> camera_rows(const VoxelFrame& frame,
                                  const std::array<std::int32_t, 3>& reference,
                                  const Intrinsics& intrinsics, const Mat4& camera_to_world) {
    // Grid to camera: p_camera = Rc' (voxel * R' (index + reference + 0.5) - t).
    double rotation[3][3], offset[3];
    for (int a = 0; a < 3; ++a) {
        offset[a] = 0;
        for (int d = 0; d < 3; ++d)
            offset[a] -= camera_to_world[4 * d + a] * camera_to_world[4 * d + 3];
        for (int b = 0; b < 3; ++b) {
            double sum = 0;
            for (int d = 0; d < 3; ++d)
                sum += camera_to_world[4 * d + a] * frame.grid_from_input[b][d];
            rotation[a][b] = sum * frame.voxel_m;
            offset[a] += rotation[a][b] * (reference[b] + 0.5);
        }
    }
    std::array<float, 12> rows;
    for (int b = 0; b < 4; ++b) {
        const auto column = [&](int a) { return b < 3 ? rotation[a][b] : offset[a]; };
        rows[b] = static_cast<float>(intrinsics.fx * column(0) + intrinsics.cx * column(2));
        rows[4 + b] = static_cast<float>(intrinsics.fy * column(1) + intrinsics.cy * column(2));
        rows[8 + b] = static_cast<float>(column(2));
    }
    return rows;
}

}  // namespace topple::vdb

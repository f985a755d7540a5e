// SPDX-License-Identifier: MIT
#pragma once

#include "oracle/carve_oracle.h"
#include "oracle/random_depth.h"
#include "params.hpp"
#include "topple/kernels/buffer.h"
#include "vdb/depth_pyramid.h"

// Leaves around the origin and frames that look at them, for the tests of both carving kernels.
namespace topple::test {

struct CarveCase {
    vdb::VoxelFrame grid;
    Intrinsics intrinsics{41, 31, 38.5, 37, 19.8, 15.3, 1000};
    oracle::CarveNoise noise;
    std::vector<DepthFrame> frames;
    std::array<std::vector<std::int32_t>, 3> origin;  // lowest voxel of each leaf
    kernels::CarveParams params{};
    std::vector<float> camera;
    std::vector<std::uint32_t> pyramid;

    CarveCase(std::uint64_t seed, std::uint32_t leaves, std::uint32_t frame_count) {
        Random random(seed);
        const double angle = random.uniform(-3, 3), c = std::cos(angle), s = std::sin(angle);
        grid.voxel_m = random.uniform(0.01, 0.05);
        grid.grid_from_input = {Vec3{c, s, 0}, Vec3{-s, c, 0}, Vec3{0, 0, 1}};
        for (std::uint32_t n = 0; n < leaves; ++n) {
            for (auto& axis : origin)
                axis.push_back((static_cast<std::int32_t>(random.below(16)) - 8) * 8);
        }
        for (std::uint32_t n = 0; n < frame_count; ++n)
            frames.push_back(oracle::random_frame(random, intrinsics, 1));
        const std::uint64_t words = vdb::pyramid_words(intrinsics);
        pyramid.resize(words * frame_count);
        for (std::uint32_t n = 0; n < frame_count; ++n) {
            vdb::build_pyramid(intrinsics, frames[n].depth, {pyramid.data() + n * words, words});
            const auto rows =
                vdb::camera_rows(grid, {0, 0, 0}, intrinsics, frames[n].camera_to_world);
            camera.insert(camera.end(), rows.begin(), rows.end());
        }
        params.leaf_count = leaves;
        params.frame_count = frame_count;
        params.width = intrinsics.width - 1;
        params.height = intrinsics.height - 1;
        params.frame_words = static_cast<std::uint32_t>(words);
        params.near_m = 0.02f;
        params.metres_per_unit = static_cast<float>(1 / intrinsics.depth_scale);
        params.margin_m =
            static_cast<float>(grid.voxel_m * std::sqrt(3.0) / 2 + 0.5 / intrinsics.depth_scale);
        params.noise_base_m = static_cast<float>(noise.sigmas * noise.base_m);
        params.noise_growth = static_cast<float>(noise.sigmas * noise.growth_per_m);
        params.noise_from_m = static_cast<float>(noise.from_m);
        params.slack_m = static_cast<float>(grid.voxel_m * 0.02);
    }

    // Every other leaf counts as holding points.
    std::vector<std::uint32_t> points() const {
        std::vector<std::uint32_t> out(origin[0].size());
        for (std::size_t n = 0; n < out.size(); ++n) out[n] = n % 2;
        return out;
    }

    std::array<std::int32_t, 3> voxel(std::uint32_t leaf, std::uint32_t v) const {
        return {origin[0][leaf] + static_cast<std::int32_t>(v >> 6),
                origin[1][leaf] + static_cast<std::int32_t>(v >> 3 & 7),
                origin[2][leaf] + static_cast<std::int32_t>(v & 7)};
    }
};

}  // namespace topple::test

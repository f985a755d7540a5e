// SPDX-License-Identifier: MIT
#include "carve_leaves.hpp"

#include "device/queue.h"
#include "kernels/carve_case.h"
#include "kernels/device_compare.h"
#include "kernels/device_harness.h"

namespace topple::test {
namespace {

class CarveLeaves : public EachBackend {
  protected:
    struct Result {
        std::vector<std::uint32_t> mixed, front;
    };
    Result run(device::Device& on, const CarveCase& c) {
        using device::Buffer;
        Buffer<std::int32_t> x(on, std::span(c.origin[0]), "x"), y(on, std::span(c.origin[1]), "y"),
            z(on, std::span(c.origin[2]), "z");
        const std::vector<std::uint32_t> holds = c.points();
        Buffer<std::uint32_t> points(on, std::span(holds), "points");
        Buffer<float> camera(on, std::span(c.camera), "camera");
        Buffer<std::uint32_t> pyramid(on, std::span(c.pyramid), "pyramid");
        const Guarded<std::uint32_t> mixed(on, c.params.leaf_count, "mixed"),
            front(on, c.params.leaf_count, "front");
        device::Queue queue(on);
        queue.add<kernels::CarveLeaves>(c.params.leaf_count,
                                        {.leaf_x = x,
                                         .leaf_y = y,
                                         .leaf_z = z,
                                         .points = points,
                                         .camera = camera,
                                         .pyramid = pyramid,
                                         .mixed = mixed.slice(),
                                         .front = front.slice()},
                                        c.params);
        queue.run();
        EXPECT_TRUE(mixed.untouched());
        EXPECT_TRUE(front.untouched());
        return {mixed.download(), front.download()};
    }
};

TEST_P(CarveLeaves, NeverContradictsAVoxelAndIsNativeToTheBit) {
    const auto native = device::open_native();
    std::uint64_t fronts = 0, silent = 0, wrong = 0;
    for (const std::uint32_t leaves : {0u, 1u, 63u, 64u, 65u, 127u}) {
        const CarveCase c(leaves + 1, leaves, 32);
        const Result result = run(*device, c), same_as = run(*native, c);
        EXPECT_TRUE(same(result.mixed, same_as.mixed));
        EXPECT_TRUE(same(result.front, same_as.front));
        for (std::uint32_t leaf = 0; leaf < leaves; ++leaf) {
            EXPECT_EQ(result.mixed[leaf] & result.front[leaf], 0u) << "leaf " << leaf;
            for (std::uint32_t f = 0; f < c.params.frame_count; ++f) {
                if (result.mixed[leaf] >> f & 1) continue;
                const bool front = result.front[leaf] >> f & 1;
                (front ? fronts : silent) += 1;
                const auto expected =
                    front ? oracle::CarveVerdict::through : oracle::CarveVerdict::nothing;
                for (std::uint32_t v = 0; v < 512; ++v) {
                    const auto verdict = oracle::carve_voxel(c.grid, c.intrinsics, c.frames[f],
                                                             c.noise, c.voxel(leaf, v));
                    if (verdict.kind == expected || verdict.close) continue;
                    // Where there are no points, nobody asks who sees a surface.
                    const bool hit = verdict.kind == oracle::CarveVerdict::hit;
                    if (!front && hit && c.points()[leaf] == 0) continue;
                    if (++wrong < 5)
                        ADD_FAILURE() << "leaf " << leaf << ", frame " << f << ", voxel " << v;
                }
            }
        }
    }
    EXPECT_EQ(wrong, 0u);
    // The coarse step must decide: on these scenes most pairs of leaf and frame are settled.
    EXPECT_GT(fronts, 100u);
    EXPECT_GT(silent, 4000u);
}

TEST_P(CarveLeaves, FlatWall) {
    // A camera at the origin that looks along +z at a wall 2 m away.
    CarveCase c(1, 0, 0);
    c.grid = {};
    DepthFrame frame;
    frame.depth.assign(std::size_t{c.intrinsics.width} * c.intrinsics.height, 2000);
    c.pyramid.resize(vdb::pyramid_words(c.intrinsics));
    vdb::build_pyramid(c.intrinsics, frame.depth, c.pyramid);
    const auto rows = vdb::camera_rows(c.grid, {0, 0, 0}, c.intrinsics, frame.camera_to_world);
    c.camera.assign(rows.begin(), rows.end());
    c.origin = {
        std::vector<std::int32_t>{0, 0, 0, 0, 800}, {0, 0, 0, 0, 0}, {40, 96, 120, -40, 40}};
    c.params.leaf_count = 5;
    c.params.frame_count = 1;
    c.params.margin_m = 0.02f;
    const Result result = run(*device, c);
    EXPECT_EQ(result.front, (std::vector<std::uint32_t>{1, 0, 0, 0, 0}));  // before the wall
    EXPECT_EQ(result.mixed,
              (std::vector<std::uint32_t>{0, 1, 0, 0, 0}));  // in it; behind, behind us, aside
}

TOPPLE_ON_EACH_FORM(CarveLeaves);

}  // namespace
}  // namespace topple::test

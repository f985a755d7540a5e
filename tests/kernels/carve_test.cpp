// SPDX-License-Identifier: MIT
#include "carve.hpp"

#include <Eigen/Dense>

#include "carve_leaves.hpp"
#include "cell_share.hpp"
#include "core/boundary_cells.h"
#include "device/devices.h"
#include "errors.h"
#include "kernels/carve_case.h"
#include "oracle/cell_share_oracle.h"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"

namespace topple::test {
namespace {

class Carve : public EachBackend {
  protected:
    // Counts per voxel, on top of `start`; all frames of `mixed` are asked.
    std::vector<std::uint32_t> run(device::Device& on, const CarveCase& c,
                                   const std::vector<std::uint32_t>& bits, std::uint32_t start) {
        using device::Buffer;
        Buffer<std::int32_t> x(on, std::span(c.origin[0]), "x"), y(on, std::span(c.origin[1]), "y"),
            z(on, std::span(c.origin[2]), "z");
        Buffer<std::uint32_t> mixed(on, std::span(bits), "mixed");
        Buffer<float> camera(on, std::span(c.camera), "camera");
        Buffer<std::uint32_t> pyramid(on, std::span(c.pyramid), "pyramid");
        const std::uint64_t voxels = std::uint64_t{c.params.leaf_count} * 512;
        Guarded<std::uint32_t> evidence(on, voxels, "evidence");
        evidence.upload(std::vector<std::uint32_t>(voxels, start));
        run_kernel<kernels::Carve>(on, voxels,
                                   {.leaf_x = x,
                                    .leaf_y = y,
                                    .leaf_z = z,
                                    .mixed = mixed,
                                    .camera = camera,
                                    .pyramid = pyramid,
                                    .evidence = evidence.slice()},
                                   c.params);
        EXPECT_TRUE(evidence.untouched());
        return evidence.download();
    }
};

TEST_P(Carve, MatchesTheOracleAndNativeToTheBit) {
    const auto native = device::open_native();
    std::uint64_t wrong = 0, throughs = 0, hits = 0, close_calls = 0;
    for (const std::uint32_t leaves : {0u, 1u, 2u, 7u, 61u}) {
        const CarveCase c(leaves + 10, leaves, 32);
        std::vector<std::uint32_t> bits(leaves);
        Random random(leaves);
        for (auto& word : bits) word = random.word();
        const auto counts = run(*device, c, bits, 0);
        EXPECT_TRUE(same(counts, run(*native, c, bits, 0)));
        for (std::uint32_t n = 0; n < counts.size(); ++n) {
            std::uint32_t through = 0, hit = 0, close = 0;
            for (std::uint32_t f = 0; f < c.params.frame_count; ++f) {
                if (!(bits[n / 512] >> f & 1)) continue;
                const auto verdict = oracle::carve_voxel(c.grid, c.intrinsics, c.frames[f], c.noise,
                                                         c.voxel(n / 512, n % 512));
                through += verdict.kind == oracle::CarveVerdict::through;
                hit += verdict.kind == oracle::CarveVerdict::hit;
                close += verdict.close;
            }
            throughs += through;
            hits += hit;
            const std::uint32_t off =
                std::max(through > (counts[n] & 0xffff) ? through - (counts[n] & 0xffff)
                                                        : (counts[n] & 0xffff) - through,
                         hit > counts[n] >> 16 ? hit - (counts[n] >> 16) : (counts[n] >> 16) - hit);
            if (off > close && ++wrong < 5) {
                ADD_FAILURE() << "voxel " << n << ": " << (counts[n] & 0xffff) << " through and "
                              << (counts[n] >> 16) << " hits, expected " << through << " and "
                              << hit;
            }
            close_calls += off > 0;
        }
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(throughs, 1000u);
    EXPECT_GT(hits, 100u);
    EXPECT_LT(close_calls, 40u);  // of some 36,000 voxels
}

TEST_P(Carve, AddsToWhatIsThereAndSaturates) {
    const CarveCase c(3, 5, 32);
    const std::vector<std::uint32_t> all(5, ~0u), none(5, 0u);
    const auto once = run(*device, c, all, 0), more = run(*device, c, all, 0x0007'0003u);
    EXPECT_EQ(run(*device, c, none, 0x0007'0003u),
              std::vector<std::uint32_t>(5 * 512, 0x0007'0003u));
    for (std::size_t n = 0; n < once.size(); ++n) EXPECT_EQ(more[n], once[n] + 0x0007'0003u) << n;
    EXPECT_EQ(run(*device, c, all, ~0u), std::vector<std::uint32_t>(5 * 512, ~0u));
}

TOPPLE_ON_EACH_FORM(Carve);

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
        run_kernel<kernels::CarveLeaves>(on, c.params.leaf_count,
                                         {.leaf_x = x,
                                          .leaf_y = y,
                                          .leaf_z = z,
                                          .points = points,
                                          .camera = camera,
                                          .pyramid = pyramid,
                                          .mixed = mixed.slice(),
                                          .front = front.slice()},
                                         c.params);
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

using oracle::ShareSurface;
using oracle::ShareVoxel;

constexpr float voxel_m = 0.02F;

struct ShareInputs {
    std::array<std::vector<std::int32_t>, 3> index;
    std::vector<std::uint32_t> slot, form;
    std::vector<float> surface;
};

// The kernel's form of these voxels, each with patches of its own.
ShareInputs inputs_for(const std::vector<ShareVoxel>& voxels) {
    ShareInputs in;
    const std::size_t n = voxels.size();
    in.slot.resize(BoundaryCells::slots * n);
    std::uint32_t patches = 0;
    for (std::size_t v = 0; v < n; ++v) {
        for (std::size_t a = 0; a < 3; ++a) in.index[a].push_back(voxels[v].index[a]);
        std::array<SlotUse, BoundaryCells::slots> uses{};
        std::size_t used = 0;
        const auto add = [&](const ShareSurface& s, bool last) {
            for (const double o : s.origin) in.surface.push_back(static_cast<float>(o));
            for (const double c : s.c) in.surface.push_back(static_cast<float>(c));
            in.slot[used * n + v] = patches++;
            uses[used++] = {s.outside, last, s.bounds};
        };
        // Bounds may stand anywhere among the groups.
        if (!voxels[v].bounds.empty()) add(voxels[v].bounds[0], false);
        for (const auto& group : voxels[v].groups) {
            for (std::size_t m = 0; m < group.size(); ++m) add(group[m], m + 1 == group.size());
        }
        for (std::size_t b = 1; b < voxels[v].bounds.size(); ++b) add(voxels[v].bounds[b], false);
        in.form.push_back(make_form(voxels[v].any_group, uses, used));
    }
    if (in.surface.empty()) in.surface.resize(13);
    return in;
}

struct Measured {
    std::vector<std::uint32_t> share;
    std::vector<std::int32_t> moment;
};

Measured run(device::Device& device, const ShareInputs& in) {
    const std::size_t n = in.form.size();
    const device::Buffer<std::int32_t> i(device, in.index[0], "i"), j(device, in.index[1], "j"),
        k(device, in.index[2], "k");
    const device::Buffer<std::uint32_t> slot(device, in.slot, "slot"),
        form(device, in.form, "form");
    const device::Buffer<float> surface(device, in.surface, "surface");
    const Guarded<std::uint32_t> share(device, n, "share");
    const Guarded<std::int32_t> moment(device, 3 * n, "moment");
    run_kernel<kernels::CellShare>(
        device, n,
        {.ci = i,
         .cj = j,
         .ck = k,
         .slot = slot,
         .form = form,
         .surface = surface,
         .share = share.slice(),
         .moment = moment.slice()},
        {.cell_count = static_cast<std::uint32_t>(n), .voxel_m = voxel_m});
    EXPECT_TRUE(share.untouched());
    EXPECT_TRUE(moment.untouched());
    return {share.download(), moment.download()};
}

// A surface through or beside the voxel: a plane of any direction, or bent.
ShareSurface surface_near(const std::array<int, 3>& index, Random& random) {
    ShareSurface s;
    const auto value = [&](float low, float high) { return double{random.uniform(low, high)}; };
    for (std::size_t a = 0; a < 3; ++a)
        s.origin[a] = static_cast<float>((index[a] + 0.5) * voxel_m + value(-0.2F, 0.2F));
    Eigen::Vector3d n(value(-1, 1), value(-1, 1), value(-1, 1));
    n.normalize();
    double at_middle = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        s.c[a + 1] = static_cast<float>(n[static_cast<int>(a)]);
        at_middle += s.c[a + 1] * ((index[a] + 0.5) * voxel_m - s.origin[a]);
    }
    s.c[0] = static_cast<float>(value(-0.015F, 0.015F) - at_middle);
    if (random.word() % 2 == 0) {
        for (std::size_t a = 4; a < 10; ++a) s.c[a] = value(-1, 1);
    }
    s.outside = random.word() % 2 == 0;
    return s;
}

ShareVoxel voxel(Random& random) {
    ShareVoxel v;
    for (int& i : v.index) i = static_cast<int>(random.word() % 401) - 200;
    v.any_group = random.word() % 2 == 0;
    std::size_t left = random.word() % (BoundaryCells::slots + 1);
    while (left > 0) {
        const bool bounds = random.word() % 3 == 0;
        std::size_t members = bounds ? 1 : 1 + random.word() % left;
        left -= members;
        std::vector<ShareSurface> group;
        for (; members > 0; --members) {
            group.push_back(surface_near(v.index, random));
            group.back().bounds = bounds;
        }
        if (bounds)
            v.bounds.push_back(group.front());
        else
            v.groups.push_back(std::move(group));
    }
    return v;
}

class CellShare : public EachBackend {};
TOPPLE_ON_EACH_FORM(CellShare);

TEST_P(CellShare, MatchesTheOracleAndNativeToTheBit) {
    const auto native = device::open_native();
    for (const std::size_t count : {0, 1, 63, 64, 65, 1999}) {
        SCOPED_TRACE(count);
        Random random(count);
        std::vector<ShareVoxel> voxels;
        for (std::size_t n = 0; n < count; ++n) voxels.push_back(voxel(random));
        const ShareInputs in = inputs_for(voxels);
        const Measured got = run(*device, in), same_as = run(*native, in);
        EXPECT_EQ(got.share, same_as.share);
        EXPECT_EQ(got.moment, same_as.moment);
        std::size_t partly = 0;
        for (std::size_t n = 0; n < count; ++n) {
            const oracle::Share want = oracle::cell_share(voxels[n], voxel_m);
            partly += want.part > 0.01 && want.part < 0.99;
            // Half a unit of rounding, and floats' of places 4 m away in steps of 5 mm.
            ASSERT_NEAR(got.share[n], 4096 * want.part, 2) << n;
            for (std::size_t a = 0; a < 3; ++a)
                ASSERT_NEAR(got.moment[a * count + n], 4096 * want.moment[a], 3) << n;
        }
        EXPECT_GE(3 * partly + 10, count);
    }
}

// A half space's share of a cube is exact where it cuts along an axis, whatever its place.
TEST_P(CellShare, ALevelCutIsExact) {
    std::vector<ShareVoxel> voxels;
    for (int step = 0; step <= 64; ++step) {
        ShareSurface s;
        s.c = {-step * double{voxel_m} / 64, 0, 0, 1};
        ShareVoxel v;
        v.groups = {{s}};
        voxels.push_back(v);
    }
    const Measured got = run(*device, inputs_for(voxels));
    for (std::uint32_t step = 0; step <= 64; ++step) {
        EXPECT_NEAR(got.share[step], 64 * step, 1) << step;
        // The middle of what is solid lies half of its height over the bottom.
        const double part = step / 64.0, middle = 4 * (part / 2 - 0.5);
        EXPECT_NEAR(got.moment[2 * 65 + step], 4096 * part * middle, 150) << step;
        EXPECT_NEAR(got.moment[step], 0, 1) << step;
    }
}

TEST_P(CellShare, WithoutPatchesAllOrNothingIsSolid) {
    std::vector<ShareVoxel> voxels(2);
    voxels[1].any_group = true;
    EXPECT_EQ(run(*device, inputs_for(voxels)).share, (std::vector<std::uint32_t>{4096, 0}));
}

}  // namespace
}  // namespace topple::test

// SPDX-License-Identifier: MIT
#include "cell_share.hpp"

#include <Eigen/Dense>

#include "core/boundary_cells.h"
#include "device/queue.h"
#include "device_compare.h"
#include "device_harness.h"
#include "oracle/cell_share_oracle.h"

namespace topple::test {
namespace {

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
    device::Queue queue(device);
    queue.add<kernels::CellShare>(
        n,
        {.ci = i,
         .cj = j,
         .ck = k,
         .slot = slot,
         .form = form,
         .surface = surface,
         .share = share.slice(),
         .moment = moment.slice()},
        {.cell_count = static_cast<std::uint32_t>(n), .voxel_m = voxel_m});
    queue.run();
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

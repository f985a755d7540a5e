// SPDX-License-Identifier: MIT
#include "carve.hpp"

#include "device/queue.h"
#include "kernels/carve_case.h"
#include "kernels/device_compare.h"
#include "kernels/device_harness.h"

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
        device::Queue queue(on);
        queue.add<kernels::Carve>(voxels,
                                  {.leaf_x = x,
                                   .leaf_y = y,
                                   .leaf_z = z,
                                   .mixed = mixed,
                                   .camera = camera,
                                   .pyramid = pyramid,
                                   .evidence = evidence.slice()},
                                  c.params);
        queue.run();
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

}  // namespace
}  // namespace topple::test

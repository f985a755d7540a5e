// SPDX-License-Identifier: MIT
#include "six_fill_vote.hpp"

#include <algorithm>

#include "device/queue.h"
#include "kernels/device_compare.h"
#include "kernels/device_harness.h"
#include "oracle/six_fill_oracle.h"

namespace topple::test {
namespace {

struct VoteCase {
    std::vector<std::uint32_t> cells;
    std::array<std::vector<std::uint32_t>, 6> hits;
    VoteCase(std::uint64_t seed, std::uint32_t count) {
        Random random(seed);
        for (std::uint32_t n = 0; n < count; ++n) {
            cells.push_back(random.below(8) == 0 ? random.below(9) : 1);
            // Few labels and distances, so that ties are common; now and then the extremes.
            for (auto& side : hits) {
                const std::uint32_t cell = random.below(30) == 0 ? 65535 : random.below(7);
                const std::uint32_t distance = random.below(30) == 0 ? 65535 : 1 + random.below(3);
                side.push_back(cell | distance << 16);
            }
        }
    }
};

class SixFillVote : public EachBackend {
  protected:
    std::vector<std::uint32_t> run(device::Device& on, const VoteCase& c, std::uint32_t votes,
                                   bool columns) {
        using device::Buffer;
        Buffer<std::uint32_t> cells(on, std::span(c.cells), "cells");
        std::vector<Buffer<std::uint32_t>> hits;
        for (const auto& side : c.hits) hits.emplace_back(on, std::span(side), "hits");
        const Guarded<std::uint32_t> filled(on, c.cells.size(), "filled");
        device::Queue queue(on);
        queue.add<kernels::SixFillVote>(c.cells.size(),
                                        {.cells = cells,
                                         .hit_0 = hits[0],
                                         .hit_1 = hits[1],
                                         .hit_2 = hits[2],
                                         .hit_3 = hits[3],
                                         .hit_4 = hits[4],
                                         .hit_5 = hits[5],
                                         .filled = filled.slice()},
                                        {.count = static_cast<std::uint32_t>(c.cells.size()),
                                         .votes = votes,
                                         .columns = columns ? 1u : 0u});
        queue.run();
        EXPECT_TRUE(filled.untouched());
        return filled.download();
    }
};

TEST_P(SixFillVote, MatchesTheCount) {
    for (const std::uint32_t count : {0u, 1u, 63u, 64u, 65u, 100003u}) {
        for (const std::uint32_t votes : {1u, 2u, 3u, 6u}) {
            const VoteCase c(count + votes, count);
            const bool columns = votes == 2 || votes == 6;
            const auto filled = run(*device, c, votes, columns);
            std::uint64_t wrong = 0;
            for (std::uint32_t n = 0; n < count; ++n) {
                std::array<oracle::SixHit, 6> hits;
                for (std::size_t side = 0; side < 6; ++side) {
                    const std::uint32_t hit = c.hits[side][n];
                    const auto cell = static_cast<std::int32_t>(hit & 0xffff);
                    hits[side] = {std::max(cell - 3, -1), static_cast<int>(hit >> 16), cell == 0};
                }
                std::int32_t expected = -1;
                if (c.cells[n] == 1) {
                    expected = oracle::vote(hits, static_cast<int>(votes));
                    if (columns && expected < 0) expected = oracle::column(hits);
                }
                if (filled[n] != static_cast<std::uint32_t>(expected + 1) && ++wrong < 5) {
                    ADD_FAILURE() << "voxel " << n << ": " << filled[n] << ", expected "
                                  << expected + 1;
                }
            }
            EXPECT_EQ(wrong, 0u) << count << " voxels, " << votes << " votes";
        }
    }
}

TOPPLE_ON_EACH_FORM(SixFillVote);

}  // namespace
}  // namespace topple::test

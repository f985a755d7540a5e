// SPDX-License-Identifier: MIT
#include "export/decompose.h"

#include <gtest/gtest.h>

#include "export/merge_parts.h"
#include "host/export/blocks.h"

namespace topple::exports::test {
namespace {

std::vector<Decomposed> decomposed(const std::vector<Cells>& blocks, std::size_t primitives = 1) {
    ThreadPool threads(2);
    const std::vector<double> slight(primitives, 0);
    return decompose(solids_of(blocks, primitives), slight, threads);
}

TEST(Decompose, ABoxIsOnePartOfItsVolume) {
    const Decomposed out = decomposed({{{0, 0, 0}, {20, 30, 5}}})[0];
    ASSERT_EQ(out.parts.size(), 1u);
    EXPECT_NEAR(out.solid_m3, 3e-3, 1e-12);
    EXPECT_NEAR(out.parts[0].volume_m3, 3e-3, 1e-9);
    EXPECT_NEAR(out.excess_m3, 0, 1e-9);
    EXPECT_TRUE(as_box(out.parts[0], 1e-6));
}

TEST(Decompose, AnAngleIsTwoBoxes) {
    const Decomposed out = decomposed({{{0, 0, 0}, {30, 10, 4}}, {{0, 0, 4}, {4, 10, 30}}})[0];
    EXPECT_EQ(out.parts.size(), 2u);
    EXPECT_NEAR(out.excess_m3, 0, 0.01 * out.solid_m3);
}

TEST(Decompose, AnOpenCupKeepsItsHollow) {
    std::vector<Cells> walls{{{0, 0, 0}, {20, 20, 2}},
                             {{0, 0, 2}, {2, 20, 20}},
                             {{18, 0, 2}, {20, 20, 20}},
                             {{2, 0, 2}, {18, 2, 20}},
                             {{2, 18, 2}, {18, 20, 20}}};
    const Decomposed out = decomposed(walls)[0];
    EXPECT_LE(out.excess_m3, 0.16 * out.solid_m3);
    EXPECT_LE(out.parts.size(), 10u);
    const Vec3 inside{0.1, 0.1, 0.12};
    for (const ConvexPart& part : out.parts) {
        bool holds = true;
        for (const HalfSpace& side : part.face)
            holds &= side.normal[0] * inside[0] + side.normal[1] * inside[1] +
                         side.normal[2] * inside[2] <=
                     side.offset_m;
        EXPECT_FALSE(holds);
    }
}

TEST(Decompose, WhatIsNotWantedHasNoParts) {
    ThreadPool threads(1);
    const auto out = decompose(solids_of({{{0, 0, 0}, {5, 5, 5}, 0}, {{6, 0, 0}, {9, 5, 5}, 1}}, 2),
                               std::vector<double>{-1, 0}, threads);
    EXPECT_TRUE(out[0].parts.empty());
    EXPECT_EQ(out[1].parts.size(), 1u);
}

TEST(MergeParts, JoinsWhatIsConvexTogetherAndNothingElse) {
    std::vector<ConvexPart> parts{block({0, 0, 0}, {1, 1, 1}), block({1, 0, 0}, {2, 1, 1}),
                                  block({5, 0, 0}, {6, 1, 1}), block({0, 0, 1}, {0.2, 1, 3})};
    merge_parts(parts, 0.1, 0.01);
    ASSERT_EQ(parts.size(), 3u);
    EXPECT_NEAR(parts.back().volume_m3, 2, 1e-9);
}

}  // namespace
}  // namespace topple::exports::test

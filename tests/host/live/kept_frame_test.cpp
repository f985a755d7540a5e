// SPDX-License-Identifier: MIT
#include "live/kept_frame.h"

#include <gtest/gtest.h>

#include "core/random.h"

// A kept frame comes back as it was, whatever its pixels.
namespace topple::live {
namespace {

TEST(KeptFrame, ComesBackBitForBit) {
    Random random(7);
    for (const bool noise : {false, true}) {
        DepthFrame frame;
        for (std::size_t n = 0; n < std::size_t{31} * 17; ++n) {
            const auto any = static_cast<std::uint16_t>(random.below(65536));
            frame.depth.push_back(noise ? any : static_cast<std::uint16_t>(1000 + n / 5));
            for (int c = 0; c < 3; ++c)
                frame.rgb.push_back(static_cast<std::uint8_t>(noise ? random.below(256) : n % 200));
        }
        const KeptFrame kept(frame, 31);
        const DepthFrame back = kept.frame();
        EXPECT_EQ(back.depth, frame.depth);
        EXPECT_EQ(back.rgb, frame.rgb);
        EXPECT_TRUE(noise || kept.bytes() < frame.depth.size());
    }
}

TEST(KeptFrame, MayHaveNoColours) {
    DepthFrame frame;
    frame.depth.assign(12, 65535);
    const DepthFrame back = KeptFrame(frame, 4).frame();
    EXPECT_EQ(back.depth, frame.depth);
    EXPECT_TRUE(back.rgb.empty());
}

}  // namespace
}  // namespace topple::live

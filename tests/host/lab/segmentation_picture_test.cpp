// SPDX-License-Identifier: MIT
#include "lab/evaluation/segmentation_picture.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace topple::evaluation {
namespace {

using testing::HasSubstr;

// Bars of medians: as high as the errors, none where there is no error to tell.
TEST(SegmentationPicture, HasABarForEachErrorThatIsKnown) {
    std::vector<RoomScore> rooms(3);
    for (std::size_t n = 0; n < rooms.size(); ++n) {
        const double x = 0.1 * static_cast<double>(n);
        rooms[n].objects_by_region = {0.5 + x, 0.4, 0.3, 0.2, 0.1};
        rooms[n].objects_by_primitive = {0.25, 0.25, 0.25, 0.25, 0.25};
        rooms[n].objects_by_object = {NAN, 0.125, 0.125, 0.125, 0.125};
    }
    const std::string svg = segmentation_picture(rooms);
    std::size_t bars = 0;
    for (std::size_t at = svg.find("#1b6ca8"); at != std::string::npos;
         at = svg.find("#1b6ca8", at + 1))
        ++bars;
    EXPECT_EQ(bars, 4u) << "one of the legend, and three";
    EXPECT_THAT(svg, HasSubstr("height='132' fill='#b9b9b9'")) << "0.6 of 220";
    EXPECT_THAT(svg, HasSubstr(">0.6<"));
    EXPECT_THAT(svg, HasSubstr("false alarm"));
}

}  // namespace
}  // namespace topple::evaluation

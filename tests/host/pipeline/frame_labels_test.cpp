// SPDX-License-Identifier: MIT
#include "topple/frame_labels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/depth_noise.h"
#include "host/pipeline/small_walk.h"

// What pixels of depth frames show of a result, against a search through all its points.
namespace topple::test {
namespace {

class Labels : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        walk_ = new scenes::Sequence(small_walk());
        ParseOptions options;
        options.device = device::open_device("native", 2);
        options.disturbances = {};
        result_ = new ParseResult(parse(view(), options));
    }
    static void TearDownTestSuite() {
        delete result_;
        delete walk_;
    }
    static FramesView view() { return frames_view_of(*walk_); }
    static std::string refusal(const ParseResult& result) {
        try {
            FrameLabeller labeller(result);
            return "taken";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage);
            return error.what();
        }
    }
    static inline scenes::Sequence* walk_ = nullptr;
    static inline ParseResult* result_ = nullptr;
};

TEST_F(Labels, AreThoseOfTheNearestPoint) {
    const FrameLabeller labeller(*result_);
    const ScenePoints& points = result_->scene.points;
    const Intrinsics& k = walk_->intrinsics;
    std::size_t labelled = 0, unknown = 0;
    for (std::size_t f = 0; f < walk_->frames.size(); ++f) {
        const FrameLabels found = labeller.label(view(), f, 1), same = labeller.label(view(), f, 3);
        EXPECT_EQ(found.object, same.object);
        ASSERT_EQ(found.object.size(), std::size_t{96} * 72);
        const Mat4& m = walk_->frames[f].camera_to_world;
        for (int n = 0; n < 40; ++n) {
            const std::size_t pixel = (1733 * static_cast<std::size_t>(n) + 61 * f) % (96 * 72);
            const double z = walk_->frames[f].depth[pixel] / k.depth_scale;
            const double x = (static_cast<double>(pixel % 96) - k.cx) / k.fx * z,
                         y = (static_cast<double>(pixel / 96) - k.cy) / k.fy * z;
            double least = std::numeric_limits<double>::infinity();
            std::size_t nearest = 0;
            for (std::size_t p = 0; p < points.x.size(); ++p) {
                const double away =
                    std::hypot(m[0] * x + m[1] * y + m[2] * z + m[3] - points.x[p],
                               m[4] * x + m[5] * y + m[6] * z + m[7] - points.y[p],
                               m[8] * x + m[9] * y + m[10] * z + m[11] - points.z[p]);
                if (away < least) least = away, nearest = p;
            }
            const bool near =
                z > 0 && least <= std::max(result_->scene.voxel_size_m, 3 * depth_sigma(z));
            EXPECT_EQ(found.object[pixel], near ? points.object[nearest] : -1) << f << " " << pixel;
            EXPECT_EQ(found.primitive[pixel], near ? points.primitive[nearest] : -1);
            ++(near ? labelled : unknown);
        }
    }
    EXPECT_GT(labelled, 150u);
}

// What came into the room afterwards, or is not seen, belongs to nothing.
TEST_F(Labels, OfWhatTheParseDoesNotKnowThereAreNone) {
    const FrameLabeller labeller(*result_);
    std::vector<std::uint16_t> depth = walk_->frames[0].depth;
    FramesView one = view();
    one.images.resize(1);
    one.camera_to_world.resize(1);
    for (std::size_t p = 0; p < 96 * 10; ++p) depth[p] = static_cast<std::uint16_t>(depth[p] / 5);
    for (std::size_t p = 96 * 10; p < 96 * 20; ++p) depth[p] = 0;
    one.images[0].depth = {depth.data(), 96, 72};
    const FrameLabels found = labeller.label(one, 0), before = labeller.label(view(), 0);
    for (std::size_t p = 0; p < depth.size(); ++p)
        EXPECT_EQ(found.object[p], p < 96 * 20 ? -1 : before.object[p]) << p;
    EXPECT_THROW(labeller.label(one, 1), Error);
    EXPECT_THROW(labeller.label(std::filesystem::path("/nowhere"), 0), Error);
    one.camera_to_world[0][3] = 1e5;
    EXPECT_EQ(labeller.label(one, 0).object, std::vector<std::int32_t>(depth.size(), -1));
    one.camera_to_world[0][3] = std::nan("");
    EXPECT_THROW(labeller.label(one, 0), Error);
}

TEST_F(Labels, TakeAResultWithCoordinates) {
    ParseResult result = *result_;
    EXPECT_EQ(refusal(result), "taken");
    result.scene.points.x.clear();
    EXPECT_NE(refusal(result).find("add_coordinates()"), std::string::npos);
}

}  // namespace
}  // namespace topple::test

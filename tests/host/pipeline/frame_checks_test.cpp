// SPDX-License-Identifier: MIT
#include "points/frame_checks.h"

#include "core/depth_noise.h"
#include "errors.h"
#include "host/pipeline/small_walk.h"
#include "points/view_coverage.h"
#include "topple/error.h"
#include "topple/frame_labels.h"

// What is noted about a depth camera that may mean something else than it says.
namespace topple {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> notes_of_principal_point(double cx, double cy) {
    std::vector<std::string> notes;
    note_principal_point({640, 480, 525, 525, cx, cy, 1000}, ScanOrigin::frames_folder, notes);
    return notes;
}

TEST(FrameChecks, APrincipalPointOutsideOfTheMiddleHalf) {
    for (const auto& [cx, cy] : {std::pair(319.5, 239.5), {160.0, 120.0}, {480.0, 360.0}})
        EXPECT_THAT(notes_of_principal_point(cx, cy), IsEmpty()) << cx;
    EXPECT_THAT(notes_of_principal_point(0, 0),
                ElementsAre(AllOf(HasSubstr("(0, 0)"), HasSubstr("640 x 480"),
                                  HasSubstr("intrinsics.json, mostly near (319.5, 239.5)"))));
    EXPECT_THAT(notes_of_principal_point(319.5, 479), testing::SizeIs(1));
    EXPECT_THAT(notes_of_principal_point(159, 239.5), testing::SizeIs(1));
}

TEST(FrameChecks, PosesOfAnotherConvention) {
    scenes::CameraOptions camera;
    camera.intrinsics = {96, 72, 83, 83, 47.5, 35.5, 1000};
    camera.frames = 30;
    const scenes::Sequence walk = scenes::walk(scenes::furnished_room({}), camera);
    std::vector<Mat4> right;
    for (const DepthFrame& frame : walk.frames) right.push_back(frame.camera_to_world);
    const auto note_of = [&](const std::vector<Mat4>& poses,
                             ScanOrigin origin = ScanOrigin::frames_in_memory) {
        geometry::PoseComparison frames(walk.intrinsics, poses, 2);
        for (std::size_t n = 0; n < poses.size(); ++n) frames.add(walk.frames[n], n);
        return pose_note(frames, poses.size(), origin);
    };
    EXPECT_EQ(note_of(right, ScanOrigin::frames_folder), "");
    std::vector<Mat4> poses = right;
    for (Mat4& pose : poses)
        for (const std::size_t n : {1U, 5U, 9U, 2U, 6U, 10U}) pose[n] *= -1;
    EXPECT_THAT(note_of(poses, ScanOrigin::frames_folder),
                AllOf(HasSubstr("OpenGL"), HasSubstr("write into the file of poses"),
                      HasSubstr("each pose with its second and third columns negated (pose @ "
                                "np.diag([1, -1, -1, 1])).")));
    EXPECT_THAT(note_of(poses), HasSubstr("give as camera_to_world"));
    poses.assign(right.rbegin(), right.rend());
    EXPECT_THAT(note_of(poses, ScanOrigin::frames_folder),
                AllOf(HasSubstr("The frames contradict each other"), HasSubstr("in their order"),
                      HasSubstr("of intrinsics.json are")));
    poses = right;
    for (Mat4& pose : poses) {
        std::swap(pose[1], pose[4]);
        std::swap(pose[2], pose[8]);
        std::swap(pose[6], pose[9]);
    }
    EXPECT_THAT(note_of(poses), AllOf(HasSubstr("transposed rotations (column-major, or "
                                                "quaternions with x, y, z negated)"),
                                      HasSubstr("matrices are row-major")));
    poses.assign(30, right[0]);
    EXPECT_THAT(note_of(poses), testing::EndsWith("were the poses filled in?"));
    poses = right;
    for (std::size_t n = 12; n < 20; ++n) poses[n][3] += 0.3;
    EXPECT_THAT(note_of(poses),
                AllOf(testing::StartsWith("Frames contradict the others from frame 1"),
                      HasSubstr("off by about 0."), HasSubstr("doubled, about 0.3"),
                      HasSubstr("mended poses")));
}

TEST(FrameChecks, StepsOfACameraInAnotherUnit) {
    const auto message = [](double step) {
        const std::vector<Vec3> places{{0, 0, 0}, {step, 0, 0}, {2 * step, 0, 0}};
        return test::message_of([&] { check_camera_steps(places, "frames"); }, std::nullopt);
    };
    EXPECT_EQ(message(9), "nothing was thrown");
    EXPECT_THAT(message(30),
                testing::EndsWith("if these are mm, multiply them by 0.001, by 0.01 if "
                                  "cm"));
    EXPECT_THAT(message(3000), testing::EndsWith("if these are mm, multiply them by 0.001"));
}

}  // namespace
}  // namespace topple

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
        return message_of([&] { FrameLabeller labeller(result); }, ErrorKind::usage);
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
    EXPECT_EQ(refusal(result), "nothing was thrown");
    result.scene.points.x.clear();
    EXPECT_NE(refusal(result).find("add_coordinates()"), std::string::npos);
}

}  // namespace
}  // namespace topple::test

namespace topple {
namespace {

// A level camera, z up, at (x, y), that looks in a direction given by its angle.
Mat4 camera(double x, double y, double degrees) {
    const double a = degrees * 3.14159265358979 / 180, c = std::cos(a), s = std::sin(a);
    return {s, 0, c, x, -c, 0, s, y, 0, -1, 0, 1.5, 0, 0, 0, 1};
}

constexpr std::array<Vec3, 3> z_up{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

ViewCoverage walk(double way_m, std::initializer_list<double> degrees) {
    ViewCoverage coverage(z_up);
    double at = 0;
    for (const double d : degrees) {
        coverage.add(camera(at, 0.5 * at, d));
        at += way_m;
    }
    return coverage;
}

TEST(ViewCoverage, ManyDirectionsFromManyPlacesAreAround) {
    EXPECT_TRUE(walk(0.6, {170, -60, 50}).from_around());
    EXPECT_TRUE(walk(0.6, {0, 90, 185, 260}).from_around());
}

TEST(ViewCoverage, HalfACircleOrOnePlaceIsNotAround) {
    EXPECT_FALSE(ViewCoverage(z_up).from_around());
    EXPECT_FALSE(walk(5, {30}).from_around());
    EXPECT_FALSE(walk(0.6, {-80, 0, 90}).from_around());
    EXPECT_FALSE(walk(0.1, {0, 90, 185, 260}).from_around());  // turns on the spot
}

}  // namespace
}  // namespace topple

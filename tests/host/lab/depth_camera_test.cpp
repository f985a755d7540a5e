// SPDX-License-Identifier: MIT
#include "lab/scan/depth_camera.h"

#include <nlohmann/json.hpp>

#include "host/io/files.h"
#include "lab/rooms/furnished_room.h"
#include "lab/solids/ground_truth.h"
#include "lab/temporary_folder.h"
#include "points/formats/frame_sequence.h"

namespace topple::scenes {
namespace {

namespace fs = std::filesystem;

Vec3 back_projected(const Intrinsics& k, const Mat4& m, std::size_t at, double z) {
    const double u = (static_cast<double>(at % k.width) - k.cx) / k.fx * z;
    const double v = (static_cast<double>(at / k.width) - k.cy) / k.fy * z;
    return {m[0] * u + m[1] * v + m[2] * z + m[3], m[4] * u + m[5] * v + m[6] * z + m[7],
            m[8] * u + m[9] * v + m[10] * z + m[11]};
}

std::map<std::string, std::string> contents(const fs::path& folder) {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file())
            all[fs::relative(entry.path(), folder)] = test::bytes_of_file(entry.path());
    }
    return all;
}

// Without noise every pixel's point lies on the part that the pixel shows: within the rounding of a
// depth to a millimetre, times the ray's slant.
class EachFurniture : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(DepthCamera, EachFurniture, ::testing::Bool(),
                         [](const auto& kind) { return kind.param ? "varied" : "plain"; });

TEST_P(EachFurniture, PixelsLieOnTheirParts) {
    const World world = furnished_room({.seed = 5, .tilt_deg = 12, .varied = GetParam()});
    CameraOptions options;
    options.noise = false;
    options.frames = 6;
    const Sequence sequence = walk(world, options);
    std::size_t seen = 0;
    for (std::size_t n = 0; n < sequence.frames.size(); ++n) {
        const DepthFrame& frame = sequence.frames[n];
        for (std::size_t at = 0; at < frame.depth.size(); ++at) {
            if (frame.depth[at] == 0) continue;
            ++seen;
            const Vec3 p = world.to_room(back_projected(sequence.intrinsics, frame.camera_to_world,
                                                        at, frame.depth[at] / 1000.0));
            const double d = world.distance(p).first;
            const auto part = static_cast<std::size_t>(sequence.part[n][at]);
            ASSERT_LT(std::abs(d), 0.0007) << "frame " << n << " pixel " << at;
            ASSERT_LT(std::abs(world.parts[part].distance(p)), 0.0007);
        }
    }
    EXPECT_GT(seen, 6u * 320 * 240 * 6 / 10) << "most of each image shows the room within range";
}

// Culling must not lose parts: the same image ray by ray over all parts.
TEST_P(EachFurniture, CullingLosesNothing) {
    const World world = furnished_room({.seed = 9, .varied = GetParam()});
    CameraOptions options;
    options.noise = false;
    const auto& k = options.intrinsics;
    const Mat4 pose =
        look_at({world.room[0] / 2, world.room[1] / 2, 1.4}, {world.room[0], world.room[1], 0.5});
    std::vector<std::uint16_t> depth;
    render(world, options, pose, 1, depth);
    for (std::size_t at = 0; at < depth.size(); at += 7) {
        Vec3 d = back_projected(k, pose, at, 1);
        for (std::size_t a = 0; a < 3; ++a) d[a] -= pose[4 * a + 3];
        const double length = std::hypot(d[0], d[1], d[2]);
        for (double& a : d) a /= length;
        double t = 1e9;
        for (const Part& part : world.parts)
            t = std::min(t, part.hit({pose[3], pose[7], pose[11]}, d));
        const double z = t / length;
        const bool in_range = z >= options.min_range_m && z <= options.max_range_m;
        EXPECT_EQ(depth[at], in_range ? std::lround(z * 1000) : 0) << "pixel " << at;
    }
}

// Head on against a wall, the spread of the readings is the sensor's at that depth, within 5 %
// (thousands of pixels: five standard errors).
TEST(DepthCamera, NoiseGrowsWithDepthSquared) {
    World world;
    world.objects.push_back({"room", "room"});
    world.parts.push_back({Shape::box, {0, 10, 0}, {20, 0.1, 20}, 0, 0, 0, "wall"});
    CameraOptions options;
    options.grazing_deg = 89;
    for (const double z : {1.0, 2.0, 4.0}) {
        std::vector<std::uint16_t> depth;
        render(world, options, look_at({0, 9.95 - z, 0}, {0, 9.95, 0}), 3, depth);
        double sum = 0, squares = 0;
        int n = 0;
        for (std::uint32_t v = 90; v < 150; ++v) {
            for (std::uint32_t u = 110; u < 210; ++u) {
                const double e = depth[v * 320 + u] / 1000.0 - z;
                sum += e;
                squares += e * e;
                ++n;
            }
        }
        const double expected = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
        EXPECT_NEAR(sum / n, 0, 5 * expected / std::sqrt(n)) << z;
        EXPECT_NEAR(std::sqrt(squares / n), expected, 0.05 * expected + 0.0003 * 0.3) << z;
    }
}

TEST(DepthCamera, LosesEdgesGrazingAndRange) {
    const World world = furnished_room({.seed = 2});
    CameraOptions clean, noisy;
    clean.noise = false;
    std::vector<std::uint16_t> a, b;
    const Mat4 pose =
        look_at({world.room[0] / 2, world.room[1] / 2, 1.4}, {0, world.room[1] / 3, 0.6});
    render(world, clean, pose, 1, a);
    const auto part = render(world, noisy, pose, 1, b);
    std::size_t lost = 0, both = 0, jumps_kept = 0;
    for (std::size_t at = 320; at + 320 < a.size(); ++at) {
        lost += a[at] != 0 && b[at] == 0;
        both += a[at] != 0 && b[at] != 0;
        EXPECT_EQ(b[at] == 0, part[at] < 0);
        EXPECT_TRUE(b[at] == 0 || (b[at] >= 400 && b[at] <= 5500));
        const bool jump = std::abs(a[at] - a[at + 1]) > 500 && at % 320 != 319;
        jumps_kept += jump && b[at] != 0 && b[at + 1] != 0;
    }
    EXPECT_GT(lost, 200u);
    EXPECT_GT(both, 10 * lost);
    EXPECT_EQ(jumps_kept, 0u);
}

TEST(DepthCamera, SeesMostOfTheRoom) {
    const World world = furnished_room({.seed = 4});
    const Sequence sequence = walk(world, {});
    std::set<std::int32_t> parts(sequence.part_of_point.begin(), sequence.part_of_point.end());
    EXPECT_GT(parts.size(), world.parts.size() * 8 / 10);
    EXPECT_GT(sequence.cloud.size(), 300000u);
    EXPECT_EQ(sequence.cloud.size(), sequence.part_of_point.size());
}

TEST(DepthCamera, SameSeedSameBytesWithAnyThreads) {
    const World world = furnished_room({.seed = 6, .tilt_deg = 5});
    CameraOptions options;
    options.frames = 5;
    options.threads = 1;
    const TemporaryFolder folder("topple_lab");
    write_sequence(folder.path() / "a", world, walk(world, options));
    options.threads = 4;
    write_sequence(folder.path() / "b", furnished_room({.seed = 6, .tilt_deg = 5}),
                   walk(world, options));
    const auto a = contents(folder.path() / "a"), b = contents(folder.path() / "b");
    ASSERT_EQ(a.size(), 5u + 4u);
    EXPECT_TRUE(a == b);
    options.seed = 2;
    write_sequence(folder.path() / "c", world, walk(world, options));
    EXPECT_FALSE(a == contents(folder.path() / "c"));
}

TEST(DepthCamera, SingleFrameHasNoTrajectory) {
    const World world = furnished_room({.seed = 6});
    CameraOptions options;
    options.single = true;
    const Sequence sequence = walk(world, options);
    const TemporaryFolder folder("topple_lab");
    write_sequence(folder.path(), world, sequence);
    EXPECT_FALSE(fs::exists(folder.path() / "trajectory.txt"));
    EXPECT_TRUE(fs::exists(folder.path() / "depth" / "0000.png"));
    EXPECT_EQ(sequence.frames.size(), 1u);
    EXPECT_GT(sequence.cloud.size(), 30000u);
}

TEST(DepthCamera, FilesHoldTheFrames) {
    const World world = furnished_room({.seed = 6, .tilt_deg = 20});
    CameraOptions options;
    options.frames = 2;
    const Sequence sequence = walk(world, options);
    const TemporaryFolder folder("topple_lab");
    write_sequence(folder.path(), world, sequence);
    const auto read = io::FrameSequence::open(folder.path());
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(read.intrinsics().width, 320u);
    EXPECT_EQ(read.intrinsics().height, 240u);
    for (std::size_t n = 0; n < 2; ++n) {
        EXPECT_EQ(read.load(n).depth, sequence.frames[n].depth);
        for (std::size_t k = 0; k < 16; ++k)
            EXPECT_NEAR(read.poses()[n][k], sequence.frames[n].camera_to_world[k], 1e-8);
    }
}

TEST(GroundTruth, HoldsTheWorld) {
    World world = furnished_room({.seed = 21, .tilt_deg = 7});
    const TemporaryFolder folder("topple_lab");
    fs::create_directories(folder.path());
    write_truth(folder.path() / "truth.json", world);
    const auto truth = nlohmann::json::parse(std::ifstream(folder.path() / "truth.json"));
    ASSERT_EQ(truth.at("parts").size(), world.parts.size());
    for (std::size_t k = 0; k < world.parts.size(); ++k) {
        const auto& part = truth["parts"][k];
        EXPECT_EQ(part.at("kind"), to_string(world.parts[k].shape));
        EXPECT_EQ(part.at("center").get<Vec3>(), world.parts[k].center);
        EXPECT_EQ(part.at("size").get<Vec3>(), world.parts[k].size);
        EXPECT_EQ(part.at("yaw"), world.parts[k].yaw);
        EXPECT_EQ(part.at("top_ratio"), world.parts[k].top_ratio);
        EXPECT_EQ(part.at("object"), world.parts[k].object);
        EXPECT_EQ(part.at("volume"), world.parts[k].volume());
    }
    using Pairs = std::vector<std::pair<std::int32_t, std::int32_t>>;
    EXPECT_EQ(truth.at("fixed").get<Pairs>(), world.fixed);
    EXPECT_EQ(truth.at("support").get<Pairs>(), world.support);
    EXPECT_EQ(truth.at("tilt")[1][2], world.tilt[5]);
    EXPECT_EQ(truth.at("room").get<Vec3>(), world.room);
    EXPECT_EQ(truth.at("objects").size(), world.objects.size());
}

}  // namespace
}  // namespace topple::scenes

// SPDX-License-Identifier: MIT
#include "lab/rooms/furnished_room.h"

#include "core/union_find.h"
#include "device/devices.h"
#include "lab/evaluation/room.h"
#include "lab/random.h"
#include "testing.h"
#include "vdb/voxel_scene.h"

namespace topple::scenes {
namespace {

constexpr std::uint64_t seeds = 50;

// What holds for the plain rooms and for the varied ones.
class FurnishedRoom : public ::testing::TestWithParam<bool> {
  protected:
    static World room(std::uint64_t seed) {
        return furnished_room({.seed = seed, .varied = GetParam()});
    }
    static const std::map<std::uint64_t, World>& rooms() {
        static std::map<std::uint64_t, World> of[2];
        auto& out = of[GetParam()];
        for (std::uint64_t seed = out.size(); seed < seeds; ++seed) out.emplace(seed, room(seed));
        return out;
    }
};
INSTANTIATE_TEST_SUITE_P(Furniture, FurnishedRoom, ::testing::Bool(),
                         [](const auto& kind) { return kind.param ? "varied" : "plain"; });

std::string name(const World& world, std::int32_t part) {
    const Part& p = world.parts[part];
    return world.objects[p.object].name + "/" + p.name + " #" + std::to_string(part);
}

TEST_P(FurnishedRoom, SolidsNeverOverlap) {
    for (const auto& [seed, world] : rooms()) {
        std::vector<Bounds> boxes;
        for (const Part& part : world.parts) boxes.push_back(part.bounds());
        for (std::size_t a = 0; a < world.parts.size(); ++a) {
            for (std::size_t b = a + 1; b < world.parts.size(); ++b) {
                if (!overlap(boxes[a], boxes[b], -1e-9)) continue;
                EXPECT_GT(gap(world.parts[a], world.parts[b]), -1e-6)
                    << "seed " << seed << ": " << name(world, static_cast<std::int32_t>(a))
                    << " and " << name(world, static_cast<std::int32_t>(b));
            }
        }
    }
}

TEST_P(FurnishedRoom, FixedPartsTouch) {
    for (const auto& [seed, world] : rooms()) {
        for (const auto& [a, b] : world.fixed) {
            const double g = gap(world.parts[a], world.parts[b]);
            EXPECT_LT(std::abs(g), 1e-3)
                << "seed " << seed << ": " << name(world, a) << " and " << name(world, b);
        }
    }
}

// What is carried touches its supporter's top with the middle of its underside, and is nowhere
// lower.
TEST_P(FurnishedRoom, SupportHolds) {
    for (const auto& [seed, world] : rooms()) {
        for (const auto& [supporter, supported] : world.support) {
            const Part& below = world.parts[supporter];
            const Part& above = world.parts[supported];
            const std::string pair = name(world, supporter) + " under " + name(world, supported);
            EXPECT_NEAR(above.bottom(), below.top(), 1e-9) << "seed " << seed << ": " << pair;
            EXPECT_NEAR(below.distance({above.center[0], above.center[1], above.bottom()}), 0, 1e-9)
                << "seed " << seed << ": " << pair;
            EXPECT_NE(below.object, above.object);
        }
    }
}

// Points where a part touches the level plane at its lowest.
std::vector<Vec3> footprint(const Part& part) {
    const auto box = part.bounds();
    std::vector<Vec3> points;
    for (double x = box[0][0]; x <= box[1][0]; x += 0.004) {
        for (double y = box[0][1]; y <= box[1][1]; y += 0.004) {
            if (std::abs(part.distance({x, y, box[0][2]})) < 1e-3) points.push_back({x, y, 0});
        }
    }
    return points;
}

// With one density everywhere, nothing that stands freely would tip: seen from any side, the center
// of mass is over what its feet span.
TEST_P(FurnishedRoom, EverythingStands) {
    for (const auto& [seed, world] : rooms()) {
        std::vector<std::vector<Vec3>> feet(world.objects.size());
        for (const auto& pair : world.support) {
            const Part& foot = world.parts[pair.second];
            auto& all = feet[foot.object];
            const auto points = footprint(foot);
            all.insert(all.end(), points.begin(), points.end());
        }
        for (std::size_t o = 1; o < feet.size(); ++o) {
            const std::string& object = world.objects[o].name;
            const bool leans = object == "ladder" || object.find("leaning") != std::string::npos;
            if (feet[o].empty() || leans) continue;  // on or against a wall
            Vec3 center{};
            double volume = 0;
            for (const Part& part : world.parts) {
                if (part.object != static_cast<std::int32_t>(o)) continue;
                const Vec3 c = part.center_of_mass();
                for (std::size_t a = 0; a < 2; ++a) center[a] += c[a] * part.volume();
                volume += part.volume();
            }
            for (double angle = 0; angle < 6.28; angle += 0.1) {
                const double x = std::cos(angle), y = std::sin(angle);
                double reach = -100;
                for (const Vec3& p : feet[o]) reach = std::max(reach, x * p[0] + y * p[1]);
                EXPECT_GT(reach, (x * center[0] + y * center[1]) / volume)
                    << "seed " << seed << ": " << object;
            }
        }
    }
}

// Every object but the room is held: by a support, or by a joint with a wall.
TEST_P(FurnishedRoom, NothingFloats) {
    for (const auto& [seed, world] : rooms()) {
        std::set<std::int32_t> held{0};
        for (const auto& pair : world.support) held.insert(world.parts[pair.second].object);
        for (const auto& [a, b] : world.fixed) {
            const auto p = world.parts[a].object, q = world.parts[b].object;
            if (p == 0) held.insert(q);
            if (q == 0) held.insert(p);
        }
        EXPECT_EQ(held.size(), world.objects.size()) << "seed " << seed;
    }
}

TEST_P(FurnishedRoom, PartsOfAnObjectAreJoined) {
    for (const auto& [seed, world] : rooms()) {
        UnionFind joined(world.parts.size());
        for (const auto& [a, b] : world.fixed)
            joined.join(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
        // Parts of an object follow one another.
        for (std::size_t n = 1; n < world.parts.size(); ++n) {
            if (world.parts[n].object != world.parts[n - 1].object) continue;
            EXPECT_EQ(joined.root(n), joined.root(n - 1))
                << "seed " << seed << ": " << name(world, static_cast<std::int32_t>(n));
        }
    }
}

TEST_P(FurnishedRoom, MiddleStaysFree) {
    for (const auto& [seed, world] : rooms()) {
        const auto middle = free_middle(world);
        for (double u = -1; u <= 1; u += 0.1) {
            for (double v = -1; v <= 1; v += 0.1) {
                for (const double z : {0.1, 0.5, 1.0, 1.5, 1.9}) {
                    const Vec3 p{world.room[0] / 2 + u * middle[0],
                                 world.room[1] / 2 + v * middle[1], z};
                    EXPECT_GT(world.distance(p).first, 0) << "seed " << seed;
                }
            }
        }
    }
}

TEST_P(FurnishedRoom, IsRichAndVaried) {
    std::set<std::string> names;
    std::set<Shape> shapes;
    std::size_t fewest = 1000, most = 0;
    for (const auto& [seed, world] : rooms()) {
        for (const TrueObject& object : world.objects) names.insert(object.name);
        for (const Part& part : world.parts) shapes.insert(part.shape);
        fewest = std::min(fewest, world.objects.size());
        most = std::max(most, world.objects.size());
    }
    EXPECT_GE(names.size(), GetParam() ? 55u : 25u);
    EXPECT_EQ(shapes.size(), GetParam() ? 7u : 5u);
    EXPECT_GE(fewest, 10u);
    EXPECT_GE(most, 2 * fewest);
}

TEST_P(FurnishedRoom, SameSeedSameRoomOtherSeedAnother) {
    const World a = room(7), b = room(7), c = room(8);
    ASSERT_EQ(a.parts.size(), b.parts.size());
    for (std::size_t k = 0; k < a.parts.size(); ++k) {
        EXPECT_EQ(a.parts[k].center, b.parts[k].center);
        EXPECT_EQ(a.parts[k].size, b.parts[k].size);
    }
    EXPECT_NE(a.room, c.room);
    EXPECT_NE(a.room, furnished_room({.seed = 7, .varied = !GetParam()}).room);
}

// What leans touches a wall without being fixed to it.
TEST(VariedRoom, LeaningThingsTouchAWall) {
    std::size_t leaning = 0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const World world = furnished_room({.seed = seed, .varied = true});
        for (const Part& part : world.parts) {
            const std::string& object = world.objects[part.object].name;
            if (object.find("leaning") == std::string::npos) continue;
            ++leaning;
            double nearest = 1;
            for (std::size_t wall = 1; wall <= 4; ++wall)
                nearest = std::min(nearest, gap(part, world.parts[wall]));
            EXPECT_NEAR(nearest, 0, 1e-3) << "seed " << seed << ": " << object;
            EXPECT_NE(part.lean, 0);
        }
    }
    EXPECT_GT(leaning, seeds / 3);
}

TEST_P(FurnishedRoom, TiltIsARotationByTheAngle) {
    const World world = furnished_room({.seed = 3, .tilt_deg = 20, .varied = GetParam()});
    const auto& t = world.tilt;
    EXPECT_NEAR((t[0] + t[4] + t[8] - 1) / 2, std::cos(20 * 3.14159265358979 / 180), 1e-12);
    const Vec3 p{1, 2, 3}, q = world.to_room(world.to_input(p));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(p[k], q[k], 1e-12);
}

}  // namespace
}  // namespace topple::scenes

namespace topple::evaluation {
namespace {

scenes::World box_in_a_room() {
    scenes::World w;
    w.room = {4, 3, 2};
    w.tilt = scenes::rotation({0.6, 0, 0.8}, 0.4);
    w.objects = {{"room", "room"}, {"box", "floor"}};
    w.parts.push_back({scenes::Shape::box, {2, 1.5, -0.05}, {4, 3, 0.1}, 0, 0, 0, "floor"});
    w.parts.push_back({scenes::Shape::box, {3, 1.5, 0.3}, {0.6, 0.6, 0.6}, 0, 0, 1, "box"});
    // Walls on three sides, so high that every pixel has a reading.
    w.parts.push_back({scenes::Shape::box, {4.05, 1.5, 2}, {0.1, 3, 4}, 0, 0, 0, "wall"});
    w.parts.push_back({scenes::Shape::box, {2, -0.05, 2}, {4, 0.1, 4}, 0, 0, 0, "wall"});
    w.parts.push_back({scenes::Shape::box, {2, 3.05, 2}, {4, 0.1, 4}, 0, 0, 0, "wall"});
    return w;
}

// One frame that looks along the room from x = 0.5 at a height of 1 m.
scenes::Sequence one_view(const scenes::World& w, const scenes::CameraOptions& camera) {
    scenes::Sequence sequence;
    sequence.intrinsics = camera.intrinsics;
    const Mat4 pose = scenes::look_at({0.5, 1.5, 1}, {3, 1.5, 1});
    sequence.frames.resize(1);
    scenes::render(w, camera, pose, 1, sequence.frames[0].depth);
    sequence.frames[0].camera_to_world = scenes::product(scenes::rigid(w.tilt, {}), pose);
    return sequence;
}

// Half the image is 160 of 277 pixels across and 120 up: what is 2 m ahead is in view up to 1.155 m
// aside and 0.866 m up or down.
TEST(InView, IsTheImageWithinRangeInsideTheRoom) {
    const scenes::World w = box_in_a_room();
    scenes::CameraOptions camera;
    const scenes::Sequence sequence = one_view(w, camera);
    const auto sees = in_view(w, camera, sequence);
    EXPECT_TRUE(sees({2.5, 1.5, 1}));
    EXPECT_TRUE(sees({2.5, 1.5 + 1.15, 1}));
    EXPECT_FALSE(sees({2.5, 1.5 + 1.17, 1}));
    EXPECT_TRUE(sees({2.5, 1.5, 1 - 0.86}));
    EXPECT_FALSE(sees({2.5, 1.5, 1 - 0.88}));
    EXPECT_FALSE(sees({0.4, 1.5, 1})) << "behind the camera";
    EXPECT_TRUE(sees({3.9, 1.5, 0.2})) << "hidden by the box, but in the image";
    EXPECT_FALSE(sees({4.1, 1.5, 1})) << "outside of the room";
    camera.max_range_m = 1.9;
    EXPECT_FALSE(in_view(w, camera, sequence)({2.5, 1.5, 1}));
}

// One picture's voxels: nothing is invisible in front of the box, everything behind it is.
TEST(NeverSeenEmpty, IsWhatNoRayPassed) {
    const scenes::World w = box_in_a_room();
    scenes::CameraOptions camera;
    camera.noise = false;
    camera.single = true;
    scenes::Sequence sequence = one_view(w, camera);
    sequence.part.resize(1);
    sequence.part[0].resize(sequence.frames[0].depth.size());
    scenes::fuse(camera, sequence);
    vdb::VoxelFrame frame;
    for (std::size_t a = 0; a < 3; ++a) {
        Vec3 axis{};
        axis[a] = 1;
        frame.grid_from_input[a] = w.to_input(axis);
    }
    const std::vector<std::int32_t> label(sequence.cloud.size(), 0);
    const auto voxels = std::make_shared<vdb::VoxelScene>(frame, sequence.cloud, label);
    const auto device = device::open_device("native");
    voxels->carve(*device, sequence.intrinsics, sequence.frames);
    const auto sees = in_view(w, camera, sequence);
    Room room;
    room.world = w;
    room.parse.voxels = voxels;
    const SolidVoxels hidden = never_seen_empty(room, sees);
    std::size_t in_front = 0, inside = 0, outside = 0;
    for (std::size_t n = 0; n < hidden.x.size(); ++n) {
        const Vec3 p = w.to_room({hidden.x[n], hidden.y[n], hidden.z[n]});
        in_front += p[0] > 1 && p[0] < 2.6 && p[1] > 0.1 && p[1] < 2.9 && p[2] > 0.05;
        inside += w.parts[1].distance(p) < 0;
        outside += !sees(p);
    }
    EXPECT_EQ(in_front, 0u);
    EXPECT_EQ(outside, 0u);
    const auto volume = scenes::volume_score(w, hidden, frame.voxel_m, sees);
    EXPECT_GT(volume.recall.value, 0.99);
    // The box's shadow on the floor is about as large as the box.
    EXPECT_GT(volume.precision.value, 0.3);
    EXPECT_LT(volume.precision.value, 0.8);
    EXPECT_GT(inside, 10000u);
}

TEST(SurfaceAlone, KeepsWhatWasSeen) {
    SolidVoxels solid;
    solid.x = {1, 2, 3};
    solid.y = solid.z = solid.x;
    solid.state = {1, 0, 1};
    const SolidVoxels seen = surface_alone(solid);
    EXPECT_EQ(seen.x, std::vector<float>{2});
    EXPECT_EQ(seen.z, std::vector<float>{2});
}

RoomOptions coarse_options(std::uint64_t seed) {
    RoomOptions options;
    options.room.seed = options.camera.seed = seed;
    options.parse.voxel_m = 0.03;
    options.parse.disturbances = {"wind"};
    options.parse.device = device::open_device("native");
    return options;
}

// A single frame knows neither where the camera stood nor how it was turned: the result is judged
// in the room's frame all the same.
TEST(Room, OfASingleFrameIsJudgedInTheRoom) {
    RoomOptions options = coarse_options(2);
    options.room.tilt_deg = 10;
    options.camera.single = true;
    const Room room = scan_and_parse(options);
    const auto nobodys = std::count(room.part.begin(), room.part.end(), -1);
    EXPECT_LT(nobodys, static_cast<std::ptrdiff_t>(room.part.size() / 20));
    const RoomScore score = judge(room);
    EXPECT_LT(score.gravity_deg, 5);
    EXPECT_GT(score.surface.precision.value, 0.9);
    EXPECT_GT(score.invisible.recall.value, 0.95);
    EXPECT_LT(score.invisible.precision.value, 0.9);
}

// A parse that says what is true, of a scan of few frames: judged as such.
TEST(Room, IsScannedParsedAndJudged) {
    RoomOptions options = coarse_options(3);
    options.camera.frames = 8;
    const Room room = scan_and_parse(options);
    const ScenePoints& points = room.parse.scene.points;
    ASSERT_EQ(room.part.size(), points.x.size());
    ASSERT_EQ(points.region.size(), points.x.size());
    const RoomScore score = judge(room);
    EXPECT_EQ(score.seed, 3u);
    EXPECT_EQ(score.parts, room.world.parts.size());
    // Merging and grouping join, so the finer labelling misses more and claims less wrongly.
    EXPECT_GT(score.parts_by_region.missing, score.parts_by_primitive.missing);
    EXPECT_GT(score.objects_by_region.missing, score.objects_by_object.missing);
    EXPECT_LT(score.objects_by_region.false_alarm, score.objects_by_object.false_alarm);
    // What is seen is a part of what is solid, and that of what was not seen to be empty.
    EXPECT_LT(score.surface.recall.value, score.completed.recall.value);
    EXPECT_LE(score.completed.recall.value, score.invisible.recall.value);
    EXPECT_LT(score.invisible.precision.value, score.completed.precision.value);
    EXPECT_GT(score.parts_by_primitive.cut_discrepancy, 0);
    EXPECT_GT(score.relations.fixed_recall.of, 10u);
    EXPECT_GT(score.parse_s, 0);
}

}  // namespace
}  // namespace topple::evaluation

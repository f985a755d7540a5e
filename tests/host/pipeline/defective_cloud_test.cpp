// SPDX-License-Identifier: MIT
#include "host/pipeline/scan.h"
#include "host/pipeline/small_room.h"

// Clouds as no sensor would deliver them, and as files nevertheless have them.
namespace topple::test {
namespace {

Scene parsed(const PointCloud& cloud) {
    ParseOptions options = on(device::open_device("native"));
    options.disturbances = {};
    return parse(cloud, options).scene;
}

// The label that most points of a part carry, and the share of them that do.
struct Majority {
    std::int32_t label = -1;
    double share = 0;
};
Majority majority(const SmallRoom& room, const std::vector<std::int32_t>& label,
                  SmallRoom::Part of) {
    std::map<std::int32_t, std::size_t> count;
    std::size_t all = 0;
    for (std::size_t i = 0; i < room.part.size(); ++i) {
        if (room.part[i] != of) continue;
        ++count[label[i]];
        ++all;
    }
    Majority best;
    for (const auto& [l, n] : count) {
        const double share = static_cast<double>(n) / static_cast<double>(all);
        if (share > best.share) best = {l, share};
    }
    return best;
}

// The parts are told apart, crate and box can move, and the shell is the ground.
void expect_understood(const SmallRoom& room, const Scene& scene) {
    ASSERT_EQ(scene.points.x, room.cloud.x);
    ASSERT_EQ(scene.points.primitive.size(), room.part.size());
    std::vector<std::int32_t> seen;
    for (int p = 0; p < SmallRoom::parts; ++p) {
        SCOPED_TRACE("part " + std::to_string(p));
        const auto part = static_cast<SmallRoom::Part>(p);
        const Majority primitive = majority(room, scene.points.primitive, part);
        EXPECT_GE(primitive.label, 0);
        EXPECT_EQ(std::count(seen.begin(), seen.end(), primitive.label), 0);
        seen.push_back(primitive.label);
        const Majority object = majority(room, scene.points.object, part);
        ASSERT_GE(object.label, 0);
        // The lid or the rim of a thing may go to what it touches, or stand for itself.
        const bool thing = part == SmallRoom::crate || part == SmallRoom::box;
        EXPECT_GE(object.share, thing ? 0.75 : 0.9);
        const Object& o = scene.objects[object.label];
        EXPECT_EQ(o.grounded, !thing);
        EXPECT_TRUE(std::isfinite(o.barrier_J) && std::isfinite(o.mass_kg));
    }
    EXPECT_GT(scene.up[2], std::cos(2 * M_PI / 180));
}

TEST_F(ParsedRoom, IsUnderstoodAndTellsWhatWasLeftOut) {
    expect_understood(room(), result().scene);
    EXPECT_EQ(result().scene.objects.size(), 3u);
    EXPECT_TRUE(noted(result().scene, "1234 points of " +
                                          std::to_string(1234 + room().part.size()) +
                                          " were not finite and left out."));
}

TEST(SlowDefectiveCloud, no_noise_at_all) {
    for (const double step_m : {0.01, 0.0125}) {
        SCOPED_TRACE(step_m);
        const SmallRoom room = SmallRoom::regular(step_m);
        expect_understood(room, parsed(room.cloud));
    }
}

TEST(SlowDefectiveCloud, every_point_several_times) {
    const SmallRoom once = SmallRoom::scattered();
    for (const int times : {2, 5}) {
        SmallRoom room = once;
        for (int n = 1; n < times; ++n) {
            for (std::size_t i = 0; i < once.part.size(); ++i)
                room.add({once.cloud.x[i], once.cloud.y[i], once.cloud.z[i]}, once.part[i]);
        }
        expect_understood(room, parsed(room.cloud));
    }
}

TEST(SlowDefectiveCloud, a_few_points_ten_thousand_times) {
    SmallRoom room = SmallRoom::scattered();
    const std::size_t stride = room.part.size() / 5;
    for (std::size_t k = 0; k < 5; ++k) {
        const std::size_t i = k * stride;
        for (int n = 1; n < 10'000; ++n)
            room.add({room.cloud.x[i], room.cloud.y[i], room.cloud.z[i]}, room.part[i]);
    }
    expect_understood(room, parsed(room.cloud));
}

TEST(SlowDefectiveCloud, a_wall_twenty_times_denser) {
    const SmallRoom room = SmallRoom::scattered(50'000, [](SmallRoom::Part part, const Vec3&) {
        return part == SmallRoom::west ? 50'000.0 : 2'500.0;
    });
    expect_understood(room, parsed(room.cloud));
}

TEST(SlowDefectiveCloud, density_falls_with_distance) {
    const Vec3 sensor{1.9, 1.8, 1.4};
    const SmallRoom room = SmallRoom::scattered(20'000, [&](SmallRoom::Part, const Vec3& p) {
        const double d = std::hypot(p[0] - sensor[0], p[1] - sensor[1], p[2] - sensor[2]);
        return std::min(20'000.0, 7'000 / (d * d));
    });
    expect_understood(room, parsed(room.cloud));
}

TEST(SlowDefectiveCloud, the_order_of_points_changes_no_label) {
    SmallRoom room = SmallRoom::scattered();
    topple::Random random(5);
    const auto noise = [&] { return static_cast<float>(0.004 * (random.uniform() - 0.5)); };
    for (std::size_t i = 0; i < room.part.size(); ++i) {
        room.cloud.x[i] += noise();
        room.cloud.y[i] += noise();
        room.cloud.z[i] += noise();
    }
    room.cloud.has_viewpoint = true;
    room.cloud.viewpoint = {2.3, 1.9, 1.4};
    std::vector<std::size_t> order(room.part.size());
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    PointCloud shuffled = room.cloud;
    for (std::size_t i = 0; i < order.size(); ++i) {
        shuffled.x[i] = room.cloud.x[order[i]];
        shuffled.y[i] = room.cloud.y[order[i]];
        shuffled.z[i] = room.cloud.z[order[i]];
    }
    const Scene a = parsed(room.cloud), b = parsed(shuffled);
    ASSERT_GT(a.objects.size(), 2u);
    EXPECT_EQ(a.voxel_size_m, b.voxel_size_m);
    std::size_t differ = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        differ += a.points.primitive[order[i]] != b.points.primitive[i];
        differ += a.points.object[order[i]] != b.points.object[i];
        differ += a.points.nx[order[i]] != b.points.nx[i];
    }
    EXPECT_EQ(differ, 0u);
    EXPECT_EQ(a.solid.x, b.solid.x);
    EXPECT_EQ(a.solid.primitive, b.solid.primitive);
    ASSERT_EQ(a.objects.size(), b.objects.size());
    for (std::size_t o = 0; o < a.objects.size(); ++o)
        EXPECT_EQ(a.objects[o].barrier_J, b.objects[o].barrier_J);
}

// Far strays cost neither the room its free space nor the machine its memory, and stay points.
TEST(SlowDefectiveCloud, a_few_points_ten_kilometres_away) {
    SmallRoom spoilt = SmallRoom::scattered();
    for (const Vec3& far : {Vec3{10'000, 20, 1}, {-4'000, 9'000, -3'000}, {1, 2, 10'000}})
        spoilt.add(far, -1);
    ParseOptions options = on(device::open_device("native"));
    options.max_memory_bytes = std::uint64_t{1} << 30;
    const Scene scene = parse(spoilt.cloud, options).scene;
    expect_understood(spoilt, scene);
    for (std::size_t i = spoilt.part.size() - 3; i < spoilt.part.size(); ++i) {
        EXPECT_EQ(scene.points.x[i], spoilt.cloud.x[i]);
        EXPECT_EQ(scene.points.object[i], -1);
    }
    EXPECT_EQ(scene.objects.size(), 3u);
    EXPECT_FALSE(noted(scene, "No free space"));
    EXPECT_TRUE(noted(scene, "free space was estimated"));
}

TEST(DefectiveCloud, without_a_scene_says_so) {
    const auto refused = [](const PointCloud& cloud) {
        try {
            parsed(cloud);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input);
            EXPECT_NE(std::string(error.what()).find("scan"), std::string::npos) << error.what();
            return true;
        }
        return false;
    };
    SmallRoom point, two;
    for (int i = 0; i < 2000; ++i) {
        point.add({1, 2, 3}, 0);
        two.add({1, 2, i % 2 ? 3 : 3.01}, 0);
    }
    EXPECT_TRUE(refused(point.cloud));
    EXPECT_TRUE(refused(two.cloud));
}

TEST(DefectiveCloud, a_line_is_a_rod) {
    SmallRoom line;
    for (int i = 0; i < 300; ++i) line.add({0.004 * i, 0.002 * i, 0.001 * i}, SmallRoom::box);
    const Scene scene = parsed(line.cloud);
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(majority(line, scene.points.object, SmallRoom::box).share, 1);
    EXPECT_TRUE(std::isfinite(scene.objects[0].barrier_J));
    EXPECT_TRUE(noted(scene, "Up could not be found"));
}

// A floor alone, a wall alone, a plane aslant: one primitive, and nothing that could fall.
TEST(DefectiveCloud, one_plane_is_one_primitive) {
    for (const auto& [u, v] : {std::pair(Vec3{1, 0, 0}, Vec3{0, 1, 0}),
                               {{1, 0, 0}, {0, 0, 1}},
                               {{0.8, 0.6, 0}, {0.36, -0.48, 0.8}}}) {
        SmallRoom plane;
        for (int a = 0; a < 80; ++a)
            for (int b = 0; b < 80; ++b)
                plane.add(SmallRoom::Face{{5, 5, 5}, u, v, SmallRoom::floor}.at(a / 40.0, b / 40.0),
                          0);
        const Scene scene = parsed(plane.cloud);
        ASSERT_EQ(scene.primitives.size(), 1u);
        ASSERT_EQ(scene.objects.size(), 1u);
        EXPECT_GE(majority(plane, scene.points.object, SmallRoom::floor).share, 0.95);
        EXPECT_TRUE(std::isfinite(scene.objects[0].barrier_J));
    }
}

TEST(DefectiveCloud, no_floor) {
    const SmallRoom room = SmallRoom::scattered(2500, [](SmallRoom::Part part, const Vec3&) {
        return part == SmallRoom::floor ? 0.0 : 2500.0;
    });
    const Scene scene = parsed(room.cloud);
    EXPECT_GE(majority(room, scene.points.object, SmallRoom::box).share, 0.9);
    EXPECT_GE(majority(room, scene.points.object, SmallRoom::west).share, 0.9);
    for (const Object& o : scene.objects)
        EXPECT_TRUE(std::isfinite(o.barrier_J) && (std::isfinite(o.unsafety) || !o.seen_enough));
}

}  // namespace
}  // namespace topple::test

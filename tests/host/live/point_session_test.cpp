// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/random.h"
#include "core/rotation.h"
#include "host/pipeline/scan.h"
#include "io/text.h"
#include "live/projection.h"
#include "topple/session.h"

// A session of sweeps of points: a sensor that looks all around goes through a room of boxes.
namespace topple::test {
namespace {

struct Box {
    Vec3 low, high;
};
using Boxes = std::vector<Box>;

// How far from `from` a ray meets the boxes, or the room's sides from inside.
double range_m(const Boxes& boxes, const Vec3& from, const Vec3& way) {
    const auto meets = [&](const Box& box) {
        double in = -INFINITY, out = INFINITY;
        for (std::size_t a = 0; a < 3; ++a) {
            const double low = (box.low[a] - from[a]) / way[a],
                         high = (box.high[a] - from[a]) / way[a];
            in = std::max(in, std::min(low, high));
            out = std::min(out, std::max(low, high));
        }
        return std::pair(in, out);
    };
    double nearest = meets({{0, 0, 0}, {4, 5, 2.5}}).second;
    for (const Box& box : boxes)
        if (const auto [in, out] = meets(box); in > 0 && in < out) nearest = std::min(nearest, in);
    return nearest;
}

const Box table_top{{2.4, 1, 0.7}, {3.6, 2, 0.74}}, crate{{1.2, 3.6, 0}, {1.9, 4.3, 0.7}},
    carton{{2.8, 1.3, 0.74}, {3.2, 1.7, 1.1}};
Boxes room() {
    Boxes out{table_top, crate, carton};
    for (const double x : {2.4, 3.54})
        for (const double y : {1.0, 1.94}) out.push_back({{x, y, 0}, {x + 0.06, y + 0.06, 0.7}});
    return out;
}
Boxes without(Boxes boxes, const Box& box) {
    std::erase_if(boxes, [&](const Box& b) { return b.low == box.low; });
    return boxes;
}

// Turned about the vertical by as much as where it stands.
Mat4 pose(std::size_t n) {
    const double turn = 0.7 * static_cast<double>(n), c = std::cos(turn), s = std::sin(turn);
    const double x = 0.9 + 0.17 * static_cast<double>(n % 5),
                 y = 1 + 0.4 * static_cast<double>(n % 6);
    return {c, -s, 0, x, s, c, 0, y, 0, 0, 1, 1.45, 0, 0, 0, 1};
}
// A ray each 1.2 degrees, with 3 mm of noise.
PointCloud sweep(const Boxes& boxes, std::size_t n) {
    Random random(n + 1);
    const Mat4 to_world = pose(n);
    PointCloud out;
    constexpr int rows = 150;
    for (int v = 4; v < rows - 4; ++v) {
        for (int u = 0; u < 2 * rows; ++u) {
            const double azimuth = (u + random.uniform(0, 1)) * std::numbers::pi / rows,
                         down = (v + random.uniform(0, 1)) * std::numbers::pi / rows;
            const Vec3 way{std::sin(down) * std::cos(azimuth), std::sin(down) * std::sin(azimuth),
                           std::cos(down)};
            const double range = range_m(boxes, {to_world[3], to_world[7], to_world[11]},
                                         turned(rotation_of(to_world), way)) +
                                 0.003 * random.normal();
            out.x.push_back(static_cast<float>(range * way[0]));
            out.y.push_back(static_cast<float>(range * way[1]));
            out.z.push_back(static_cast<float>(range * way[2]));
        }
    }
    return out;
}

SessionOptions quick() {
    SessionOptions options;
    options.parse = on(device::open_device("native", 2));
    options.parse.disturbances = {"wind"};
    options.parse.voxel_m = 0.03;
    return options;
}

// All sweeps in the world's frame, each point with its sensor's place.
PointCloud all_of(const std::vector<std::pair<PointCloud, Mat4>>& sweeps) {
    PointCloud out;
    for (const auto& [points, to_world] : sweeps) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec3 at = transformed(to_world, {points.x[i], points.y[i], points.z[i]});
            out.x.push_back(static_cast<float>(at[0]));
            out.y.push_back(static_cast<float>(at[1]));
            out.z.push_back(static_cast<float>(at[2]));
            out.viewpoint_x.push_back(static_cast<float>(to_world[3]));
            out.viewpoint_y.push_back(static_cast<float>(to_world[7]));
            out.viewpoint_z.push_back(static_cast<float>(to_world[11]));
        }
    }
    return out;
}

class PointSessions : public Files {
  protected:
    static std::int64_t thing_at(const Session& session, const Vec3& at) {
        PointCloud one;
        one.x = {static_cast<float>(at[0])};
        one.y = {static_cast<float>(at[1])};
        one.z = {static_cast<float>(at[2])};
        return session.label(CloudView(one), DepthFrame{}.camera_to_world).front();
    }
    static const Thing& thing(const LiveScene& scene, std::int64_t id) {
        static const Thing none{.id = ~ThingId{0}};
        const auto found = std::ranges::find(scene.things, static_cast<ThingId>(id), &Thing::id);
        return found == scene.things.end() ? none : *found;
    }
};

TEST_F(PointSessions, AnUpdateIsAParseOfAllPoints) {
    Session session = Session::of_points(quick());
    EXPECT_FALSE(session.intrinsics());
    std::vector<std::pair<PointCloud, Mat4>> sweeps;
    for (std::size_t n = 0; n < 4; ++n) {
        sweeps.emplace_back(sweep(room(), n), pose(n));
        Mat4 drifted = pose(n);
        drifted[3] += n == 2 ? 0.3 : 0;
        EXPECT_EQ(session.add(sweeps.back().first, drifted), n);
    }
    session.add(sweep(without(room(), crate), 9), pose(9));
    session.correct({{2, pose(2)}});
    session.forget(4);
    const auto found = session.update();
    const ParseResult expected = parse(CloudView(all_of(sweeps)), quick().parse);
    const Scene &got = found->result->scene, &wanted = expected.scene;
    EXPECT_EQ(got.points.x, wanted.points.x);
    EXPECT_EQ(got.points.object, wanted.points.object);
    EXPECT_EQ(got.solid.object, wanted.solid.object);
    ASSERT_EQ(got.objects.size(), wanted.objects.size());
    for (std::size_t o = 0; o < got.objects.size(); ++o)
        EXPECT_EQ(got.objects[o].barrier_J, wanted.objects[o].barrier_J);
    EXPECT_GE(got.objects.size(), 3u);
    EXPECT_EQ(session.settle(), found->result);
}

TEST_F(PointSessions, TellWhatHasGoneAndKnowThingsAgain) {
    Session session = Session::of_points(quick());
    for (std::size_t n = 0; n < 5; ++n) session.add(sweep(room(), n), pose(n));
    session.update();
    const Vec3 at_crate{1.5, 3.61, 0.45}, at_carton{2.81, 1.5, 0.9};
    const std::int64_t crate_id = thing_at(session, at_crate),
                       carton_id = thing_at(session, at_carton);
    EXPECT_GT(crate_id, 0);
    EXPECT_GT(carton_id, 0);
    EXPECT_NE(crate_id, carton_id);
    EXPECT_EQ(thing_at(session, {2, 2.5, 1.2}), -1) << "nothing is there";
    for (std::size_t n = 5; n < 10; ++n) session.add(sweep(without(room(), crate), n), pose(n));
    // As after a loop closure.
    Mat4 corrected = pose(1);
    corrected[7] += 0.004;
    session.correct({{1, corrected}});
    const auto found = session.update();
    EXPECT_EQ(thing(*found, crate_id).change, Change::gone);
    EXPECT_EQ(thing(*found, crate_id).object, -1);
    EXPECT_EQ(thing_at(session, at_carton), carton_id);
    EXPECT_EQ(thing(*found, carton_id).change, Change::none);
    EXPECT_EQ(thing_at(session, at_crate), -1);
    const auto all = session.settle();
    EXPECT_GT(all->scene.points.x.size(), found->result->scene.points.x.size())
        << "settled, what has gone is there";
}

// A carton comes onto a table: what it weighs and bears is told before an update knows of it.
TEST_F(PointSessions, AGlanceTellsWhatCame) {
    SessionOptions options = quick();
    options.parse.disturbances = {"human"};
    Session session = Session::of_points(options);
    EXPECT_TRUE(session.glance().empty());
    for (std::size_t n = 0; n < 5; ++n) session.add(sweep(without(room(), carton), n), pose(n));
    EXPECT_TRUE(session.glance().empty()) << "nothing is known before an update";
    session.update();
    session.add(sweep(without(room(), carton), 5), pose(5));
    EXPECT_TRUE(session.glance().empty()) << "nothing came";
    for (std::size_t n = 6; n < 9; ++n) session.add(sweep(room(), n), pose(n));
    const std::vector<Appeared> found = session.glance();
    ASSERT_EQ(found.size(), 1u);
    const Appeared& one = found.front();
    // 0.4 x 0.4 x 0.36 m at 700 kg/m3; of what was seen from one side its rear is not there.
    EXPECT_NEAR(one.middle_m[0], 3.0, 0.1);
    EXPECT_NEAR(one.middle_m[1], 1.5, 0.1);
    EXPECT_NEAR(one.middle_m[2], 0.74 + 0.18, 0.04);
    EXPECT_NEAR(one.size_m[2], 0.36, 0.05);
    EXPECT_NEAR(one.mass_kg, 700 * 0.4 * 0.4 * 0.36, 0.3 * 40);
    // m g (sqrt(h^2 + b^2) - h) over its edge.
    const double barrier = one.mass_kg * 9.81 * (std::hypot(0.18, 0.2) - 0.18);
    EXPECT_NEAR(one.barrier_J, barrier, 0.4 * barrier);
    EXPECT_GT(one.barrier_error_J, 0);
    EXPECT_EQ(one.risk_J.size(), 1u);
    EXPECT_FALSE(one.unsafety_category.empty());
    ASSERT_EQ(one.stands_on.size(), 1u);
    const auto& objects = session.scene()->result->scene.objects;
    const Object& below = objects[static_cast<std::size_t>(one.stands_on.front())];
    EXPECT_NEAR(below.box_middle_m[0], 3.0, 0.15) << "the table";
    // The update knows of it, and a glance then of nothing.
    const auto after = session.update();
    const std::int64_t id = thing_at(session, {2.81, 1.5, 0.9});
    EXPECT_GT(id, 0);
    EXPECT_TRUE(session.glance().empty());
}

TEST_F(PointSessions, GoOnFromACheckpoint) {
    const auto file = path("points.checkpoint");
    Session session = Session::of_points(quick());
    for (std::size_t n = 0; n < 3; ++n) session.add(sweep(room(), n), pose(n));
    PointCloud coloured = sweep(room(), 3);
    for (auto* channel : {&coloured.red, &coloured.green, &coloured.blue})
        for (std::size_t i = 0; i < coloured.size(); ++i)
            channel->push_back(static_cast<std::uint8_t>(1 + i % 200));
    session.add(coloured, pose(3));
    const auto before = session.update();
    session.checkpoint(file);
    Session again = Session::resume(file, quick());
    EXPECT_FALSE(again.intrinsics());
    EXPECT_EQ(again.frames(), session.frames());
    const auto found = again.update();
    EXPECT_EQ(found->result->scene.points.x, before->result->scene.points.x);
    EXPECT_EQ(found->result->scene.points.object, before->result->scene.points.object);
    ASSERT_EQ(found->things.size(), before->things.size());
    for (std::size_t n = 0; n < found->things.size(); ++n)
        EXPECT_EQ(found->things[n].id, before->things[n].id);
    // Whatever a file says, a word is said.
    const std::string whole(io::read_file(file).text());
    for (std::size_t at = 8; at < whole.size(); at += at < 200 ? 1 : 40'009) {
        std::string turned = whole;
        turned[at] = static_cast<char>(turned[at] ^ 0xFF);
        write("points.checkpoint", turned);
        EXPECT_THROW(Session::resume(file, quick()), Error) << at;
    }
}

TEST_F(PointSessions, RefuseWhatTheyDoNotTake) {
    Session points = Session::of_points(quick());
    Session frames(Intrinsics{4, 4, 4, 4, 1.5, 1.5, 1000}, {}, quick());
    const PointCloud some = sweep(room(), 0);
    const auto refused = [](const std::string& words, const auto& act) {
        try {
            act();
            ADD_FAILURE() << words;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
        }
    };
    refused("of depth frames", [&] { frames.add(some, pose(0)); });
    const std::vector<std::uint16_t> depth(16, 1000);
    FrameView frame;
    frame.depth = {depth.data(), 4, 4};
    refused("of points", [&] { points.add(frame, pose(0)); });
    refused("frame 0: it has no points", [&] { points.add(PointCloud{}, pose(0)); });
    refused("frame 0: sensor_to_world: ", [&] { points.add(some, Mat4{}); });
    PointCloud unlike = some;
    unlike.y.pop_back();
    refused("frame 0: y has ", [&] { points.add(unlike, pose(0)); });
    points.add(some, pose(0));
    refused("it is the frame before once more", [&] { points.add(some, pose(0)); });
    PointCloud lost = some;
    lost.z[7] = NAN;
    EXPECT_EQ(points.add(lost, pose(0)), 1u);
    refused("nothing is known before update()", [&] { points.label(some, pose(0)); });
    EXPECT_LT(points.frame_bytes(), 2 * 12 * some.size());
}

TEST(Projection, LooksAllAround) {
    const auto by = live::Projection::around(90, 1000);
    EXPECT_EQ(by.pixels(), 16200u);
    for (std::size_t v = 0; v < by.height(); ++v) {
        for (std::size_t u = 0; u < by.width(); ++u) {
            const auto seen = by.see(by.place(u, v, 2.5));
            ASSERT_TRUE(seen);
            EXPECT_EQ(seen->pixel, v * by.width() + u);
            EXPECT_NEAR(seen->depth_m, 2.5, 1e-5);
        }
    }
    EXPECT_EQ(by.see({0, 0, 1})->pixel / by.width(), 0u) << "above";
    EXPECT_EQ(by.see({0, 0, -1})->pixel / by.width(), 89u);
    EXPECT_FALSE(by.see({0, 0, 0}));
    // Columns go round, rows end.
    std::vector<std::uint16_t> stored(by.pixels(), 2000);
    stored[5 * by.width()] = 1000;
    const auto nearest = by.nearest_around(stored);
    EXPECT_EQ(nearest[5 * by.width() + by.width() - 1], 1000);
    EXPECT_EQ(nearest[5 * by.width() + 2], 2000);
    EXPECT_EQ(nearest[7], 0);
    // Rows of a sensor with gaps of one, and of two.
    for (std::size_t p = 0; p < stored.size(); ++p)
        if (const std::size_t row = p / by.width(); row < 40 ? row % 2 : row % 3) stored[p] = 0;
    const auto sparse = by.nearest_around(stored);
    EXPECT_EQ(sparse[21 * by.width() + 41], 2000);
    EXPECT_EQ(sparse[22 * by.width() + 41], 2000);
    std::ranges::fill(stored, 0);
    stored[20 * by.width() + 40] = stored[20 * by.width() + 41] = 2000;
    EXPECT_EQ(by.nearest_around(stored)[20 * by.width() + 41], 0);
}

}  // namespace
}  // namespace topple::test

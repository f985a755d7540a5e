// SPDX-License-Identifier: MIT
#include "lab/scores/score.h"

#include <nlohmann/json.hpp>

#include "clouds.h"
#include "host/io/files.h"
#include "lab/random.h"
#include "lab/rooms/furnished_room.h"
#include "lab/scan/files.h"
#include "lab/solids/ground_truth.h"
#include "lab/temporary_folder.h"
#include "topple/error.h"

namespace topple::scenes {
namespace {

namespace fs = std::filesystem;

// Floor, wall, a table, a cup and a ball on it, and a cabinet on the wall: boxes, upright cylinders
// and spheres only.
World small_world() {
    World w;
    w.room = {3, 2, 2};
    w.tilt = rotation({0.6, 0, 0.8}, 0.2);
    w.objects = {{"room", "room"},
                 {"table", "floor"},
                 {"cup", "table"},
                 {"ball", "table"},
                 {"cabinet", "wall"}};
    const auto add = [&](Shape shape, const Vec3& c, const Vec3& s, std::int32_t object,
                         const char* name, double yaw = 0) {
        w.parts.push_back({shape, c, s, yaw, 0, object, name});
    };
    add(Shape::box, {1.5, 1, -0.05}, {3, 2, 0.1}, 0, "floor");
    add(Shape::box, {1.5, 2.05, 1}, {3, 0.1, 2}, 0, "wall");
    add(Shape::box, {1, 1, 0.7}, {0.8, 0.6, 0.04}, 1, "top", 0.3);
    add(Shape::cylinder, {1, 1, 0.34}, {0.12, 0.12, 0.68}, 1, "column");
    add(Shape::cylinder, {0.9, 1, 0.77}, {0.09, 0.09, 0.1}, 2, "cup");
    add(Shape::sphere, {1.15, 1, 0.8}, {0.16, 0.16, 0.16}, 3, "ball");
    add(Shape::box, {2, 1.85, 1.5}, {0.8, 0.3, 0.4}, 4, "cabinet");
    w.fixed = {{0, 1}, {2, 3}, {6, 1}};
    w.support = {{0, 3}, {2, 4}, {2, 5}};
    return w;
}

// What a flawless parser would say, in voxels of 2 cm.
topple::Scene perfect(const World& world) {
    topple::Scene s;
    s.voxel_size_m = 0.02;
    s.up = world.to_input({0, 0, 1});
    const auto body = [&](std::int32_t part) {
        const std::int32_t o = world.parts[part].object;
        return o == 4 ? 0 : o;  // the cabinet hangs on the wall
    };
    Random random(3);
    const auto put = [](auto& list, const Vec3& p) { test::add(list, p[0], p[1], p[2]); };
    for (std::int32_t part = 0; part < static_cast<std::int32_t>(world.parts.size()); ++part) {
        const Part& p = world.parts[part];
        const auto box = p.bounds();
        for (int n = 0; n < 3000; ++n) {
            Vec3 q{};
            for (std::size_t k = 0; k < 3; ++k) q[k] = random(box[0][k], box[1][k]);
            const double d = p.distance(q);
            const Vec3 g = p.normal(q);
            for (std::size_t k = 0; k < 3; ++k) q[k] -= d * g[k];
            // Not where parts touch: rounding to float would decide whose the point is.
            bool alone = true;
            for (const Part& other : world.parts)
                alone = alone && (&other == &p || std::abs(other.distance(q)) > 1e-3);
            if (!alone) continue;
            put(s.points, world.to_input(q));
            s.points.primitive.push_back(part);
            s.points.object.push_back(body(part));
        }
    }
    for (double x = 0.01; x < 3; x += 0.02) {
        for (double y = 0.01; y < 2.1; y += 0.02) {
            for (double z = -0.09; z < 2; z += 0.02) {
                const auto [d, part] = world.distance({x, y, z});
                if (d > 0) continue;
                put(s.solid, world.to_input({x, y, z}));
                s.solid.primitive.push_back(part);
                s.solid.object.push_back(body(part));
                s.solid.state.push_back(1);
            }
        }
    }
    s.supports = {{0, 1, 1}, {1, 2, 1}, {1, 3, 1}};
    return s;
}

// The same with mistakes of every kind.
topple::Scene flawed(const World& world) {
    topple::Scene s = perfect(world);
    Random random(8);
    for (std::size_t n = 0; n < s.points.x.size(); ++n) {
        if (s.points.primitive[n] == 4) s.points.primitive[n] = 2;  // the cup became the table's
        if (s.points.primitive[n] == 5) s.points.object[n] = 1;     // so did the ball's object
        if (random.chance(0.1)) s.points.primitive[n] = random.integer(-1, 7);
        if (random.chance(0.05)) s.points.object[n] = random.integer(-1, 5);
        if (random.chance(0.02)) s.points.x[n] += 0.2f;
    }
    SolidVoxels kept;
    for (std::size_t n = 0; n < s.solid.x.size(); ++n) {
        if (s.solid.primitive[n] == 3 || random.chance(0.3)) continue;
        test::add(kept, s.solid.x[n] + (random.chance(0.1) ? 0.1f : 0), s.solid.y[n], s.solid.z[n]);
        kept.primitive.push_back(s.solid.primitive[n]);
        kept.object.push_back(s.solid.object[n]);
        kept.state.push_back(1);
    }
    s.solid = kept;
    s.supports = {{0, 1, 1}, {2, 1, 1}, {0, 3, 1}};
    s.up = {0.1, 0, 1};
    return s;
}

TEST(Score, PerfectParse) {
    const World world = small_world();
    const Score s = score(world, perfect(world));
    EXPECT_DOUBLE_EQ(s.parts.miou, 1);
    EXPECT_DOUBLE_EQ(s.parts.hamming, 0);
    EXPECT_DOUBLE_EQ(s.parts.cut_discrepancy, 0);
    EXPECT_NEAR(s.objects.miou, 4.0 / 5, 1e-12);  // the cabinet counts as the wall's
    EXPECT_EQ(s.volume.precision.value, 1);
    EXPECT_EQ(s.volume.recall.value, 1);
    EXPECT_GT(s.volume.recall.of, 5000u);
    EXPECT_EQ(s.relations.fixed_recall.value, 1);
    EXPECT_EQ(s.relations.fixed_recall.of, 3u);
    EXPECT_EQ(s.relations.fixed_precision.value, 1);
    EXPECT_EQ(s.relations.support_recall.value, 1);
    EXPECT_EQ(s.relations.support_recall.of, 3u);
    EXPECT_EQ(s.relations.support_precision.value, 1);
    EXPECT_NEAR(s.gravity_deg, 0, 1e-5);
}

TEST(Score, NoticesEachMistake) {
    const World world = small_world();
    const topple::Scene flawless = perfect(world);
    const Score good = score(world, flawless);
    topple::Scene s = flawless;
    for (auto& p : s.points.primitive) p = p == 4 ? 2 : p;
    EXPECT_LT(score(world, s).parts.miou, good.parts.miou - 0.1);
    EXPECT_GT(score(world, s).parts.false_alarm, good.parts.false_alarm + 0.02);
    s = flawless;
    for (auto& o : s.points.object) o = o == 2 ? 1 : o;
    EXPECT_EQ(score(world, s).relations.support_recall.value, 2.0 / 3);
    EXPECT_EQ(score(world, s).relations.fixed_precision.value, 3.0 / 4);
    s = flawless;
    s.supports.push_back({2, 3, 0.01});
    EXPECT_EQ(score(world, s).relations.support_precision.value, 3.0 / 4);
    s.supports.clear();
    EXPECT_EQ(score(world, s).relations.support_recall.value, 0);
    EXPECT_TRUE(std::isnan(score(world, s).relations.support_precision.value));
    s = flawless;
    for (std::size_t n = 0; n < s.points.x.size(); ++n) {
        if (s.points.primitive[n] == 3) s.points.object[n] = 7;
    }
    EXPECT_EQ(score(world, s).relations.fixed_recall.value, 2.0 / 3);
    s = flawless;
    s.solid = {};
    EXPECT_EQ(score(world, s).volume.recall.value, 0);
    s = flawless;
    test::add(s.solid, 2.5f, 0.5f, 1.0f);
    s.solid.primitive.push_back(0), s.solid.object.push_back(0), s.solid.state.push_back(1);
    EXPECT_LT(score(world, s).volume.precision.value, 1);
    s = flawless;
    s.up = world.to_input({0, std::sin(0.1), std::cos(0.1)});
    EXPECT_NEAR(score(world, s).gravity_deg, 0.1 * 180 / 3.14159265358979, 1e-6);
}

TEST(Score, SegmentationByHand) {
    // truth 0 0 0 0 1 1, predicted 5 5 6 6 6 -1: best matches hold 2 + 1 of 6 for the truth and 2 +
    // 2 + 1 for the prediction; intersection over union 2/4 and max(1/4, 1/2).
    const std::vector<std::int32_t> truth{0, 0, 0, 0, 1, 1}, predicted{5, 5, 6, 6, 6, -1};
    const auto s = segmentation_score(truth, predicted);
    EXPECT_DOUBLE_EQ(s.missing, 3.0 / 6);
    EXPECT_NEAR(s.false_alarm, 1.0 / 6, 1e-15);
    EXPECT_NEAR(s.hamming, 2.0 / 6, 1e-15);
    EXPECT_DOUBLE_EQ(s.miou, (0.5 + 0.5) / 2);
    EXPECT_EQ(segmentation_score({}, {}).miou, 0);
    EXPECT_THROW(segmentation_score(truth, {}), Error);
}

// Ten cells of 2 cm in a row; the truth cuts between the third and fourth, the prediction between
// the fifth and sixth. Cells 2 and 3 against 4 and 5 (from 0): 2 is 2 cells from 4, 3 is 1, and so
// back, 1.5 cells in the mean. The mean distance from the middle is 2.5 cells: 2 * 1.5 / 2.5.
TEST(CutDiscrepancy, OfARowByHand) {
    std::vector<float> x, y, z;
    std::vector<std::int32_t> truth, predicted;
    for (int n = 0; n < 10; ++n) {
        x.push_back(0.01f + 0.02f * static_cast<float>(n));
        y.push_back(0.01f);
        z.push_back(0.01f);
        truth.push_back(n < 3 ? 4 : 7);
        predicted.push_back(n < 5 ? -1 : 2);
    }
    const Positions points{x, y, z};
    EXPECT_NEAR(cut_discrepancy(points, truth, predicted, 0.02), 2 * 1.5 / 2.5, 1e-5);
    EXPECT_EQ(cut_discrepancy(points, truth, truth, 0.02), 0);
    // No cut at all in one of them: each cut of the other is as far as the mean radius.
    const std::vector<std::int32_t> one(10, 0);
    EXPECT_NEAR(cut_discrepancy(points, truth, one, 0.02), 1, 1e-12);
    EXPECT_EQ(cut_discrepancy(points, one, one, 0.02), 0);
    EXPECT_THROW(cut_discrepancy(points, truth, one, 0), Error);
    EXPECT_THROW(cut_discrepancy(points, truth, {}, 0.02), Error);
}

// Two sheets 6 cm apart: a cut in the one is not near the cut in the other, through the air.
TEST(CutDiscrepancy, WaysGoAlongTheSurface) {
    std::vector<float> x, y, z;
    std::vector<std::int32_t> truth, predicted;
    for (int sheet = 0; sheet < 2; ++sheet) {
        for (int n = 0; n < 400; ++n) {
            x.push_back(0.01f + 0.02f * static_cast<float>(n % 20));
            y.push_back(0.01f + 0.02f * static_cast<float>(n / 20));
            z.push_back(0.01f + 0.06f * static_cast<float>(sheet));
            truth.push_back(2 * sheet + (sheet == 0 && n % 20 < 10));
            predicted.push_back(2 * sheet + (sheet == 1 && n % 20 < 10));
        }
    }
    EXPECT_NEAR(cut_discrepancy({x, y, z}, truth, predicted, 0.02), 2, 1e-12);
}

// Points that are nobody's count neither as a part nor as a border.
TEST(CutDiscrepancy, PointsWithoutTruthAreLeftOut) {
    const std::vector<float> x{0.01f, 0.03f, 0.05f, 0.07f}, same(4, 0.01f);
    const std::vector<std::int32_t> truth{1, 1, -1, -1}, predicted{0, 0, 1, 2};
    EXPECT_EQ(cut_discrepancy({x, same, same}, truth, predicted, 0.02), 0);
    EXPECT_EQ(segmentation_score(truth, predicted).hamming, 0);
    EXPECT_EQ(segmentation_score(truth, predicted).miou, 1);
}

// A box of 20 x 10 x 10 voxels of 2 cm, half of them seen and 5 strays in the air: 1005 voxels of
// which 1000 are right, and those true ones found that are solid or beside a solid one.
TEST(VolumeScore, ByHand) {
    World world;
    world.objects = {{"room", "room"}, {"box", "floor"}};
    world.parts.push_back({Shape::box, {0, 0, -0.1}, {4, 4, 0.2}, 0, 0, 0, "floor"});
    world.parts.push_back({Shape::box, {0.2, 0.1, 0.1}, {0.4, 0.2, 0.2}, 0, 0, 1, "box"});
    SolidVoxels solid;
    const auto put = [&](int i, int j, int k) {
        test::add(solid, 0.02f * (static_cast<float>(i) + 0.5f),
                  0.02f * (static_cast<float>(j) + 0.5f), 0.02f * (static_cast<float>(k) + 0.5f));
    };
    for (int i = 0; i < 10; ++i) {
        for (int j = 0; j < 10; ++j) {
            for (int k = 0; k < 10; ++k) put(i, j, k);
        }
    }
    for (int n = 0; n < 5; ++n) put(40, 40, 20 + n);
    for (int n = 0; n < 7; ++n) put(40 + n, 40, -1);  // the floor's: not judged
    const VolumeScore all = volume_score(world, solid, 0.02);
    EXPECT_EQ(all.precision.of, 1005u);
    EXPECT_DOUBLE_EQ(all.precision.value, 1000.0 / 1005);
    EXPECT_EQ(all.recall.of, 2000u);
    EXPECT_DOUBLE_EQ(all.recall.value, 1100.0 / 2000);
    // Judged only where x < 0.1: the strays and half of what was found are out of it.
    const VolumeScore part =
        volume_score(world, solid, 0.02, [](const Vec3& p) { return p[0] < 0.1; });
    EXPECT_EQ(part.precision.of, 500u);
    EXPECT_EQ(part.precision.value, 1);
    EXPECT_EQ(part.recall.of, 500u);
    EXPECT_TRUE(std::isnan(volume_score(world, {}, 0.02).precision.value));
}

TEST(Score, RefusesAnEmptyParse) {
    EXPECT_THROW(score(small_world(), {}), Error);
}

// Points or voxels with their labels, as a parse writes them.
template <class Places>
void write_labelled(const fs::path& path, const Places& places) {
    std::string bytes;
    for (std::size_t n = 0; n < places.x.size(); ++n) {
        append_place(bytes, places.x[n], places.y[n], places.z[n]);
        test::append(bytes, places.primitive[n]);
        test::append(bytes, places.object[n]);
    }
    write_ply(path, places.x.size(), "property int primitive\nproperty int object\n", bytes);
}

std::string output_of(const std::string& command, int& status) {
    std::string text;
    std::FILE* pipe = ::popen(command.c_str(), "r");
    if (!pipe) return text;
    char part[512];
    while (std::fgets(part, sizeof(part), pipe)) text += part;
    status = ::pclose(pipe);
    return text;
}

// The independent scorer that judges parses from outside gives the same figures. It knows boxes,
// upright cylinders and spheres. Skips where it, or what it needs, is not there.
TEST(Score, AgreesWithTheOutsideScorer) {
    const char* shared = std::getenv("TOPPLE_SHARED");
    const fs::path shared_folder =
        shared ? fs::path(shared) : fs::path(TOPPLE_SOURCE_DIR) / ".." / "shared";
    const fs::path script = shared_folder / "eval" / "score.py";
    if (!fs::exists(script)) GTEST_SKIP() << "no " << script << ": set TOPPLE_SHARED";
    int status = 0;
    output_of("/usr/bin/python3 -c 'import numpy' 2>/dev/null", status);
    if (status != 0) GTEST_SKIP() << "/usr/bin/python3 has no numpy";

    const World world = small_world();
    const TemporaryFolder folder("topple_score");
    const fs::path& out = folder.path();
    for (const auto& parse : {perfect(world), flawed(world)}) {
        write_truth(out / "gt.json", world);
        write_labelled(out / "points.ply", parse.points);
        write_labelled(out / "solid.ply", parse.solid);
        nlohmann::json scene{{"voxel_size_m", parse.voxel_size_m},
                             {"up", parse.up},
                             {"supports", nlohmann::json::array()}};
        for (const Support& s : parse.supports)
            scene["supports"].push_back({{"supporter", s.supporter}, {"supported", s.supported}});
        std::ofstream(out / "scene.json") << scene;
        const std::string text =
            output_of("PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 " + script.string() + " " +
                          out.string() + " " + out.string() + " --json",
                      status);
        ASSERT_EQ(status, 0) << text;
        const auto theirs = nlohmann::json::parse(text);
        const Score ours = score(world, parse);
        const auto same = [&](const char* group, const char* key, double value) {
            EXPECT_NEAR(theirs.at(group).at(key).get<double>(), value, 1e-6) << group << " " << key;
        };
        for (const auto& [group, s] :
             {std::pair{"segmentation", ours.parts}, std::pair{"objects", ours.objects}}) {
            same(group, "hamming", s.hamming);
            same(group, "missing", s.missing);
            same(group, "false_alarm", s.false_alarm);
            same(group, "miou", s.miou);
        }
        same("volume", "precision", ours.volume.precision.value);
        same("volume", "recall", ours.volume.recall.value);
        same("relations", "fixed_recall", ours.relations.fixed_recall.value);
        same("relations", "fixed_precision", ours.relations.fixed_precision.value);
        same("relations", "support_recall", ours.relations.support_recall.value);
        same("relations", "support_precision", ours.relations.support_precision.value);
        same("gravity", "angle_deg", ours.gravity_deg);
    }
}

}  // namespace
}  // namespace topple::scenes

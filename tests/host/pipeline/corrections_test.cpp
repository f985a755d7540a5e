// SPDX-License-Identifier: MIT
#include "topple/corrections.h"

#include "host/pipeline/scan.h"
#include "host/pipeline/small_room.h"
#include "lab/temporary_folder.h"
#include "pipeline/stages.h"
#include "result/scene_json.h"
#include "scale/parts_cache.h"

// Corrections by hand through a whole parse.
namespace topple::test {
namespace {

using Kind = Correction::Kind;
using testing::ElementsAre;
using testing::HasSubstr;

Correction correction(Kind kind, std::vector<Vec3> at) {
    Correction c;
    c.kind = kind;
    c.at_m = std::move(at);
    return c;
}
template <class Value>
Correction correction(Kind kind, std::vector<Vec3> at, Value Correction::*member,
                      const Value& value) {
    Correction c = correction(kind, std::move(at));
    c.*member = value;
    return c;
}
Correction apart(const Vec3& at, const Vec3& from) {
    return correction(Kind::apart, {at}, &Correction::from_m, {from});
}
Correction fixed(std::vector<Vec3> at) {
    return correction(Kind::fixed, std::move(at));
}
Correction one_thing(std::vector<Vec3> at) {
    return correction(Kind::one_thing, std::move(at));
}
Correction mass(std::vector<Vec3> at, double kg) {
    return correction(Kind::mass, std::move(at), &Correction::mass_kg, kg);
}
Correction hollow(const Vec3& at) {
    return correction(Kind::hollow, {at}, &Correction::wall_m, 0.02);
}
Correction name(const Vec3& at, const char* called) {
    return correction(Kind::name, {at}, &Correction::name, std::string(called));
}

// On sides of the small room's things.
constexpr Vec3 on_crate{1.0, 1.2, 0.25}, on_box{1.2, 1.2, 0.7}, on_floor{0.4, 0.4, 0},
    on_east{2.8, 1.2, 0.7}, in_air{0.5, 0.5, 0.9};

std::size_t nearest_point(const Scene& scene, const PointCloud& cloud, const Vec3& at) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < scene.points.object.size(); ++n) {
        const double d = std::hypot(cloud.x[n] - at[0], cloud.y[n] - at[1], cloud.z[n] - at[2]);
        if (d < least) least = d, best = n;
    }
    return best;
}

// All go on from the parts that the first parse of the room found, which the cache keeps.
class CorrectedRoom : public testing::Test {
  protected:
    static void SetUpTestSuite() { folder_ = new scenes::TemporaryFolder("topple_corrected"); }
    static void TearDownTestSuite() { delete folder_; }
    static const PointCloud& cloud() {
        static const SmallRoom room = SmallRoom::scattered();
        return room.cloud;
    }
    static ParseResult parsed(std::vector<Correction> corrections, std::uint64_t seed = 1,
                              double voxel_m = 0, std::shared_ptr<const Materials> materials = {}) {
        const auto file = folder_->path() / "room.ply";
        if (!std::filesystem::exists(file)) scenes::write_cloud(file, cloud());
        ParseOptions options = on(device::open_device("native"));
        options.disturbances = {};
        options.seed = seed;
        options.voxel_m = voxel_m;
        options.corrections = std::move(corrections);
        options.materials = std::move(materials);
        options.cache_file = folder_->path() / ("cache" + std::to_string(voxel_m));
        return parse(file, options);
    }
    static std::int32_t id_at(const Scene& scene, const Vec3& at) {
        return scene.points.object[nearest_point(scene, cloud(), at)];
    }
    static const Object& object_at(const Scene& scene, const Vec3& at) {
        return scene.objects.at(static_cast<std::size_t>(id_at(scene, at)));
    }
    static void expect_held(const Scene& scene, std::size_t count) {
        ASSERT_EQ(scene.corrections.size(), count);
        for (const AppliedCorrection& c : scene.corrections) {
            EXPECT_TRUE(c.held) << to_string(c.correction.kind);
            EXPECT_EQ(c.outcome, "held") << to_string(c.correction.kind);
        }
        for (const std::string& note : scene.notes)
            EXPECT_FALSE(note.starts_with("Correction")) << note;
    }
    static void expect_known(std::uint64_t seed, double voxel_m) {
        const Scene plain = parsed({}, seed, voxel_m).scene;
        ASSERT_NE(id_at(plain, on_crate), id_at(plain, on_box));
        EXPECT_TRUE(plain.corrections.empty());
        const Scene scene = parsed({one_thing({on_crate, on_box}), mass({on_crate}, 12.5),
                                    name(on_crate, "chest"), hollow(on_crate)},
                                   seed, voxel_m)
                                .scene;
        expect_held(scene, 4);
        EXPECT_EQ(id_at(scene, on_crate), id_at(scene, on_box));
        EXPECT_EQ(scene.objects.size() + 1, plain.objects.size());
        const Object& chest = object_at(scene, on_crate);
        EXPECT_FALSE(chest.grounded);
        EXPECT_EQ(chest.name, "chest");
        EXPECT_THAT(chest.corrected, ElementsAre(1, 2, 3, 4));
        EXPECT_THAT(scene.corrections[1].objects, ElementsAre(chest.id));
        EXPECT_EQ(chest.mass_model, "hollow");
        EXPECT_NEAR(chest.mass_kg, 12.5, 1e-9);
        EXPECT_EQ(chest.mass_error_kg, 0);
        double of_parts = 0;
        for (const std::int32_t p : chest.primitives) of_parts += scene.primitives[p].mass_kg;
        EXPECT_NEAR(of_parts, 12.5, 1e-9);
        EXPECT_GT(chest.barrier_J, 0);
    }
    static inline const scenes::TemporaryFolder* folder_ = nullptr;
};

TEST_F(CorrectedRoom, IsAsSomebodyKnowsIt) {
    expect_known(1, 0);
}

class SlowCorrectedRoom : public CorrectedRoom {};
TEST_F(SlowCorrectedRoom, IsSoWhateverTheSeedAndTheVoxels) {
    expect_known(7, 0.03);
    expect_known(8, 0.016);
}

// Its own coefficient counts wherever it slides; by hand, or else by its name.
TEST_F(CorrectedRoom, RubsAsSomebodyKnows) {
    const auto rubs = [](double by) {
        return correction(Kind::friction, {on_box}, &Correction::coefficient, by);
    };
    const Scene plain = parsed({}).scene, icy = parsed({rubs(0.03)}).scene;
    expect_held(icy, 1);
    const Object &usual = object_at(plain, on_box), &box = object_at(icy, on_box);
    EXPECT_TRUE(std::isnan(usual.friction)) << "the scene's";
    EXPECT_EQ(box.friction, 0.03);
    EXPECT_TRUE(std::isnan(object_at(icy, on_crate).friction));
    EXPECT_NEAR(box.overturning.slide_N, 0.1 * usual.overturning.slide_N, 1e-9);
    EXPECT_EQ(box.mass_kg, usual.mass_kg);
    // Of what nobody told it is known to a third.
    const auto told = [](const Object& o) {
        return o.overturning.slide_N * o.mass_error_kg / o.mass_kg;
    };
    EXPECT_NEAR(box.overturning.slide_error_N, told(box), 1e-9);
    EXPECT_NEAR(usual.overturning.slide_error_N,
                std::hypot(told(usual), usual.overturning.slide_N / 3), 1e-9);
    EXPECT_EQ(box.mode, "slide");
    EXPECT_LT(box.barrier_J, usual.barrier_J);
    Materials kinds = household_materials();
    kinds.push_back({"ice box", {0.2, 0.2, 0.3}, 1, 900, 0.1, 0.05});
    const auto materials = std::make_shared<const Materials>(kinds);
    const Scene named = parsed({name(on_box, "ice box")}, 1, 0, materials).scene;
    EXPECT_EQ(object_at(named, on_box).friction, 0.05);
    const Scene both =
        parsed({name(on_box, "ice box"), rubs(0.4), rubs(0.6)}, 1, 0, materials).scene;
    EXPECT_EQ(object_at(both, on_box).friction, 0.4);
    EXPECT_FALSE(both.corrections[2].held) << "the first counts";
}

// A name says more of what a thing weighs than its size, a mass by hand all.
TEST_F(CorrectedRoom, WeighsByNamesAndSizes) {
    const auto kinds = std::make_shared<const Materials>(Materials{
        {"brick", {0.06, 0.1, 0.2}, 1, 1800, 0.1}, {"crate", {0.2, 0.25, 0.35}, 1, 120, 0.5}});
    const auto weighed = [&](std::vector<Correction> corrections) {
        return parsed(std::move(corrections), 1, 0, kinds).scene;
    };
    const double volume_m3 = 0.25 * 0.2 * 0.35;
    const Scene plain = weighed({}), named = weighed({name(on_box, "two bricks")}),
                known = weighed({mass({on_box}, 12.5)});
    const Object &by_size = object_at(plain, on_box), &by_name = object_at(named, on_box);
    EXPECT_EQ(by_size.mass_model, "kind");
    EXPECT_NEAR(by_size.mass_kg, 120 * volume_m3, 0.5 * 120 * volume_m3) << "as a crate, mostly";
    EXPECT_GT(by_size.mass_error_kg, 0.4 * by_size.mass_kg);
    EXPECT_NEAR(by_name.mass_kg, 1800 * volume_m3, 0.1 * 1800 * volume_m3);
    EXPECT_LT(by_name.mass_error_kg, 0.2 * by_name.mass_kg);
    EXPECT_GT(by_name.mass_error_kg, 0.09 * by_name.mass_kg);
    EXPECT_NEAR(by_name.barrier_J / by_size.barrier_J, by_name.mass_kg / by_size.mass_kg, 1e-6);
    EXPECT_NEAR(object_at(known, on_box).mass_kg, 12.5, 1e-9);
    EXPECT_EQ(object_at(known, on_box).mass_error_kg, 0);
}

// A shell is harder to turn than a block of the same mass, and weighs what its sides do.
TEST_F(CorrectedRoom, HoldsShells) {
    const Scene block = parsed({mass({on_crate}, 12.5)}).scene,
                shell = parsed({mass({on_crate}, 12.5), hollow(on_crate), hollow(on_box)}).scene;
    expect_held(shell, 3);
    EXPECT_EQ(object_at(block, on_crate).mass_model, "solid");
    EXPECT_NEAR(object_at(block, on_crate).mass_kg, 12.5, 1e-9);
    for (const std::size_t axis : {0u, 4u, 8u})
        EXPECT_GT(object_at(shell, on_crate).inertia_kg_m2[axis],
                  1.1 * object_at(block, on_crate).inertia_kg_m2[axis]);
    const double outer = 0.25 * 0.2 * 0.35, inner = 0.21 * 0.16 * 0.31;
    EXPECT_NEAR(object_at(shell, on_box).mass_kg, 700 * (outer - inner),
                0.2 * 700 * (outer - inner));
    EXPECT_NEAR(object_at(block, on_box).mass_kg, 700 * outer, 0.2 * 700 * outer);
}

TEST_F(CorrectedRoom, HasNoRiskOfWhatIsFixed) {
    const Scene plain = parsed({}).scene;
    ASSERT_FALSE(object_at(plain, on_crate).grounded);
    const Scene scene = parsed({fixed({on_crate}), fixed({on_floor})}).scene;
    expect_held(scene, 2);
    EXPECT_TRUE(object_at(scene, on_crate).grounded);
    EXPECT_EQ(id_at(scene, on_crate), id_at(scene, on_floor));
    EXPECT_FALSE(object_at(scene, on_box).grounded);
    EXPECT_THAT(object_at(scene, on_box).why.stands_on, ElementsAre(0));
    EXPECT_EQ(scene.objects.size() + 1, plain.objects.size());
    // Only parts of the room have names there, and it weighs nothing.
    const Scene named =
        parsed({fixed({on_crate}), name(on_crate, "shelf"), mass({on_crate}, 3)}).scene;
    EXPECT_EQ(named.objects[0].name, "");
    const std::int32_t part = named.points.primitive[nearest_point(named, cloud(), on_crate)];
    EXPECT_EQ(named.primitives[part].name, "shelf");
    EXPECT_FALSE(named.corrections[2].held);
    EXPECT_THAT(named.corrections[2].outcome, HasSubstr("building"));
}

TEST_F(CorrectedRoom, IsEmptyWhereAThingIsNotThere) {
    const ParseResult plain = parsed({});
    const ParseResult result = parsed({correction(Kind::not_there, {on_box})});
    const Scene& scene = result.scene;
    expect_held(scene, 1);
    EXPECT_EQ(id_at(scene, on_box), -1);
    EXPECT_EQ(scene.points.primitive[nearest_point(scene, cloud(), on_box)], -1);
    EXPECT_EQ(scene.points.object.size(), cloud().size());
    EXPECT_EQ(scene.objects.size() + 1, plain.scene.objects.size());
    EXPECT_TRUE(scene.corrections[0].objects.empty());
    const auto solid_in_box = [](const Scene& s) {
        int count = 0;
        for (std::size_t n = 0; n < s.solid.x.size(); ++n)
            count += s.solid.x[n] > 1.22 && s.solid.x[n] < 1.43 && s.solid.y[n] > 1.12 &&
                     s.solid.y[n] < 1.28 && s.solid.z[n] > 0.54 && s.solid.z[n] < 0.83;
        return count;
    };
    EXPECT_GT(solid_in_box(plain.scene), 100);
    EXPECT_EQ(solid_in_box(scene), 0);
    EXPECT_NEAR(object_at(scene, on_crate).mass_kg, object_at(plain.scene, on_crate).mass_kg, 2);
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
        EXPECT_EQ(scene.primitives[p].id, static_cast<std::int32_t>(p));
        EXPECT_GE(scene.primitives[p].object, 0);
    }
    const Vec3 middle{1.325, 1.2, 0.7};
    EXPECT_EQ(state_at(result, middle), vdb::State::empty);
    EXPECT_EQ(state_at(plain, middle), vdb::State::completed);
    // What was on it is taken away with it where both are one.
    const Scene none = parsed({one_thing({on_box, on_crate}), correction(Kind::not_there, {on_box}),
                               fixed({on_crate})})
                           .scene;
    EXPECT_EQ(id_at(none, on_crate), -1);
    EXPECT_FALSE(none.corrections[2].held);
    EXPECT_THAT(none.corrections[2].outcome, HasSubstr("correction 2"));
}

// A wall that is none: it is a board that stands there.
TEST_F(CorrectedRoom, MayHaveLessOfABuilding) {
    ASSERT_TRUE(object_at(parsed({}).scene, on_east).grounded);
    const Scene scene = parsed({apart(on_east, on_floor)}).scene;
    expect_held(scene, 1);
    EXPECT_NE(id_at(scene, on_east), id_at(scene, on_floor));
    EXPECT_TRUE(object_at(scene, on_floor).grounded);
    EXPECT_FALSE(object_at(scene, on_east).grounded);
    EXPECT_THAT(object_at(scene, on_east).corrected, ElementsAre(1));
    // Nor can it be fixed to what it is apart of: a reason that holds for both parts is told once.
    const Scene both = parsed({apart(on_east, on_floor), apart(on_crate, on_floor),
                               one_thing({on_east, on_crate}), fixed({on_east, on_crate})})
                           .scene;
    EXPECT_FALSE(object_at(both, on_east).grounded);
    EXPECT_EQ(both.corrections[3].outcome,
              "correction 1 keeps a part of its object apart from the building");
    const Scene things =
        parsed({apart(on_crate, on_box), fixed({on_crate}), fixed({on_box})}).scene;
    EXPECT_TRUE(object_at(things, on_box).grounded);
    EXPECT_TRUE(things.corrections[0].held);
    EXPECT_THAT(things.corrections[0].outcome, HasSubstr("both are fixed"));
}

// A thing that is joined to the building is judged no more, which nobody meant.
TEST_F(CorrectedRoom, WhatIsJoinedToTheBuildingIsTold) {
    const Scene scene = parsed({one_thing({on_crate, on_floor})}).scene;
    ASSERT_TRUE(object_at(scene, on_crate).grounded);
    EXPECT_FALSE(scene.corrections[0].held);
    EXPECT_THAT(scene.corrections[0].outcome,
                HasSubstr("counts as the building now, and is not judged: 1 of its parts"));
    const Scene meant = parsed({one_thing({on_floor, on_east})}).scene;
    EXPECT_TRUE(meant.corrections[0].held) << meant.corrections[0].outcome;
}

TEST_F(CorrectedRoom, TellsWhatComesToNothing) {
    const Scene scene =
        parsed({fixed({in_air}), one_thing({on_crate, in_air}), apart(on_crate, {1.7, 1.2, 0.25}),
                mass({on_box}, 1), mass({on_box}, 2), mass({on_box, in_air}, 1)})
            .scene;
    std::vector<std::string> notes;
    for (const std::string& note : scene.notes)
        if (note.starts_with("Correction")) notes.push_back(note);
    ASSERT_EQ(notes.size(), 5u) << testing::PrintToString(notes);
    EXPECT_THAT(notes[0], testing::StartsWith("Correction 1 (fixed) did not hold: found nothing"));
    EXPECT_THAT(notes[0], HasSubstr("the nearest solid is 0."));
    EXPECT_THAT(notes[1], HasSubstr("of at_m 2"));
    EXPECT_THAT(notes[2], HasSubstr("can't be cut"));
    EXPECT_THAT(notes[3], HasSubstr("correction 4 says otherwise"));
    EXPECT_NEAR(object_at(scene, on_box).mass_kg, 1, 1e-9);
    EXPECT_FALSE(object_at(scene, on_crate).grounded);
}

TEST_F(CorrectedRoom, IsNotWhatContradictsItself) {
    expect_input_error(
        [] {
            parsed({one_thing({on_crate, on_east}), fixed({on_floor}), one_thing({on_east, on_box}),
                    apart(on_box, on_crate)});
        },
        {"correction 4 (apart)", "correction 1 (one_thing) and correction 3 (one_thing)"});
    EXPECT_THAT(message_of([&] { parsed({mass({on_box}, -1)}); }, ErrorKind::usage),
                HasSubstr("correction 1 (mass)"));
}

// scene.json says all of it, and is read back; a mass of several objects is told of.
TEST_F(CorrectedRoom, IsWrittenAndReadBack) {
    const Scene scene = parsed({name(on_crate, "chest"), apart(on_crate, on_box), fixed({in_air}),
                                mass({on_box, on_crate}, 9)})
                            .scene;
    EXPECT_TRUE(scene.corrections[3].held);
    EXPECT_THAT(scene.corrections[3].outcome, testing::StartsWith("held, but its spots lie in 2"));
    EXPECT_NEAR(object_at(scene, on_box).mass_kg, 9, 1e-9);
    const std::string text = io::scene_json(scene);
    EXPECT_THAT(text, HasSubstr("\"name\": \"chest\""));
    EXPECT_THAT(text, HasSubstr("\"corrected\": ["));
    const auto file = folder_->path() / "scene.json";
    io::write_scene_json(file, scene);
    EXPECT_EQ(io::scene_json(io::read_scene_json(file)), text);
}

// Of a furnished room: an object of several parts is cut in two where somebody says so.
using CorrectedScan = Files;
TEST_F(CorrectedScan, IsCutWhereTwoThingsWereOne) {
    const PointCloud cloud = cloud_of_room(3);
    scenes::write_cloud(path("room.ply"), cloud);
    ParseOptions options = on(device::open_device("native"));
    options.disturbances = {};
    options.cache_file = path("cache");
    const Scene plain = parse(path("room.ply"), options).scene;
    // The two parts with most points of an object that can move.
    std::vector<std::int32_t> parts;
    for (const Object& o : plain.objects) {
        if (o.grounded || o.primitives.size() < 2) continue;
        parts = o.primitives;
        break;
    }
    ASSERT_GE(parts.size(), 2u);
    const auto points = [&](std::int32_t p) { return plain.primitives[p].points; };
    std::ranges::sort(parts, [&](auto a, auto b) { return points(a) > points(b); });
    const auto middle_of = [&](std::int32_t p) {  // the point nearest to the middle of the part
        Vec3 mean{};
        for (std::size_t n = 0; n < cloud.size(); ++n) {
            if (plain.points.primitive[n] != p) continue;
            mean[0] += cloud.x[n], mean[1] += cloud.y[n], mean[2] += cloud.z[n];
        }
        for (double& x : mean) x /= static_cast<double>(points(p));
        double least = std::numeric_limits<double>::infinity();
        Vec3 out{};
        for (std::size_t n = 0; n < cloud.size(); ++n) {
            if (plain.points.primitive[n] != p) continue;
            const double d =
                std::hypot(cloud.x[n] - mean[0], cloud.y[n] - mean[1], cloud.z[n] - mean[2]);
            if (d < least) least = d, out = {cloud.x[n], cloud.y[n], cloud.z[n]};
        }
        return out;
    };
    const Vec3 one = middle_of(parts[0]), other = middle_of(parts[1]);
    for (const std::uint64_t seed : {1u, 5u}) {
        options.seed = seed;
        options.corrections = {apart(one, other)};
        const Scene scene = parse(path("room.ply"), options).scene;
        ASSERT_TRUE(scene.corrections[0].held) << scene.corrections[0].outcome;
        EXPECT_NE(scene.points.object[nearest_point(scene, cloud, one)],
                  scene.points.object[nearest_point(scene, cloud, other)]);
        EXPECT_EQ(scene.corrections[0].objects.size(), 1u);
        if (seed != plain.seed) continue;
        // Nothing else is another thing than it was, nor has another number.
        for (const Object& o : plain.objects) {
            if (o.grounded || std::ranges::find(o.primitives, parts[0]) != o.primitives.end())
                continue;
            const Object& now = scene.objects.at(static_cast<std::size_t>(o.id));
            EXPECT_EQ(now.primitives, o.primitives) << o.id;
            EXPECT_EQ(now.barrier_J, o.barrier_J) << o.id;
        }
    }
}

// What a parse goes on from is what was found, not a part of it.

namespace fs = std::filesystem;

TEST(PartsCache, HoldsAllThatObjectsAreFoundFrom) {
    const fs::path file = fs::path(::testing::TempDir()) / "topple-groundwork-test.cache";
    ParseOptions options;
    options.device = device::open_device("native");
    options.cache_file = file.string();
    SmallRoom room = SmallRoom::scattered();
    for (const float x : room.cloud.x) room.cloud.red.push_back(x > 1 ? 200 : 90);
    room.cloud.green.assign(room.cloud.size(), 120);
    room.cloud.blue.assign(room.cloud.size(), 60);
    std::vector<std::pair<std::string, double>> timings;
    StageClock stage(timings, options);
    const FoundParts laid =
        find_parts(*options.device, observe_cloud(*options.device, room.cloud, options), options,
                   "room", stage);
    // The key is of files: of this test's own source, say.
    const PartsCache cache(__FILE__, options);
    ASSERT_TRUE(cache.usable());
    cache.write(laid);
    const std::optional<FoundParts> read = cache.read();
    fs::remove(file);
    ASSERT_TRUE(read);
    const SolidParts &was = laid.parts, &is = read->parts;
    EXPECT_EQ(is.model, was.model);
    EXPECT_EQ(is.shell_log_odds, was.shell_log_odds);
    EXPECT_EQ(is.points, was.points);
    EXPECT_EQ(is.frame.axes, was.frame.axes);
    ASSERT_GT(was.samples.size(), 1000u);
    ASSERT_TRUE(was.samples.coloured());
    EXPECT_EQ(is.samples.edge_m, was.samples.edge_m);
    EXPECT_EQ(is.samples.spacing_m, was.samples.spacing_m);
    EXPECT_EQ(is.samples.primitive, was.samples.primitive);
    const auto columns = geometry::columns_of(is.samples),
               first = geometry::columns_of(was.samples);
    for (std::size_t c = 0; c < columns.size(); ++c) EXPECT_EQ(*columns[c], *first[c]) << c;
    EXPECT_EQ(is.solids->cells().primitive, was.solids->cells().primitive);
    EXPECT_EQ(is.solids->boundary().share, was.solids->boundary().share);
    EXPECT_EQ(read->weighed.joints.size(), laid.weighed.joints.size());
    EXPECT_EQ(read->points.primitive, laid.points.primitive);
}

}  // namespace
}  // namespace topple::test

// SPDX-License-Identifier: MIT
#include "topple/corrections.h"

#include "device/devices.h"
#include "host/pipeline/scan.h"
#include "host/pipeline/small_room.h"
#include "pipeline/stages.h"
#include "result/scene_json.h"
#include "scale/parts_cache.h"
#include "small_room.h"
#include "vdb/voxel_scene.h"

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
Correction apart(const Vec3& at, const Vec3& from) {
    Correction c = correction(Kind::apart, {at});
    c.from_m = {from};
    return c;
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

class CorrectedRoom : public testing::Test {
  protected:
    static const PointCloud& cloud() {
        static const SmallRoom room = SmallRoom::scattered();
        return room.cloud;
    }
    static ParseResult parsed(std::vector<Correction> corrections, std::uint64_t seed = 1,
                              double voxel_m = 0) {
        ParseOptions options = on(device::open_device("native"));
        options.disturbances = {};
        options.seed = seed;
        options.voxel_m = voxel_m;
        options.corrections = std::move(corrections);
        return parse(cloud(), options);
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
};

TEST_F(CorrectedRoom, IsAsSomebodyKnowsItWhateverTheSeedAndTheVoxels) {
    Correction mass = correction(Kind::mass, {on_crate}), name = correction(Kind::name, {on_crate}),
               hollow = correction(Kind::hollow, {on_crate});
    mass.mass_kg = 12.5;
    name.name = "chest";
    hollow.wall_m = 0.02;
    const std::vector<Correction> all{correction(Kind::one_thing, {on_crate, on_box}), mass, name,
                                      hollow};
    for (const auto& [seed, voxel_m] : {std::pair{1u, 0.0}, {7u, 0.03}, {8u, 0.016}}) {
        SCOPED_TRACE(voxel_m);
        const Scene plain = parsed({}, seed, voxel_m).scene;
        ASSERT_NE(id_at(plain, on_crate), id_at(plain, on_box));
        EXPECT_TRUE(plain.corrections.empty());
        const Scene scene = parsed(all, seed, voxel_m).scene;
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
}

// A shell is harder to turn than a block of the same mass.
TEST_F(CorrectedRoom, HoldsAHeavyShell) {
    Correction mass = correction(Kind::mass, {on_crate}),
               hollow = correction(Kind::hollow, {on_crate});
    mass.mass_kg = 12.5;
    hollow.wall_m = 0.02;
    const Scene block = parsed({mass}).scene, shell = parsed({mass, hollow}).scene;
    EXPECT_EQ(object_at(block, on_crate).mass_model, "solid");
    EXPECT_NEAR(object_at(block, on_crate).mass_kg, 12.5, 1e-9);
    for (const std::size_t axis : {0u, 4u, 8u})
        EXPECT_GT(object_at(shell, on_crate).inertia_kg_m2[axis],
                  1.1 * object_at(block, on_crate).inertia_kg_m2[axis]);
}

// Shells of 2 cm weigh what their sides do.
TEST_F(CorrectedRoom, HoldsAHollowBox) {
    Correction hollow = correction(Kind::hollow, {on_box});
    hollow.wall_m = 0.02;
    const Scene scene = parsed({hollow}).scene;
    expect_held(scene, 1);
    const double outer = 0.25 * 0.2 * 0.35, inner = 0.21 * 0.16 * 0.31;
    EXPECT_NEAR(object_at(scene, on_box).mass_kg, 700 * (outer - inner),
                0.2 * 700 * (outer - inner));
    EXPECT_NEAR(object_at(scene, on_crate).mass_kg, 700 * 0.7 * 0.6 * 0.5, 12);
}

TEST_F(CorrectedRoom, HasNoRiskOfWhatIsFixed) {
    const Scene plain = parsed({}).scene;
    ASSERT_FALSE(object_at(plain, on_crate).grounded);
    const Scene scene =
        parsed({correction(Kind::fixed, {on_crate}), correction(Kind::fixed, {on_floor})}).scene;
    expect_held(scene, 2);
    EXPECT_TRUE(object_at(scene, on_crate).grounded);
    EXPECT_EQ(id_at(scene, on_crate), id_at(scene, on_floor));
    EXPECT_FALSE(object_at(scene, on_box).grounded);
    EXPECT_THAT(object_at(scene, on_box).why.stands_on, ElementsAre(0));
    EXPECT_EQ(scene.objects.size() + 1, plain.objects.size());
    // Only parts of the room have names there, and it weighs nothing.
    Correction name = correction(Kind::name, {on_crate}), mass = correction(Kind::mass, {on_crate});
    name.name = "shelf";
    mass.mass_kg = 3;
    const Scene named = parsed({correction(Kind::fixed, {on_crate}), name, mass}).scene;
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
    const vdb::VoxelFrame frame = result.voxels->frame();
    const Vec3 middle{1.325, 1.2, 0.7};
    std::array<std::int32_t, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) {
        double along = 0;
        for (std::size_t d = 0; d < 3; ++d) along += frame.grid_from_input[a][d] * middle[d];
        at[a] = static_cast<std::int32_t>(std::floor(along / frame.voxel_m));
    }
    EXPECT_EQ(result.voxels->state_at(at[0], at[1], at[2]), vdb::State::empty);
    EXPECT_EQ(plain.voxels->state_at(at[0], at[1], at[2]), vdb::State::completed);
    // What was on it is taken away with it where both are one.
    const Scene none =
        parsed({correction(Kind::one_thing, {on_box, on_crate}),
                correction(Kind::not_there, {on_box}), correction(Kind::fixed, {on_crate})})
            .scene;
    EXPECT_EQ(id_at(none, on_crate), -1);
    EXPECT_FALSE(none.corrections[2].held);
    EXPECT_THAT(none.corrections[2].outcome, HasSubstr("correction 2"));
}

// A wall that is none: it is a board that stands there.
TEST_F(CorrectedRoom, MayHaveLessOfABuilding) {
    const Scene plain = parsed({}).scene;
    ASSERT_TRUE(object_at(plain, on_east).grounded);
    const Scene scene = parsed({apart(on_east, on_floor)}).scene;
    expect_held(scene, 1);
    EXPECT_NE(id_at(scene, on_east), id_at(scene, on_floor));
    EXPECT_TRUE(object_at(scene, on_floor).grounded);
    EXPECT_FALSE(object_at(scene, on_east).grounded);
    EXPECT_THAT(object_at(scene, on_east).corrected, ElementsAre(1));
    // Nor can it be fixed to what it is apart of: a reason that holds for both parts is told once.
    const Scene both = parsed({apart(on_east, on_floor), apart(on_crate, on_floor),
                               correction(Kind::one_thing, {on_east, on_crate}),
                               correction(Kind::fixed, {on_east, on_crate})})
                           .scene;
    EXPECT_FALSE(object_at(both, on_east).grounded);
    EXPECT_EQ(both.corrections[3].outcome,
              "correction 1 keeps a part of its object apart from the building");
    const Scene things = parsed({apart(on_crate, on_box), correction(Kind::fixed, {on_crate}),
                                 correction(Kind::fixed, {on_box})})
                             .scene;
    EXPECT_TRUE(object_at(things, on_box).grounded);
    EXPECT_TRUE(things.corrections[0].held);
    EXPECT_THAT(things.corrections[0].outcome, HasSubstr("both are fixed"));
}

TEST_F(CorrectedRoom, TellsWhatComesToNothing) {
    Correction light = correction(Kind::mass, {on_box}), heavy = light,
               half = correction(Kind::mass, {on_box, in_air});
    light.mass_kg = 1;
    heavy.mass_kg = 2;
    half.mass_kg = 1;
    const Scene scene =
        parsed({correction(Kind::fixed, {in_air}), correction(Kind::one_thing, {on_crate, in_air}),
                apart(on_crate, {1.7, 1.2, 0.25}), light, heavy, half})
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

TEST_F(CorrectedRoom, TellsOfAMassOfSeveralObjects) {
    Correction mass = correction(Kind::mass, {on_box, on_crate});
    mass.mass_kg = 9;
    const Scene scene = parsed({mass}).scene;
    EXPECT_TRUE(scene.corrections[0].held);
    EXPECT_THAT(scene.corrections[0].outcome, testing::StartsWith("held, but its spots lie in 2"));
    EXPECT_NEAR(object_at(scene, on_box).mass_kg, 9, 1e-9);
}

TEST_F(CorrectedRoom, IsNotWhatContradictsItself) {
    expect_input_error(
        [] {
            parsed({correction(Kind::one_thing, {on_crate, on_east}),
                    correction(Kind::fixed, {on_floor}),
                    correction(Kind::one_thing, {on_east, on_box}), apart(on_box, on_crate)});
        },
        {"correction 4 (apart)", "correction 1 (one_thing) and correction 3 (one_thing)"});
    Correction bad = correction(Kind::mass, {on_box});
    bad.mass_kg = -1;
    EXPECT_THAT(message_of([&] { parsed({bad}); }, ErrorKind::usage),
                HasSubstr("correction 1 (mass)"));
}

// scene.json says all of it, and is read back.
TEST_F(CorrectedRoom, IsWrittenAndReadBack) {
    Correction name = correction(Kind::name, {on_crate});
    name.name = "chest";
    const Scene scene =
        parsed({name, apart(on_crate, on_box), correction(Kind::fixed, {in_air})}).scene;
    const std::string text = io::scene_json(scene);
    EXPECT_THAT(text, HasSubstr("\"name\": \"chest\""));
    EXPECT_THAT(text, HasSubstr("\"corrected\": ["));
    const auto file = std::filesystem::temp_directory_path() / "topple-corrected-scene.json";
    io::write_scene_json(file, scene);
    const Scene back = io::read_scene_json(file);
    std::filesystem::remove(file);
    EXPECT_EQ(io::scene_json(back), text);
}

// Of a furnished room: an object of several parts is cut in two where somebody says so.
TEST(CorrectedScan, IsCutWhereTwoThingsWereOne) {
    const PointCloud cloud = cloud_of_room(3);
    ParseOptions options = on(device::open_device("native"));
    options.disturbances = {};
    const Scene plain = parse(cloud, options).scene;
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
        const Scene scene = parse(cloud, options).scene;
        ASSERT_TRUE(scene.corrections[0].held) << scene.corrections[0].outcome;
        EXPECT_NE(scene.points.object[nearest_point(scene, cloud, one)],
                  scene.points.object[nearest_point(scene, cloud, other)]);
        EXPECT_EQ(scene.corrections[0].objects.size(), 1u);
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

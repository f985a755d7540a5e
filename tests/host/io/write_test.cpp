// SPDX-License-Identifier: MIT
#include <sys/resource.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "files.h"
#include "io/file_writer.h"
#include "io/palette.h"
#include "points/formats/read_cloud.h"
#include "result/landscapes_json.h"
#include "result/read_result_ply.h"
#include "result/scene_json.h"
#include "result/write_ply.h"

namespace topple::io {
namespace {

using test::bytes_of_file;
using test::expect_input_error;

class Write : public test::Files {};

Scene some_scene() {
    Scene scene;
    scene.source = "scans/my \"room\".ply";
    scene.topple_version = "0.1.0";
    scene.backend = "native";
    scene.device = "CPU";
    scene.seed = 18446744073709551615u;
    scene.voxel_size_m = 0.02;
    scene.up = {0.1, 0.2, 0.97};
    scene.up_method = "manhattan";
    scene.manhattan_found = true;
    for (std::size_t i = 0; i < 16; ++i) scene.manhattan_from_input[i] = 0.1 * double(i);
    scene.primitives = {{0, 1, "plane", 10, 20, 0.5, 350, {1, 2, 3}},
                        {1, -1, "merged", 1, 0, 0, 0, {}}};
    Object object;
    object.id = 0;
    object.primitives = {0, 1};
    object.mass_kg = 1.0 / 3.0;
    object.barrier_J = 0.1;
    object.barrier_error_J = 0.02;
    object.release_J = 5;
    object.mode = "tip";
    object.direction = {1, 0, 0};
    object.instability = {{0.1, 5}, {7, 9}};
    object.why = {45, {{1, 2, 3}, {4, 5, 6}}, 0.1, 5, 0.2, 0.75, 3, {0, 2}, "It \"tips\"."};
    object.risk_J = {{"human", 0.5}, {"wind", 0}};
    object.risk_error_J = {{"human", 0.25}, {"wind", 0}};
    object.unsafety = 10;
    object.unsafety_category = "medium";
    object.unsafety_certain = false;
    object.fall.hits_J = 5.25;
    object.fall.people_share = 0.125;
    scene.objects = {object};
    for (const std::int32_t id : {1, 2, 3}) scene.objects.emplace_back().id = id;
    scene.contacts = {{0, 1, 0.25, {0, 0, 1}, "fixed", 0.97}};
    scene.supports = {{0, 1, 0.125, 0.875}};
    scene.timings_s = {{"ingest", 0.5}, {"normals", 0.25}};
    scene.swc_energy = {3, 2, 1.5};
    scene.notes = {"One.", "Zwei: \xc3\xa4."};
    return scene;
}

TEST_F(Write, scene_json_reads_back_the_same) {
    const auto scene = some_scene();
    write_scene_json(path("scene.json"), scene);
    const auto back = read_scene_json(path("scene.json"));
    EXPECT_EQ(scene_json(back), bytes_of_file(path("scene.json")));
    EXPECT_EQ(back.seed, scene.seed);
    EXPECT_EQ(back.objects[0].mass_kg, scene.objects[0].mass_kg);
    EXPECT_EQ(back.objects[0].instability[1].S_J, 9);
    EXPECT_EQ(back.objects[0].why.sentence, scene.objects[0].why.sentence);
    EXPECT_EQ(back.supports[0].probability, 0.875);
}

TEST_F(Write, landscapes_json_reads_back_the_same) {
    auto scene = some_scene();
    const double inf = std::numeric_limits<double>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Landscape& l = scene.objects[0].landscape;
    l.hull_m = {{0.1, 0.2, 0.3}, {-0.1, 0, 0}};
    l.poses = {{{0, 0, 1}, -0.5, inf, -1, 0.75}, {{0, 1, 0}, 0.25, 1.5, 0, 0.25}};
    l.passes = {{{0, 0.6, 0.8}, 1.5, {0, 1}, {{1, 0, 0}, {0, 0.6, 0.8}}}};
    l.now = 1;
    l.places = {3, 0.02, {0.5f, nan, 1, 0, 0, -7.5f, std::numeric_limits<float>::infinity(), 2, 3}};
    write_landscapes_json(path("landscapes.json"), scene);
    auto back = some_scene();
    read_landscapes_json(path("landscapes.json"), back);
    const Landscape& read = back.objects[0].landscape;
    EXPECT_EQ(read.hull_m, l.hull_m);
    ASSERT_EQ(read.poses.size(), 2u);
    EXPECT_EQ(read.poses[0].joins_at_J, inf);
    EXPECT_EQ(read.poses[1].up, l.poses[1].up);
    EXPECT_EQ(read.poses[1].joins_at_J, 1.5);
    EXPECT_EQ(read.poses[1].joins, 0);
    ASSERT_EQ(read.passes.size(), 1u);
    EXPECT_EQ(read.passes[0].poses, l.passes[0].poses);
    EXPECT_EQ(read.passes[0].border, l.passes[0].border);
    EXPECT_EQ(read.now, 1);
    ASSERT_EQ(read.places.energy_J.size(), 9u);
    EXPECT_TRUE(std::isnan(read.places.energy_J[1]));
    EXPECT_TRUE(std::isinf(read.places.energy_J[6]));
    EXPECT_EQ(read.places.energy_J[5], -7.5f);

    const std::string text = bytes_of_file(path("landscapes.json"));
    for (const auto& [from, to] : {std::pair("\"id\":0", "\"id\":7"),
                                   {"\"now\":1", "\"now\":2"},
                                   {"\"side\":3", "\"side\":4"},
                                   {"topple.landscapes/1", "topple.landscapes/2"},
                                   {"\"poses\":[0,1]", "\"poses\":[-1,1]"},
                                   {"]}", "]"}}) {
        std::string changed = text;
        ASSERT_NE(text.find(from), std::string::npos) << from;
        write("broken.json", changed.replace(text.find(from), std::strlen(from), to));
        expect_input_error([&] { read_landscapes_json(path("broken.json"), back); },
                           {"broken.json"});
    }
    expect_input_error([&] { read_landscapes_json(path("none.json"), back); }, {"none.json"});
}

// The members that scorers and users rely on, by name.
TEST_F(Write, scene_json_has_the_fixed_members) {
    const auto json = nlohmann::json::parse(scene_json(some_scene()));
    EXPECT_EQ(json["schema"], "topple.scene/1");
    const auto has = [](const nlohmann::json& part, std::initializer_list<const char*> keys) {
        for (const char* key : keys) EXPECT_TRUE(part.contains(key)) << key;
    };
    has(json,
        {"source", "topple_version", "backend", "device", "seed", "voxel_size_m", "up",
         "manhattan_from_input", "density_kg_m3", "friction", "primitives", "objects", "contacts",
         "supports", "timings_s", "up_method", "manhattan_found", "notes", "swc_energy"});
    has(json["primitives"][0], {"id", "object", "model", "points", "solid_voxels", "volume_m3",
                                "mass_kg", "center_of_mass_m"});
    has(json["objects"][0],
        {"id", "primitives", "grounded", "mass_kg", "center_of_mass_m", "barrier_J",
         "barrier_error_J", "release_J", "mode", "direction", "instability", "why", "risk_J",
         "unsafety", "unsafety_category", "unsafety_certain", "risk_error_J", "fall"});
    has(json["contacts"][0], {"a", "b", "area_m2", "normal", "relation", "probability"});
    EXPECT_EQ(json["manhattan_from_input"][3].size(), 4u);
    EXPECT_EQ(json["objects"][0]["instability"][0]["W_J"], 0.1);
    EXPECT_EQ(json["supports"][0]["supporter"], 0);
    EXPECT_EQ(json["timings_s"]["normals"], 0.25);
}

TEST_F(Write, no_number_that_json_lacks_reaches_scene_json) {
    auto scene = some_scene();
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    scene.objects[0].barrier_J = inf;
    scene.objects[0].fall.people_share = nan;
    scene.objects[0].unsafety_category.clear();
    scene.objects[0].risk_J["wind"] = nan;
    scene.objects[0].instability[0].S_J = -inf;
    scene.objects[0].direction[1] = nan;
    scene.up[0] = nan;
    scene.swc_energy[1] = inf;
    scene.timings_s[0].second = nan;
    scene.notes.push_back("no UTF-8: \xff");
    const auto json = nlohmann::json::parse(scene_json(scene));
    EXPECT_TRUE(json["objects"][0]["barrier_J"].is_null());
    EXPECT_TRUE(json["objects"][0]["fall"]["people_share"].is_null());
    EXPECT_TRUE(json["objects"][0]["unsafety_category"].is_null());
    EXPECT_TRUE(json["objects"][0]["risk_J"]["wind"].is_null());
    EXPECT_TRUE(json["up"][0].is_null());
    EXPECT_TRUE(json["timings_s"]["ingest"].is_null());
    write_scene_json(path("scene.json"), scene);
    EXPECT_TRUE(std::isnan(read_scene_json(path("scene.json")).objects[0].barrier_J));
}

TEST_F(Write, scene_json_that_is_none) {
    auto json = nlohmann::json::parse(scene_json(some_scene()));
    json["corrections"] = {{{"do", "melt"}, {"at_m", {{0, 0, 0}}}}};
    const test::BadFile cases[] = {{"{}", {"schema"}},
                                   {R"({"schema": "other/1"})", {"topple.scene/1"}},
                                   {"nonsense", {}},
                                   {json.dump(), {"\"melt\"", "one_thing, apart"}}};
    expect_refused("a.json", cases, [](const auto& file) { read_scene_json(file); });
}

// The bytes of a PLY behind its header.
std::string body_of(const std::string& ply) {
    return ply.substr(ply.find("end_header\n") + 11);
}

ScenePoints two_points() {
    ScenePoints out;
    out.x = {1, 2};
    out.y = {3, 4};
    out.z = {5, 6};
    out.primitive = {0, -1};
    out.object = {7, -1};
    return out;
}

TEST_F(Write, points_ply) {
    ScenePoints points = two_points();
    points.nx = {0, 1};
    points.ny = {0, 0};
    points.nz = {1, 0};
    write_points_ply(path("points.ply"), points);
    const auto cloud = read_cloud(path("points.ply"));
    EXPECT_EQ(cloud.x, points.x);
    EXPECT_EQ(cloud.nz, points.nz);
    const ScenePoints read = read_points_ply(path("points.ply"));
    EXPECT_EQ(read.x, points.x);
    EXPECT_EQ(read.z, points.z);
    EXPECT_EQ(read.nz, points.nz);
    EXPECT_EQ(read.primitive, points.primitive);
    EXPECT_EQ(read.object, points.object);
    EXPECT_TRUE(read.red.empty());
    // The layout to the byte: 5 words, 3 words, 3 bytes.
    const auto data = body_of(bytes_of_file(path("points.ply")));
    ASSERT_EQ(data.size(), 2 * 35u);
    std::string expected;
    for (const float value : {1.0f, 3.0f, 5.0f}) test::append(expected, value);
    test::append<std::int32_t>(expected, 0);
    test::append<std::int32_t>(expected, 7);
    for (const float value : {0.0f, 0.0f, 1.0f}) test::append(expected, value);
    for (const auto channel : colour_of(7)) test::append(expected, channel);
    EXPECT_EQ(data.substr(0, 35), expected);

    points.nx = points.ny = points.nz = {};
    write_points_ply(path("points.ply"), points);
    EXPECT_TRUE(read_points_ply(path("points.ply")).nx.empty());
    points.object.pop_back();
    EXPECT_THROW(write_points_ply(path("points.ply"), points), std::invalid_argument);
    write_points_ply(path("none.ply"), {});
    EXPECT_THAT(bytes_of_file(path("none.ply")), testing::HasSubstr("element vertex 0\n"));
}

// A scan's own colours stand where programs look for them, and come back; those by object beside.
TEST_F(Write, points_ply_of_a_coloured_scan) {
    ScenePoints points = two_points();
    points.red = {10, 0};
    points.green = {20, 0};
    points.blue = {30, 0};
    write_points_ply(path("points.ply"), points);
    const auto bytes = bytes_of_file(path("points.ply"));
    const auto data = body_of(bytes);
    ASSERT_EQ(data.size(), 2 * 26u);
    std::string expected = "\x0a\x14\x1e";
    for (const auto channel : colour_of(7)) test::append(expected, channel);
    EXPECT_EQ(data.substr(20, 6), expected);
    const auto cloud = read_cloud(path("points.ply"));
    EXPECT_EQ(cloud.red, points.red);
    EXPECT_EQ(cloud.green, points.green);
    EXPECT_EQ(cloud.blue, points.blue);
    EXPECT_EQ(read_points_ply(path("points.ply")).blue, points.blue);

    PointsPlyWriter one_by_one(path("streamed.ply"), 2, true);
    one_by_one.add({1, 3, 5}, 0, 7, {10, 20, 30});
    one_by_one.add({2, 4, 6}, -1, -1, {0, 0, 0});
    one_by_one.close();
    EXPECT_EQ(bytes_of_file(path("streamed.ply")), bytes);

    points.red.pop_back();
    EXPECT_THROW(write_points_ply(path("points.ply"), points), std::invalid_argument);
    points.red = points.green = points.blue = {};
    write_points_ply(path("points.ply"), points);
    EXPECT_TRUE(read_cloud(path("points.ply")).red.empty()) << "colours by object are no scan's";
}

TEST_F(Write, solid_ply) {
    const SolidVoxels voxels{{1, 2}, {3, 4}, {5, 6}, {0, 1}, {2, 3}, {0, 1}};
    write_solid_ply(path("solid.ply"), voxels);
    EXPECT_EQ(read_cloud(path("solid.ply")).z, voxels.z);
    const SolidVoxels read = read_solid_ply(path("solid.ply"));
    EXPECT_EQ(read.y, voxels.y);
    EXPECT_EQ(read.primitive, voxels.primitive);
    EXPECT_EQ(read.object, voxels.object);
    EXPECT_EQ(read.state, voxels.state);
    const auto bytes = bytes_of_file(path("solid.ply"));
    EXPECT_EQ(body_of(bytes).size(), 2 * 24u);
    EXPECT_EQ(bytes[bytes.size() - 4], 1) << "the state stands before the colour";
}

TEST_F(Write, results_that_are_damaged_are_refused) {
    write_points_ply(path("points.ply"), two_points());
    const std::string whole = bytes_of_file(path("points.ply"));
    std::string renamed = whole;
    renamed.replace(renamed.find(" object\n"), 8, " abject\n");
    ScenePoints points = two_points();
    points.y[0] = std::numeric_limits<float>::infinity();
    write_points_ply(path("infinite.ply"), points);
    const test::BadFile cases[] = {
        {whole.substr(0, whole.size() - 1), {}},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty uchar object_red\nend_header\n1\n", {}},
        {renamed, {}},
        {bytes_of_file(path("infinite.ply")), {}}};
    expect_refused("bad.ply", cases, [](const auto& file) { read_points_ply(file); });
    expect_input_error([&] { read_points_ply(path("none.ply")); }, {"none.ply"});
    expect_input_error([&] { read_solid_ply(path("points.ply")); }, {"points.ply"});
}

TEST_F(Write, colours_of_a_scene_differ) {
    std::set<std::array<std::uint8_t, 3>> seen;
    for (int id = -1; id < 100; ++id) seen.insert(colour_of(id));
    EXPECT_EQ(seen.size(), 101u);
    for (int id = 0; id < 100; ++id) {
        const auto a = colour_of(id), b = colour_of(id + 1);
        int distance = 0;
        for (std::size_t i = 0; i < 3; ++i) distance += std::abs(int(a[i]) - int(b[i]));
        EXPECT_GT(distance, 60) << id << " and " << id + 1;
    }
}

TEST_F(Write, what_can_not_be_written_is_told) {
    // Nor is a device removed for a file's sake, whoever runs this.
    expect_input_error([] { write_file("/dev/null", "a little"); },
                       {"/dev/null", "no regular file"});
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{1 << 20, before.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    expect_input_error([&] { write_file(path("long"), std::string(3 << 20, 'x')); },
                       {"long", "File too large"});
    EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
    std::signal(SIGXFSZ, handler);
    expect_input_error([&] { write_file(path("missing/file"), "x"); },
                       {"missing/file", "No such file"});
}

TEST_F(Write, files_longer_than_the_buffer) {
    std::string text;
    for (int i = 0; i < 700000; ++i) text += std::to_string(i);
    FileWriter writer(path("long"));
    writer.write(std::string_view(text).substr(0, 1000001));
    writer.write(std::string_view(text).substr(1000001));
    writer.close();
    EXPECT_EQ(bytes_of_file(path("long")), text);
}

}  // namespace
}  // namespace topple::io

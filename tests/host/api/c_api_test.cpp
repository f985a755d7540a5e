// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/random.h"
#include "host/io/files.h"
#include "host/pipeline/small_room.h"
#include "io/read_cloud.h"
#include "topple/parse.h"
#include "topple/stages.h"
#include "topple/topple.h"

namespace topple::test {
namespace {

topple_cloud c_cloud(const PointCloud& cloud) {
    topple_cloud c;
    topple_cloud_init(&c, sizeof(c));
    c.x = cloud.x.data();
    c.y = cloud.y.data();
    c.z = cloud.z.data();
    c.count = cloud.size();
    return c;
}

class CApi : public Files {
  protected:
    void SetUp() override {
        ASSERT_EQ(topple_device_open("native", 2, &device, &status), TOPPLE_OK) << status.message;
        topple_options_init(&options, sizeof(options));
        options.device = device;
        options.disturbances = TOPPLE_WIND;
    }
    void TearDown() override {
        topple_result_release(result);
        topple_device_release(device);
    }
    const SmallRoom room = SmallRoom::scattered();
    topple_cloud cloud = c_cloud(room.cloud);
    topple_status status{};
    topple_device* device = nullptr;
    topple_options options{};
    topple_result* result = nullptr;
};

TEST_F(CApi, TellsItsVersionAndDevices) {
    EXPECT_EQ(topple_version_number(), 100u);
    EXPECT_STREQ(topple_version(), "0.1.0");
    EXPECT_STREQ(topple_device_backend(device), "native");
    std::uint64_t count = 0;
    topple_device_info first{};
    ASSERT_EQ(topple_list_devices(&first, 1, &count, nullptr), TOPPLE_OK);
    EXPECT_GE(count, 1u);
    EXPECT_STREQ(first.backend, "native");
    EXPECT_TRUE(first.usable);
}

TEST_F(CApi, NamesItsDisturbances) {
    const auto known = topple::known_disturbances();
    for (std::uint32_t n = 0; n < known.size(); ++n)
        EXPECT_EQ(topple_disturbance_name(n), known[n]);
    EXPECT_EQ(topple_disturbance_name(static_cast<std::uint32_t>(known.size())), nullptr);
}

TEST_F(CApi, TakesCorrections) {
    const std::string text = R"({"schema": "topple.corrections/1", "corrections": [
        {"do": "one_thing", "at_m": [[1.0, 1.2, 0.25], [1.2, 1.2, 0.7]]},
        {"do": "name", "at_m": [[1.0, 1.2, 0.25]], "name": "chest"},
        {"do": "fixed", "at_m": [[0.5, 0.5, 0.9]]}]})";
    const auto file = write("corrections.json", text);
    options.corrections_json = text.c_str();
    options.corrections_file = file.c_str();
    EXPECT_EQ(topple_parse_cloud(&cloud, &options, &result, &status), TOPPLE_ERROR_USAGE);
    for (const bool by_file : {true, false}) {
        topple_result_release(result);
        options.corrections_json = by_file ? nullptr : text.c_str();
        options.corrections_file = by_file ? file.c_str() : nullptr;
        ASSERT_EQ(topple_parse_cloud(&cloud, &options, &result, &status), TOPPLE_OK)
            << status.message;
        topple_scene scene{};
        scene.size = sizeof(scene);
        ASSERT_EQ(topple_result_scene(result, &scene, nullptr), TOPPLE_OK);
        ASSERT_EQ(scene.corrections, 3u);
        topple_correction named{};
        named.size = sizeof(named);
        ASSERT_EQ(topple_result_correction(result, 1, &named, nullptr), TOPPLE_OK);
        EXPECT_STREQ(named.what, "name");
        EXPECT_STREQ(named.outcome, "held");
        EXPECT_TRUE(named.held);
        ASSERT_EQ(named.object_count, 1u);
        topple_object object{};
        object.size = sizeof(object);
        ASSERT_EQ(topple_result_object(result, static_cast<std::uint64_t>(named.objects[0]),
                                       &object, nullptr),
                  TOPPLE_OK);
        EXPECT_STREQ(object.name, "chest");
        ASSERT_EQ(object.corrected_count, 2u);
        EXPECT_EQ(object.corrected[1], 2);
        ASSERT_EQ(topple_result_correction(result, 2, &named, nullptr), TOPPLE_OK);
        EXPECT_FALSE(named.held);
        EXPECT_EQ(topple_result_correction(result, 3, &named, &status), TOPPLE_ERROR_USAGE);
    }
    options.corrections_json = "{}";
    topple_result_release(result);
    EXPECT_EQ(topple_parse_cloud(&cloud, &options, &result, &status), TOPPLE_ERROR_INPUT);
    EXPECT_NE(std::string(status.message).find("schema"), std::string::npos) << status.message;
}

TEST_F(CApi, ParsesAsTheLibraryDoes) {
    ASSERT_EQ(topple_parse_cloud(&cloud, &options, &result, &status), TOPPLE_OK) << status.message;
    EXPECT_STREQ(status.message, "");
    ParseOptions cpp;
    cpp.device = device::open_device("native");
    cpp.disturbances = {"wind"};
    const Scene expected = parse(room.cloud, cpp).scene;
    topple_scene scene{};
    scene.size = sizeof(scene);
    ASSERT_EQ(topple_result_scene(result, &scene, nullptr), TOPPLE_OK);
    ASSERT_EQ(scene.objects, expected.objects.size());
    ASSERT_EQ(scene.points, room.cloud.size());
    EXPECT_EQ(scene.notes, expected.notes.size());
    EXPECT_STREQ(scene.backend, "native");
    EXPECT_EQ(std::memcmp(topple_result_point_objects(result), expected.points.object.data(),
                          4 * scene.points),
              0);
    EXPECT_EQ(topple_result_point_normals(result, 2)[3], expected.points.nz[3]);
    EXPECT_EQ(topple_result_point_index(result), nullptr);
    for (std::size_t n = 0; n < scene.objects; ++n) {
        topple_object object{};
        object.size = sizeof(object);
        ASSERT_EQ(topple_result_object(result, n, &object, nullptr), TOPPLE_OK);
        const Object& o = expected.objects[n];
        EXPECT_EQ(object.barrier_J, o.barrier_J);
        double risk = 0, chance = 0;
        EXPECT_EQ(topple_result_risk(result, n, "wind", &risk, &chance, &status), TOPPLE_OK);
        EXPECT_EQ(risk, o.risk_J.at("wind"));
        double error = 0, spread = 0;
        EXPECT_EQ(topple_result_risk_error(result, n, "wind", &error, &spread, &status), TOPPLE_OK);
        EXPECT_EQ(error, o.risk_error_J.at("wind"));
        EXPECT_EQ(spread, o.risk_spread_J.at("wind"));
        EXPECT_EQ(topple_result_risk_error(result, n, "flood", &error, nullptr, &status),
                  TOPPLE_ERROR_USAGE);
        EXPECT_EQ(topple_result_risk(result, n, "human", &risk, nullptr, &status), TOPPLE_OK);
        EXPECT_TRUE(std::isnan(risk)) << "not asked for";
        EXPECT_EQ(object.unsafety_category, o.unsafety_category);
        EXPECT_EQ(object.unsafety_certain != 0, o.unsafety_certain);
        EXPECT_EQ(object.hits_J, o.fall.hits_J);
        EXPECT_EQ(object.lands_m[0], o.fall.lands_m[0]);
        EXPECT_EQ(object.lands_on, o.fall.lands_on);
        EXPECT_EQ(object.falls != 0, o.fall.falls);
        EXPECT_TRUE(std::isnan(object.people_share)) << "nobody was asked for";
        EXPECT_EQ(chance, o.fall_chance.at("wind"));
        EXPECT_EQ(topple_result_risk(result, n, "flood", &risk, nullptr, &status),
                  TOPPLE_ERROR_USAGE);
        EXPECT_NE(std::string(status.message).find("earthquake"), std::string::npos);
        const topple::DirectedBarrier& directed = o.barrier_by_direction;
        ASSERT_EQ(object.blow_heights, directed.height_m.size());
        for (std::size_t b = 0; b < directed.blow_J.size(); ++b)
            EXPECT_EQ(object.blow_barrier_J[b], directed.blow_J[b]);
        for (std::size_t b = 0; b < directed.push_J.size(); ++b)
            EXPECT_EQ(object.push_barrier_J[b], directed.push_J[b]);
        for (std::size_t b = 0; b < directed.push_N.size(); ++b) {
            EXPECT_EQ(object.push_by_direction_N[b], directed.push_N[b]);
            EXPECT_EQ(object.push_error_by_direction_N[b], directed.push_error_N[b]);
            EXPECT_EQ(object.push_direction[3 * b + 1], directed.direction[b][1]);
        }
        EXPECT_EQ(object.push_by_direction_N == nullptr, directed.push_N.empty());
        ASSERT_EQ(object.why_edge_ends, o.why.edge_m.size());
        if (object.why_edge_ends > 0) {
            EXPECT_EQ(object.why_edge_m[4], o.why.edge_m[1][1]);
        }
        EXPECT_EQ(object.why_way_m, o.why.way_m);
        EXPECT_EQ(object.why_drop_m, o.why.drop_m);
        EXPECT_EQ(object.why_lands_on, o.why.lands_on);
        ASSERT_EQ(object.stands_on_count, o.why.stands_on.size());
        for (std::size_t s = 0; s < o.why.stands_on.size(); ++s)
            EXPECT_EQ(object.stands_on[s], o.why.stands_on[s]);
        EXPECT_EQ(object.advice_kind, o.advice.kind);
        EXPECT_EQ(object.advice_move_m[0], o.advice.move_m[0]);
        EXPECT_EQ(object.hold_N, o.advice.hold_N);
        EXPECT_EQ(object.why, o.why.sentence);
        ASSERT_EQ(object.instability_count, o.instability.size());
        if (!o.instability.empty()) {
            EXPECT_EQ(object.instability[0].S_J, o.instability[0].S_J);
        }
        ASSERT_EQ(object.primitive_count, o.primitives.size());
        EXPECT_EQ(object.primitives[0], o.primitives[0]);
    }
    topple_primitive primitive{};
    primitive.size = sizeof(primitive);
    EXPECT_EQ(topple_result_primitive(result, 0, &primitive, nullptr), TOPPLE_OK);
    EXPECT_EQ(primitive.mass_kg, expected.primitives[0].mass_kg);
    topple_contact contact{};
    contact.size = sizeof(contact);
    EXPECT_EQ(topple_result_contact(result, 0, &contact, nullptr), TOPPLE_OK);
    EXPECT_EQ(contact.relation, expected.contacts[0].relation);
    topple_support support{};
    support.size = sizeof(support);
    EXPECT_EQ(topple_result_support(result, 0, &support, nullptr), TOPPLE_OK);
    EXPECT_EQ(support.area_m2, expected.supports[0].area_m2);
    EXPECT_EQ(topple_result_write(result, path("map").c_str(), TOPPLE_WRITE_OCTOMAP, &status),
              TOPPLE_OK);
    EXPECT_TRUE(std::filesystem::exists(path("map/map.bt")));
    EXPECT_EQ(topple_result_write(result, path("map").c_str(), 8, &status), TOPPLE_ERROR_USAGE);
    EXPECT_EQ(topple_result_write(result, path("out").c_str(), 0, &status), TOPPLE_OK);
    EXPECT_TRUE(std::filesystem::exists(path("out/scene.json")));
    const std::string exported = path("mjcf").string();
    EXPECT_EQ(topple_result_export(result, "mjcf", exported.c_str(), &status), TOPPLE_OK)
        << status.message;
    EXPECT_TRUE(std::filesystem::exists(path("mjcf/scene.xml")));
    EXPECT_TRUE(std::filesystem::exists(path("mjcf/bodies.json")));
    EXPECT_EQ(topple_result_export(result, "blend", exported.c_str(), &status), TOPPLE_ERROR_USAGE);
    EXPECT_NE(std::string(status.message).find("\"blend\" is no format"), std::string::npos);
    EXPECT_EQ(topple_result_export(result, "mjcf", "", &status), TOPPLE_ERROR_USAGE);
    EXPECT_EQ(topple_result_export(result, nullptr, exported.c_str(), &status), TOPPLE_ERROR_USAGE);
    EXPECT_EQ(topple_result_export(nullptr, "mjcf", exported.c_str(), &status), TOPPLE_ERROR_USAGE);
    write("others/scene.xml", "<mujoco/>");
    EXPECT_EQ(topple_result_export(result, "mjcf", path("others").c_str(), &status),
              TOPPLE_ERROR_INPUT);
    // The caller's colours, interleaved.
    std::vector<std::uint8_t> rgb(3 * room.cloud.size(), 50);
    cloud.red = &rgb[0];
    cloud.green = &rgb[1];
    cloud.blue = &rgb[2];
    cloud.colour_stride_bytes = 3;
    rgb[3] = 200;
    topple_result* coloured = nullptr;
    ASSERT_EQ(topple_parse_cloud(&cloud, &options, &coloured, &status), TOPPLE_OK)
        << status.message;
    EXPECT_EQ(topple_result_write(coloured, path("coloured").c_str(), 0, &status), TOPPLE_OK);
    const PointCloud back = io::read_cloud(path("coloured/points.ply"));
    ASSERT_EQ(back.red.size(), room.cloud.size());
    EXPECT_EQ(back.red[0], 50);
    EXPECT_EQ(back.red[1], 200);
    EXPECT_EQ(back.blue[1], 50);
    topple_result_release(coloured);
    // A file that the library wrote, parsed by its path.
    topple_result* again = nullptr;
    EXPECT_EQ(topple_parse(path("out/points.ply").c_str(), &options, &again, &status), TOPPLE_OK)
        << status.message;
    topple_result_release(again);
}

TEST_F(CApi, ErrorsSayWhatIsWrong) {
    const auto message = [&](int code, int expected) {
        EXPECT_EQ(code, expected);
        EXPECT_EQ(status.code, expected);
        return std::string(status.message);
    };
    EXPECT_EQ(message(topple_parse_cloud(nullptr, &options, &result, &status), TOPPLE_ERROR_USAGE),
              "cloud is NULL");
    EXPECT_EQ(message(topple_parse("x", &options, nullptr, &status), TOPPLE_ERROR_USAGE),
              "result is NULL");
    EXPECT_EQ(message(topple_parse(path("none.ply").c_str(), &options, &result, &status),
                      TOPPLE_ERROR_INPUT)
                  .find(path("none.ply").string()),
              0u);
    options.friction = -1;
    EXPECT_EQ(message(topple_parse_cloud(&cloud, &options, &result, &status), TOPPLE_ERROR_USAGE),
              "--friction -1: expected a number above 0 and at most 10");
    options.friction = 0.3;
    options.disturbances = 9;
    message(topple_parse_cloud(&cloud, &options, &result, &status), TOPPLE_ERROR_USAGE);
    options.size = 0;
    EXPECT_EQ(message(topple_parse_cloud(&cloud, &options, &result, &status), TOPPLE_ERROR_USAGE),
              "options: size is 0; set it to sizeof of the struct");
    topple_device* other = nullptr;
    EXPECT_EQ(topple_device_open("abacus", 0, &other, &status), TOPPLE_ERROR_USAGE);
    EXPECT_EQ(topple_device_adopt_opencl(nullptr, nullptr, nullptr, &other, &status),
              TOPPLE_ERROR_DEVICE);
    EXPECT_EQ(other, nullptr);
    topple_cloud few = cloud;
    few.count = 4;
    options.size = sizeof(options);
    options.disturbances = 0;
    EXPECT_EQ(message(topple_parse_cloud(&few, &options, &result, &status), TOPPLE_ERROR_INPUT)
                  .substr(0, 15),
              "cloud: 4 points");
    EXPECT_EQ(result, nullptr);
    EXPECT_EQ(topple_parse_cloud(&few, &options, &result, nullptr), TOPPLE_ERROR_INPUT);
}

// A caller that was built when the structs were shorter.
TEST_F(CApi, StructsMayBeShorter) {
    struct {
        std::size_t size;
        topple_device* device;
        double voxel_m;
    } old{sizeof(old), device, 0.03};
    topple_cloud from = cloud;
    from.size = offsetof(topple_cloud, nx);
    from.nx = from.ny = from.nz = cloud.x + 1;  // not looked at
    ASSERT_EQ(
        topple_parse_cloud(&from, reinterpret_cast<const topple_options*>(&old), &result, &status),
        TOPPLE_OK)
        << status.message;
    topple_scene scene{};
    scene.size = offsetof(topple_scene, density_kg_m3);
    scene.density_kg_m3 = -7;
    ASSERT_EQ(topple_result_scene(result, &scene, nullptr), TOPPLE_OK);
    EXPECT_EQ(scene.voxel_size_m, 0.03);
    EXPECT_EQ(scene.density_kg_m3, -7);
    EXPECT_EQ(scene.size, offsetof(topple_scene, density_kg_m3));
}

struct Heard {
    std::set<std::string> stages, logged;
    int warnings = 0, polls = 0, most_polls = 1 << 30;
    std::size_t bytes = 0, blocks = 0, most_blocks = 1 << 30;
};

TEST_F(CApi, CallbacksAndTheAllocatorAreTheCallers) {
    Heard heard;
    options.user = &heard;
    options.progress = [](const char* stage, double done, void* user) {
        EXPECT_TRUE(done >= 0 && done <= 1);
        static_cast<Heard*>(user)->stages.insert(stage);
    };
    options.log = [](int level, const char* text, void* user) {
        auto& h = *static_cast<Heard*>(user);
        if (level == TOPPLE_LOG_WARNING) ++h.warnings;
        if (level == TOPPLE_LOG_INFO) h.logged.insert(text);
    };
    options.cancelled = [](void* user) {
        auto& h = *static_cast<Heard*>(user);
        return static_cast<int>(++h.polls > h.most_polls);
    };
    topple_allocator allocator{};
    allocator.user = &heard;
    allocator.allocate = [](std::size_t bytes, std::size_t, void* user) {
        auto& h = *static_cast<Heard*>(user);
        if (h.blocks == h.most_blocks) return static_cast<void*>(nullptr);
        h.bytes += bytes;
        ++h.blocks;
        return std::malloc(bytes);
    };
    allocator.release = [](void* memory, std::size_t bytes, void* user) {
        auto& h = *static_cast<Heard*>(user);
        h.bytes -= bytes;
        --h.blocks;
        std::free(memory);
    };
    options.allocator = &allocator;
    ASSERT_EQ(topple_parse_cloud(&cloud, &options, &result, &status), TOPPLE_OK) << status.message;
    EXPECT_TRUE(heard.stages.contains("grouping"));
    EXPECT_EQ(heard.stages, heard.logged);
    EXPECT_GT(heard.warnings, 0);
    EXPECT_GE(heard.bytes, room.cloud.size() * 20);
    topple_result_release(result);
    result = nullptr;
    EXPECT_EQ(heard.bytes, 0u);
    EXPECT_EQ(heard.blocks, 0u);
    heard.most_blocks = 3;
    EXPECT_EQ(topple_parse_cloud(&cloud, &options, &result, &status), TOPPLE_ERROR_MEMORY);
    EXPECT_EQ(heard.blocks, 0u);
    heard.most_polls = heard.polls + 3;
    EXPECT_EQ(topple_parse_cloud(&cloud, &options, &result, &status), TOPPLE_ERROR_CANCELLED);
    EXPECT_STREQ(status.message, "cancelled");
    EXPECT_EQ(result, nullptr);
}

TEST_F(CApi, CoordinatesMayStayOutside) {
    options.without_coordinates = 1;
    options.disturbances = 0;
    ASSERT_EQ(topple_parse_cloud(&cloud, &options, &result, &status), TOPPLE_OK) << status.message;
    EXPECT_EQ(topple_result_write(result, path("out").c_str(), 0, &status), TOPPLE_ERROR_USAGE);
    EXPECT_EQ(topple_result_add_coordinates(result, &cloud, &status), TOPPLE_OK);
    EXPECT_EQ(topple_result_write(result, path("out").c_str(), 0, &status), TOPPLE_OK)
        << status.message;
}

TEST_F(CApi, ThreadsWithHandlesOfTheirOwn) {
    std::vector<std::vector<std::int32_t>> labels(2);
    std::vector<std::thread> threads;
    for (auto& label : labels) {
        threads.emplace_back([&] {
            topple_options own;
            topple_options_init(&own, sizeof(own));
            own.disturbances = 0;
            topple_result* r = nullptr;
            topple_status s;
            topple_device_open("native", 1, &own.device, nullptr);
            EXPECT_EQ(topple_parse_cloud(&cloud, &own, &r, &s), TOPPLE_OK) << s.message;
            const std::int32_t* objects = topple_result_point_objects(r);
            label.assign(objects, objects + room.cloud.size());
            topple_result_release(r);
            topple_device_release(own.device);
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(labels[0], labels[1]);
}

TEST_F(CApi, StagesAreThoseOfTheLibrary) {
    const std::size_t n = room.cloud.size();
    double spacing = 0;
    ASSERT_EQ(topple_point_spacing(&cloud, &spacing, &status), TOPPLE_OK);
    std::vector<float> nx(n), ny(n), nz(n), ex(n), ey(n), ez(n);
    ASSERT_EQ(
        topple_normals(device, &cloud, 0.04, nullptr, nx.data(), ny.data(), nz.data(), &status),
        TOPPLE_OK);
    const auto own = device::open_device("native");
    stages::normals(*own, room.cloud, 0.04, nullptr, ex, ey, ez);
    const auto refused = [&](topple_device* with, double cell_m) {
        EXPECT_EQ(
            topple_normals(with, &cloud, cell_m, nullptr, nx.data(), ny.data(), nz.data(), &status),
            TOPPLE_ERROR_USAGE);
        return std::string(status.message);
    };
    const auto given = nx;
    EXPECT_TRUE(refused(device, 0).starts_with("normals: cell_m 0: expected metres"));
    EXPECT_TRUE(refused(nullptr, 0.04).starts_with("device is NULL; "));
    EXPECT_EQ(nx, given);
    EXPECT_EQ(nz, ez);
    EXPECT_EQ(spacing, stages::point_spacing(room.cloud));

    const double corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, center[] = {.25, .25, .25};
    const std::uint64_t first[] = {0, 4};
    const double mass = 2;
    double barrier = 0, release = -1;
    ASSERT_EQ(topple_barriers(device, corners, first, 1, &mass, center, 0.001, &barrier, &release,
                              &status),
              TOPPLE_OK);
    EXPECT_NEAR(barrier, 2 * 9.80665 * (std::hypot(0.25, 0.25) - 0.25), 1e-6);

    float vertices[] = {1, 2, 3}, directions[] = {1, 0, 0}, s[] = {9, 9};
    const topple_array v{vertices, 3, 0, 0}, d{directions, 1, 0, 0}, zero{directions + 1, 1, 0, 0};
    const topple_array vs[] = {v, v, v}, ds[] = {d, zero, zero}, out{s, 2, 0, 0};
    const std::uint64_t sets[] = {0, 1, 3};
    ASSERT_EQ(topple_support_functions(device, vs, sets, 2, ds, &out, &status), TOPPLE_OK)
        << status.message;
    EXPECT_EQ(s[0], 1.0f);
    EXPECT_EQ(s[1], 2.0f);

    float primary[] = {1, 2, 3, 4}, density[4];
    const topple_array p{primary, 4, 0, 0}, q{density, 4, 0, 0};
    const topple_footprint_entry ahead{1, 0, 10};
    const std::uint32_t entries[] = {0, 1};
    ASSERT_EQ(topple_convolve(device, 4, 1, 1, 0, &p, &ahead, entries, &q, &status), TOPPLE_OK)
        << status.message;
    EXPECT_EQ(std::vector<float>(density, density + 4), (std::vector<float>{20, 30, 40, 0}));
    EXPECT_EQ(topple_convolve(device, 5, 1, 1, 0, &p, &ahead, entries, &q, &status),
              TOPPLE_ERROR_USAGE);

    topple_volume* volume = nullptr;
    const std::vector<std::int32_t> label(n, 0);
    ASSERT_EQ(topple_volume_create(&cloud, label.data(), 0.03, &volume, &status), TOPPLE_OK);
    EXPECT_EQ(topple_volume_state(volume, 10, 10, 0), 1);
    const topple_intrinsics camera{2, 2, 1, 1, 0.5, 0.5, 1000};
    const std::uint16_t depth[] = {1000, 1000, 1000, 1000};
    const double pose[] = {1, 0, 0, 1.4, 0, -1, 0, 0.4, 0, 0, -1, 1, 0, 0, 0, 1};
    EXPECT_EQ(topple_volume_carve(volume, device, &camera, depth, pose, 1, &status), TOPPLE_OK)
        << status.message;
    EXPECT_EQ(topple_volume_state(volume, 46, 13, 10), 0);
    std::uint64_t filled = 0;
    EXPECT_EQ(topple_volume_fill(volume, device, 2, nullptr, 0, &filled, &status), TOPPLE_OK);
    EXPECT_GT(filled, 0u);
    topple_volume_release(volume);
}

// What the C interface adds to a stage: the same call with and without it, in turns.
TEST_F(CApi, CostsNothingOnAMillionPoints) {
    topple::Random random(3);
    PointCloud plane;
    for (int n = 0; n < 1'000'000; ++n) {
        plane.x.push_back(static_cast<float>(8 * random.uniform()));
        plane.y.push_back(static_cast<float>(8 * random.uniform()));
        plane.z.push_back(static_cast<float>(0.01 * random.uniform()));
    }
    const topple_cloud million = c_cloud(plane);
    const auto own = device::open_device("native", 2);
    std::vector<float> nx(plane.size()), ny = nx, nz = nx;
    const auto seconds = [](const auto& call) {
        const auto start = std::chrono::steady_clock::now();
        call();
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    double c = std::numeric_limits<double>::infinity(), cpp = c;
    for (int round = 0; round < 15; ++round) {
        c = std::min(c, seconds([&] {
                         topple_normals(device, &million, 0.03, nullptr, nx.data(), ny.data(),
                                        nz.data(), &status);
                     }));
        EXPECT_EQ(status.code, TOPPLE_OK) << status.message;
        cpp = std::min(cpp,
                       seconds([&] { stages::normals(*own, plane, 0.03, nullptr, nx, ny, nz); }));
    }
    std::printf("normals of 1e6 points: %.1f ms in C, %.1f ms in C++: %+.2f %%\n", 1e3 * c,
                1e3 * cpp, 100 * (c / cpp - 1));
    EXPECT_LT(c, 1.25 * cpp);  // a copy of the points would show even on a busy machine
}

}  // namespace
}  // namespace topple::test

// SPDX-License-Identifier: MIT
#include "host/api/c_api.h"

#include <thread>

#include "topple/parse.h"
#include "topple/stages.h"

namespace topple::test {
namespace {

TEST_F(CApi, TellsItsVersionAndDevices) {
    EXPECT_EQ(topple_version_number(), 200u);
    EXPECT_STREQ(topple_version(), "0.2.0");
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
    EXPECT_EQ(message(parsed(), TOPPLE_ERROR_USAGE),
              "friction (--friction) -1: expected a number above 0 and at most 10");
    options.friction = 0.3;
    options.tile_m = 5;
    EXPECT_EQ(message(parsed(), TOPPLE_ERROR_USAGE).find("tile_m (--tile) 5: only clouds in files"),
              0u);
    options.tile_m = 0;
    options.max_memory_bytes = 1;
    EXPECT_THAT(
        message(parsed(), TOPPLE_ERROR_INPUT),
        testing::HasSubstr(
            " of max_memory_bytes (--max-memory): allow that much, or use a larger voxel_m"));
    options.max_memory_bytes = 0;
    options.disturbances = 9;
    message(parsed(), TOPPLE_ERROR_USAGE);
    options.size = 0;
    EXPECT_EQ(message(parsed(), TOPPLE_ERROR_USAGE),
              "options: size is 0; set it to sizeof of the struct");
    topple_device* other = nullptr;
    EXPECT_EQ(topple_device_open("abacus", 0, &other, &status), TOPPLE_ERROR_USAGE);
    EXPECT_EQ(std::string(status.message).find("backend (--backend) abacus is unknown"), 0u);
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
    ASSERT_EQ(parsed(), TOPPLE_OK) << status.message;
    EXPECT_TRUE(heard.stages.contains("grouping"));
    EXPECT_EQ(heard.stages, heard.logged);
    EXPECT_GT(heard.warnings, 0);
    EXPECT_GE(heard.bytes, room.cloud.size() * 20);
    topple_result_release(result);
    result = nullptr;
    EXPECT_EQ(heard.bytes, 0u);
    EXPECT_EQ(heard.blocks, 0u);
    heard.most_blocks = 3;
    EXPECT_EQ(parsed(), TOPPLE_ERROR_MEMORY);
    EXPECT_EQ(heard.blocks, 0u);
    heard.most_polls = heard.polls + 3;
    EXPECT_EQ(parsed(), TOPPLE_ERROR_CANCELLED);
    EXPECT_STREQ(status.message, "cancelled");
    EXPECT_EQ(result, nullptr);
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

}  // namespace
}  // namespace topple::test

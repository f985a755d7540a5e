// SPDX-License-Identifier: MIT
#include "host/api/c_api.h"

#include <cstddef>
#include <cstdlib>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "topple/parse.h"

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
    EXPECT_EQ(message(topple_parse_cloud(&cloud, &options, &result, &status), TOPPLE_ERROR_USAGE),
              "friction -1: expected a number above 0 and at most 10");
    options.friction = 0.3;
    options.tile_m = 5;
    EXPECT_EQ(message(topple_parse_cloud(&cloud, &options, &result, &status), TOPPLE_ERROR_USAGE)
                  .find("tile_m 5: only clouds in files"),
              0u);
    options.tile_m = 0;
    options.max_memory_bytes = 1;
    EXPECT_THAT(
        message(topple_parse_cloud(&cloud, &options, &result, &status), TOPPLE_ERROR_INPUT),
        testing::HasSubstr(" of max_memory_bytes: allow that much, or use a larger voxel_m"));
    options.max_memory_bytes = 0;
    options.disturbances = 9;
    message(topple_parse_cloud(&cloud, &options, &result, &status), TOPPLE_ERROR_USAGE);
    options.size = 0;
    EXPECT_EQ(message(topple_parse_cloud(&cloud, &options, &result, &status), TOPPLE_ERROR_USAGE),
              "options: size is 0; set it to sizeof of the struct");
    topple_device* other = nullptr;
    EXPECT_EQ(topple_device_open("abacus", 0, &other, &status), TOPPLE_ERROR_USAGE);
    EXPECT_EQ(std::string(status.message).find("backend abacus is unknown"), 0u);
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

}  // namespace
}  // namespace topple::test

// SPDX-License-Identifier: MIT

#include <thread>

#include "device/queue.h"
#include "device_compare.h"
#include "device_harness.h"
#include "support_function.hpp"

namespace topple::test {
namespace {

TEST(DeviceOpen, RefusesUnknownBackends) {
    for (const char* name : {"cuda", "", "Native", "opencl "}) {
        EXPECT_THAT(message_of([&] { device::open_device(name); }, ErrorKind::usage),
                    ::testing::HasSubstr("auto, native, opencl or vulkan"));
    }
}

TEST(DeviceOpen, ListsEveryBackendInOrder) {
    const std::vector<device::Listing> all = device::list_devices();
    ASSERT_FALSE(all.empty());
    bool seen[3] = {};
    for (std::size_t i = 0; i < all.size(); ++i) {
        seen[static_cast<int>(all[i].backend)] = true;
        if (i > 0) {
            EXPECT_LE(all[i - 1].backend, all[i].backend);
        }
        EXPECT_EQ(all[i].usable, all[i].problem.empty());
        if (!all[i].usable) continue;
        const device::DeviceInfo& info = all[i].info;
        EXPECT_EQ(info.backend, all[i].backend);
        EXPECT_FALSE(info.name.empty());
        EXPECT_FALSE(info.driver.empty());
        EXPECT_GE(info.limits.max_binding_bytes, 128u << 20) << info.name;
        EXPECT_GE(info.limits.max_allocation_bytes, info.limits.max_binding_bytes) << info.name;
        EXPECT_GE(info.limits.max_group_size, 64u) << info.name;
    }
    EXPECT_TRUE(seen[0] && seen[1] && seen[2]);
    EXPECT_TRUE(all[0].usable);
}

// Drivers are less sure of that than their specifications.
TEST(DeviceOpen, OpenClFromEightThreadsAtOnce) {
    std::vector<std::jthread> threads;
    std::vector<std::string> found(8);
    for (std::string& mine : found) {
        threads.emplace_back([&mine] {
            for (int repeat = 0; repeat < 4; ++repeat) {
                mine.clear();
                bool usable = false;
                for (const auto& listing : device::list_devices()) {
                    mine += listing.info.name + listing.problem + "\n";
                    usable |= listing.usable && listing.info.backend == device::Backend::opencl;
                }
                if (usable) device::open_device("opencl");
            }
        });
    }
    threads.clear();
    for (const std::string& one : found) EXPECT_EQ(one, found.front());
    EXPECT_FALSE(found.front().empty());
}

// A CPU behind a GPU's interface never beats the native backend.
TEST(DeviceOpen, AutoTakesAGpuOrElseTheNativeBackend) {
    bool gpu = false;
    for (const auto& listing : device::list_devices()) gpu |= listing.usable && listing.info.gpu;
    const auto device = device::open_device("auto");
    EXPECT_EQ(device->info().gpu, gpu);
    EXPECT_EQ(device->info().backend == device::Backend::native, !gpu);
}

class DeviceOpenEach : public EachBackend {};
TOPPLE_ON_EACH_BACKEND(DeviceOpenEach);

TEST_P(DeviceOpenEach, IsAmongTheListed) {
    bool found = false;
    for (const auto& listing : device::list_devices()) {
        found |= listing.usable && listing.info.backend == device->info().backend &&
                 listing.info.name == device->info().name;
    }
    EXPECT_TRUE(found) << device->info().name;
}

// Two devices of one backend live side by side.
TEST_P(DeviceOpenEach, OpensTwice) {
    const auto other = open(GetParam());
    device::Buffer<float> a(*device, std::vector<float>{1, 2}, "a"),
        b(*other, std::vector<float>{3, 4}, "b");
    EXPECT_EQ(a.download(), (std::vector<float>{1, 2}));
    EXPECT_EQ(b.download(), (std::vector<float>{3, 4}));
}

std::vector<float> supports(device::Device& device) {
    Random random(5);
    const std::uint32_t vertices = 101, directions = 32 * 997;
    std::vector<device::Buffer<float>> arrays;
    for (const std::uint32_t count :
         {vertices, vertices, vertices, directions, directions, directions}) {
        arrays.emplace_back(device, random.floats(count, -1, 1), "coordinates");
    }
    const device::Buffer<float> s(device, directions, "s");
    device::Queue queue(device);
    queue.add<kernels::SupportFunction>(
        directions, {arrays[0], arrays[1], arrays[2], arrays[3], arrays[4], arrays[5], s},
        {.vertex_count = vertices,
         .vertex_first = 0,
         .direction_count = directions,
         .output_first = 0});
    queue.run();
    return s.download();
}

TEST(DeviceOpen, NativeGivesTheSameOnAnyNumberOfThreads) {
    const auto one = device::open_device("native", 1);
    EXPECT_EQ(one->info().driver, "1 threads");
    const std::vector<float> want = supports(*one);
    for (const unsigned threads : {2u, 3u, 8u}) {
        EXPECT_TRUE(same(supports(*device::open_device("native", threads)), want))
            << threads << " threads";
    }
}

}  // namespace
}  // namespace topple::test

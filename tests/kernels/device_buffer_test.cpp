// SPDX-License-Identifier: MIT
#include <numeric>

#include "device/buffer.h"
#include "device_compare.h"
#include "device_harness.h"

namespace topple::test {
namespace {

using ::testing::HasSubstr;

constexpr std::uint64_t step = device::slice_alignment / 4;

std::vector<std::uint32_t> counting(std::size_t count) {
    std::vector<std::uint32_t> out(count);
    std::iota(out.begin(), out.end(), 0u);
    return out;
}

class DeviceBuffer : public EachBackend {};
TOPPLE_ON_EACH_FORM(DeviceBuffer);

TEST_P(DeviceBuffer, GivesBackWhatItTook) {
    for (const std::size_t count : {0, 1, 63, 64, 65, 997, 3'000'001}) {
        SCOPED_TRACE(count);
        const std::vector<std::uint32_t> data = counting(count);
        const device::Buffer<std::uint32_t> buffer(*device, data, "data");
        EXPECT_EQ(buffer.size(), count);
        EXPECT_TRUE(same(buffer.download(), data));
    }
}

TEST_P(DeviceBuffer, UploadsAndDownloadsParts) {
    device::Buffer<std::int32_t> buffer(*device, 1000, "parts");
    buffer.fill(-7);
    buffer.upload(std::vector<std::int32_t>{1, 2, 3}, 501);
    std::vector<std::int32_t> part(5);
    buffer.download(part, 500);
    EXPECT_EQ(part, (std::vector<std::int32_t>{-7, 1, 2, 3, -7}));
    buffer.upload(std::vector<std::int32_t>{}, 1000);
    EXPECT_EQ(buffer.download()[999], -7);
}

TEST_P(DeviceBuffer, FillsEveryElement) {
    for (const std::size_t count : {1, 3, 64, 997}) {
        device::Buffer<float> buffer(*device, count, "filled");
        buffer.fill(-0.1f);
        EXPECT_TRUE(same(buffer.download(), std::vector<float>(count, -0.1f)));
    }
}

TEST_P(DeviceBuffer, RefusesRangesOutside) {
    device::Buffer<float> buffer(*device, 10, "ten");
    const std::string expected = "buffer ten: range [8, 11) is outside of its 10 elements";
    EXPECT_EQ(message_of([&] { buffer.upload(std::vector<float>(3), 8); }), expected);
    std::vector<float> to(3);
    EXPECT_EQ(message_of([&] { buffer.download(to, 8); }), expected);
    EXPECT_THAT(message_of([&] { buffer.slice(~0ull, 2); }),
                HasSubstr("outside of its 10 elements"));
}

TEST_P(DeviceBuffer, RefusesMisalignedSlices) {
    const device::Buffer<float> buffer(*device, 3 * step, "aligned");
    EXPECT_NO_THROW(buffer.slice(2 * step, step));
    EXPECT_NO_THROW(buffer.slice(3 * step, 0));
    EXPECT_THAT(message_of([&] { buffer.slice(1, 4); }),
                HasSubstr("must start at a multiple of " + std::to_string(step)));
}

TEST_P(DeviceBuffer, RefusesMoreThanTheDeviceAllocates) {
    const std::uint64_t count = device->info().limits.max_allocation_bytes / 4 + 1;
    EXPECT_THAT(message_of([&] { device::Buffer<float>(*device, count, "huge"); }),
                HasSubstr("buffer huge: " + std::to_string(4 * count) + " bytes"));
    EXPECT_THAT(message_of([&] { device::Buffer<float>(*device, ~0ull / 2, "absurd"); }),
                HasSubstr("overflow a 64-bit size"));
}

// Both ways of reaching the elements see the same memory.
TEST_P(DeviceBuffer, HostViewIsTheBuffer) {
    device::Buffer<std::uint32_t> buffer(*device, counting(100), "viewed");
    const std::span<std::uint32_t> view = buffer.host_view();
    if (view.empty()) {
        ASSERT_TRUE(device->info().gpu) << "a CPU shares its memory with the host";
        return;
    }
    ASSERT_EQ(view.size(), 100u);
    EXPECT_EQ(view[42], 42u);
    view[42] = 7;
    EXPECT_EQ(buffer.download()[42], 7u);
    buffer.upload(std::vector<std::uint32_t>{8}, 43);
    EXPECT_EQ(buffer.host_view()[43], 8u);
    buffer.fill(9);
    EXPECT_EQ(buffer.host_view()[44], 9u);
}

TEST_P(DeviceBuffer, CountsBytes) {
    device::Buffer<float> buffer(*device, std::vector<float>(100), "counted");
    EXPECT_EQ(buffer.download().size(), 100u);
    EXPECT_EQ(device->counters().bytes_written, 400u);
    EXPECT_EQ(device->counters().bytes_read, 400u);
}

}  // namespace
}  // namespace topple::test

// SPDX-License-Identifier: MIT
#include "points/apart/scan_message.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>

#include "core/random.h"

namespace topple::reader {
namespace {

// An answer of given bytes, as a child leaves it.
child::Answer answer_of(const std::string& bytes) {
    const int memory = ::memfd_create("answer", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    EXPECT_EQ(::write(memory, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    return child::Answer(memory);
}

std::string bytes_of(const ScannedMap& map) {
    const int memory = ::memfd_create("answer", MFD_CLOEXEC);
    write_scan(map, memory);
    std::string bytes(static_cast<std::size_t>(::lseek(memory, 0, SEEK_END)), '\0');
    EXPECT_EQ(::pread(memory, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
    ::close(memory);
    return bytes;
}

ScannedMap map_of_two() {
    ScannedMap map;
    PointCloud& cloud = map.cloud;
    cloud.x = {1, 2};
    cloud.y = {3, 4};
    cloud.z = {5, 6};
    cloud.nx = {1, 0};
    cloud.ny = {0, 1};
    cloud.nz = {0, 0};
    cloud.red = cloud.green = cloud.blue = {7, 8};
    cloud.source = "a.bt";
    cloud.notes = {"A note."};
    map.space.voxel_m = 0.1;
    map.space.free = {{{0, 0, 0}, {1, 1, 1}}};
    map.space.solid = {{{2, 0, 0}, {2, 1, 1}}};
    return map;
}

bool taken(const ScannedMap& map) {
    try {
        take_scan(answer_of(bytes_of(map)));
        return true;
    } catch (const child::BadAnswer&) {
        return false;
    }
}

TEST(ScanMessage, comes_back_whole) {
    const ScannedMap back = take_scan(answer_of(bytes_of(map_of_two())));
    EXPECT_EQ(back.cloud.y, (std::vector<float>{3, 4}));
    EXPECT_EQ(back.cloud.blue, (std::vector<std::uint8_t>{7, 8}));
    EXPECT_EQ(back.cloud.notes, (std::vector<std::string>{"A note."}));
    EXPECT_EQ(back.space.solid.at(0).high[2], 1);
}

TEST(ScanMessage, what_makes_no_sense_is_refused) {
    const auto changed = [](const auto& change) {
        ScannedMap map = map_of_two();
        change(map);
        return map;
    };
    EXPECT_TRUE(taken(map_of_two()));
    EXPECT_FALSE(taken(changed([](auto& m) { m.cloud.x.pop_back(); })));
    EXPECT_FALSE(taken(changed([](auto& m) { m.cloud.x[1] = NAN; })));
    EXPECT_FALSE(taken(changed([](auto& m) { m.cloud.nz[1] = 2; })));
    EXPECT_FALSE(taken(changed([](auto& m) { m.cloud.ny.clear(); })));
    EXPECT_FALSE(taken(changed([](auto& m) { m.cloud.green.pop_back(); })));
    EXPECT_FALSE(taken(changed([](auto& m) { m.cloud.pixel = {0, 1}; })));
    EXPECT_FALSE(taken(changed([](auto& m) { m.cloud.offset_m[0] = INFINITY; })));
    EXPECT_FALSE(taken(changed([](auto& m) { m.space.voxel_m = 0; })));
    EXPECT_FALSE(taken(changed([](auto& m) { m.space.free[0].high[1] = -1; })));
    EXPECT_FALSE(taken(changed([](auto& m) { m.space.solid[0].high[1] = INT32_MAX; })));
}

// Whatever a child that was taken over writes, nothing worse comes of it than an error.
TEST(ScanMessage, damaged_answers_are_refused_or_sound) {
    const std::string good = bytes_of(map_of_two());
    Random random(1);
    for (int n = 0; n < 20000; ++n) {
        std::string bytes = good;
        for (int k = 0; k < 1 + n % 3; ++k)
            bytes[child::answer_head + random.below(bytes.size() - child::answer_head)] =
                static_cast<char>(random.below(256));
        const child::Answer answer = answer_of(bytes);
        ASSERT_TRUE(answer.whole());
        try {
            const ScannedMap map = take_scan(answer);
            ASSERT_EQ(map.cloud.x.size(), map.cloud.z.size());
        } catch (const child::BadAnswer&) {
        } catch (const Error&) {
        }
    }
    for (std::size_t size = 0; size < good.size(); ++size)
        EXPECT_FALSE(answer_of(good.substr(0, size)).whole()) << size;
}

}  // namespace
}  // namespace topple::reader

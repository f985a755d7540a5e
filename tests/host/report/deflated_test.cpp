// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "report/embedded.h"

namespace topple::report {
namespace {

// Of base64 and zlib's format.
std::string inflated(const std::string& text, std::size_t size) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned held = 0, bits = 0;
    for (const char c : text) {
        if (c == '=') break;
        held = held << 6 | static_cast<unsigned>(digits.find(c));
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes += static_cast<char>(held >> bits);
    }
    std::string out(size + 1, '\0');
    uLongf length = out.size();
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(out.data()), &length,
                         reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()),
              Z_OK);
    out.resize(length);
    return out;
}

TEST(Deflated, is_what_zlib_inflates) {
    for (const std::string& text : {std::string(), std::string("a"), std::string(70000, 'x')})
        EXPECT_EQ(inflated(deflated(text), text.size()), text);
}

// As recordsOf() of the page has it.
TEST(Deflated, records_are_their_steps) {
    const std::vector<std::array<std::uint16_t, 2>> records{
        {0, 65535}, {65535, 0}, {300, 7}, {299, 8}};
    const std::string bytes = inflated(deflated(records), 16);
    ASSERT_EQ(bytes.size(), 16u);
    for (std::size_t c = 0; c < 2; ++c) {
        std::uint16_t value = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const auto byte = [&](std::size_t n) {
                return static_cast<unsigned char>(bytes[8 * c + n]);
            };
            const unsigned step = byte(i) | unsigned{byte(4 + i)} << 8;
            const unsigned sign = step & 1 ? 0xffffu : 0u;
            value = static_cast<std::uint16_t>(value + ((step >> 1) ^ sign));
            EXPECT_EQ(value, records[i][c]) << i << ' ' << c;
        }
    }
    const std::vector<std::array<std::int8_t, 1>> small{{-128}, {127}, {-1}};
    EXPECT_EQ(inflated(deflated(small), 3), "\x80\xff\x80");
}

TEST(Deflated, plain_numbers_by_low_and_high_bytes) {
    const std::vector<std::array<std::uint16_t, 3>> records{{1, 2, 0x1203}, {4, 5, 6}};
    EXPECT_EQ(inflated(deflated_plain(records), 12),
              std::string("\x01\x02\x03\x04\x05\x06\0\0\x12\0\0\0", 12));
}

}  // namespace
}  // namespace topple::report

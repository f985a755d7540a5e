// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// How data and texts stand in the page.
namespace topple::report {

// RFC 4648, with padding.
std::string base64(const void* bytes, std::size_t count);

// JSON that may stand inside <script>: nothing in it can end the element or start a comment.
std::string script_safe(std::string_view json);

// Text that may stand in an element, or in an attribute within quotes.
std::string html_escaped(std::string_view text);

// zlib's format (RFC 1950) in base64, which browsers inflate themselves.
std::string deflated(std::string_view bytes);

// Whole numbers that have nothing to do with those before: their low bytes, then the high ones.
template <std::size_t channels>
std::string deflated_plain(const std::vector<std::array<std::uint16_t, channels>>& records) {
    const std::size_t count = records.size() * channels;
    std::string bytes(2 * count, '\0');
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint16_t value = records[i / channels][i % channels];
        bytes[i] = static_cast<char>(value);
        bytes[count + i] = static_cast<char>(value >> 8);
    }
    return deflated(bytes);
}

// Records of whole numbers, so that little is left of them where neighbours are alike: channel by
// channel, each number as its difference from the record before, modulo 2^bits; the low bytes of
// all of them, then, of 16 bits, the high ones.
template <class Number, std::size_t channels>
std::string deflated(const std::vector<std::array<Number, channels>>& records) {
    static_assert(sizeof(Number) <= 2);
    const std::size_t count = records.size();
    std::string bytes(count * channels * sizeof(Number), '\0');
    char* low = bytes.data();
    for (std::size_t c = 0; c < channels; ++c, low += count * sizeof(Number)) {
        std::uint32_t before = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const auto value = static_cast<std::uint32_t>(records[i][c]);
            std::uint32_t step = value - before;
            before = value;
            if constexpr (sizeof(Number) == 2) {
                // Small steps of either sign have an empty high byte.
                const auto sign = static_cast<std::int16_t>(step);
                step = (std::uint32_t(sign) << 1) ^ std::uint32_t(sign >> 15);
                low[count + i] = static_cast<char>(step >> 8);
            }
            low[i] = static_cast<char>(step);
        }
    }
    return deflated(bytes);
}

}  // namespace topple::report

// SPDX-License-Identifier: MIT
#include "core/printable.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace topple {
namespace {

// A character, and how many bytes it has; none where the front of `text` is no UTF-8.
struct Character {
    char32_t value = 0;
    std::size_t length = 0;
};

Character first_of(std::string_view text) {
    const auto lead = static_cast<unsigned char>(text[0]);
    const std::size_t length = lead < 0x80                    ? 1
                               : lead >= 0xC2 && lead <= 0xDF ? 2
                               : lead >= 0xE0 && lead <= 0xEF ? 3
                               : lead >= 0xF0 && lead <= 0xF4 ? 4
                                                              : 0;
    if (length == 0 || length > text.size()) return {};
    char32_t value = length == 1 ? lead : lead & (0x7Fu >> length);
    for (std::size_t i = 1; i < length; ++i) {
        const auto next = static_cast<unsigned char>(text[i]);
        if ((next & 0xC0) != 0x80) return {};
        value = value << 6 | (next & 0x3Fu);
    }
    const bool overlong = value < (length == 3 ? 0x800u : length == 4 ? 0x10000u : 0u);
    const bool surrogate = value >= 0xD800 && value <= 0xDFFF;
    if (overlong || surrogate || value > 0x10FFFF) return {};
    return {value, length};
}

// Of Unicode's classes Cc, Cf, Zl and Zp, and what is no character: these steer terminals, are not
// seen, or turn the order of what stands beside them.
bool steers(char32_t c) {
    constexpr std::pair<char32_t, char32_t> ranges[] = {
        {0, 0x1F},          {0x7F, 0x9F},       {0xAD, 0xAD},       {0x600, 0x605},
        {0x61C, 0x61C},     {0x6DD, 0x6DD},     {0x70F, 0x70F},     {0x890, 0x891},
        {0x8E2, 0x8E2},     {0x180E, 0x180E},   {0x200B, 0x200F},   {0x2028, 0x202E},
        {0x2060, 0x206F},   {0xFEFF, 0xFEFF},   {0xFFF0, 0xFFFB},   {0xFFFE, 0xFFFF},
        {0x110BD, 0x110BD}, {0x110CD, 0x110CD}, {0x13430, 0x1343F}, {0x1BCA0, 0x1BCA3},
        {0x1D173, 0x1D17A}, {0xE0000, 0xE007F}};
    return std::ranges::any_of(
        ranges, [&](const auto& range) { return c >= range.first && c <= range.second; });
}

}  // namespace

std::string printable(std::string_view text, std::size_t most) {
    std::string out;
    while (!text.empty()) {
        if (out.size() >= most) return out + "...";
        std::size_t plain = 0;
        while (plain < std::min(text.size(), most - out.size()) && text[plain] >= 0x20 &&
               text[plain] < 0x7F)
            ++plain;
        if (plain > 0) {
            out.append(text.substr(0, plain));
            text.remove_prefix(plain);
            continue;
        }
        const Character character = first_of(text);
        const std::size_t taken = std::max<std::size_t>(character.length, 1);
        if (character.length > 0 && !steers(character.value)) {
            out.append(text.substr(0, taken));
        } else {
            for (std::size_t i = 0; i < taken; ++i) {
                char hex[5];
                std::snprintf(hex, sizeof(hex), "\\x%02x", static_cast<unsigned char>(text[i]));
                out += hex;
            }
        }
        text.remove_prefix(taken);
    }
    return out;
}

}  // namespace topple

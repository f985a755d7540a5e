// SPDX-License-Identifier: MIT
#include "core/printable.h"

#include <algorithm>
#include <cstdio>

namespace topple {
namespace {

// Length of the UTF-8 sequence at the front of `text`, 0 where there is none.
std::size_t utf8_length(std::string_view text) {
    const auto lead = static_cast<unsigned char>(text[0]);
    const std::size_t length = lead < 0x80                    ? 1
                               : lead >= 0xC2 && lead <= 0xDF ? 2
                               : lead >= 0xE0 && lead <= 0xEF ? 3
                               : lead >= 0xF0 && lead <= 0xF4 ? 4
                                                              : 0;
    if (length > text.size()) return 0;
    for (std::size_t i = 1; i < length; ++i) {
        if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) return 0;
    }
    return length;
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
        const auto length = utf8_length(text);
        const auto byte = static_cast<unsigned char>(text[0]);
        // C1 control characters (U+0080 to U+009F) steer terminals as C0 ones do.
        const bool control = length == 0 || byte < 0x20 || byte == 0x7F ||
                             (byte == 0xC2 && static_cast<unsigned char>(text[1]) < 0xA0);
        const std::size_t taken = length == 0 ? 1 : length;
        if (!control) {
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

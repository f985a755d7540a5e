// SPDX-License-Identifier: MIT
#include "report/base64.h"

#include <cstdint>

namespace topple::report {

std::string base64(const void* bytes, std::size_t count) {
    static constexpr char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const auto* in = static_cast<const unsigned char*>(bytes);
    std::string out;
    out.reserve((count + 2) / 3 * 4);
    for (std::size_t i = 0; i < count; i += 3) {
        const std::uint32_t second = i + 1 < count ? in[i + 1] : 0u,
                            third = i + 2 < count ? in[i + 2] : 0u;
        const std::uint32_t word = std::uint32_t(in[i]) << 16 | second << 8 | third;
        out += digits[word >> 18];
        out += digits[word >> 12 & 63];
        out += i + 1 < count ? digits[word >> 6 & 63] : '=';
        out += i + 2 < count ? digits[word & 63] : '=';
    }
    return out;
}

}  // namespace topple::report

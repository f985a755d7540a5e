// SPDX-License-Identifier: MIT
#include "report/embedded.h"

#include <libdeflate.h>

#include <algorithm>
#include <initializer_list>
#include <memory>
#include <new>
#include <utility>

namespace topple::report {
namespace {

std::string with_replaced(std::string_view text,
                          std::initializer_list<std::pair<char, const char*>> replacements) {
    std::string out;
    out.reserve(text.size() + text.size() / 64);
    for (const char c : text) {
        const auto* found =
            std::ranges::find(replacements, c, &std::pair<char, const char*>::first);
        if (found == replacements.end())
            out += c;
        else
            out += found->second;
    }
    return out;
}

}  // namespace

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

std::string deflated(std::string_view bytes) {
    // Higher levels take a multiple of the time for a few hundredths of the size.
    constexpr int level = 6;
    const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
        libdeflate_alloc_compressor(level), &libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    std::string out(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()), '\0');
    const std::size_t size = libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(),
                                                      out.data(), out.size());
    return base64(out.data(), size);
}

std::string script_safe(std::string_view json) {
    return with_replaced(json, {{'<', "\\u003c"}});
}

std::string html_escaped(std::string_view text) {
    return with_replaced(text, {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}});
}

}  // namespace topple::report

// SPDX-License-Identifier: MIT
#include "io/text.h"

#include <locale.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/number_text.h"
#include "io/open_file.h"

namespace topple::io {
namespace fs = std::filesystem;
std::string lower_case(std::string_view text) {
    std::string out(text);
    for (char& c : out) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    return out;
}

std::string in_quotes(std::string_view text) {
    std::string out(1, '"');
    out += printable(text);
    out += '"';
    return out;
}

std::string path_text(const std::filesystem::path& path) {
    return printable(path.native(), 4096);
}

void fail(const std::filesystem::path& file, const std::string& message) {
    throw Error(ErrorKind::input, path_text(file) + ": " + message);
}

std::string counted(std::uint64_t count, const char* noun) {
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string size_text(std::uint64_t width, std::uint64_t height) {
    return std::to_string(width) + " x " + std::to_string(height);
}

std::string vector_text(const std::array<double, 3>& v) {
    return std::string("(") + short_number(v[0]) + ", " + short_number(v[1]) + ", " +
           short_number(v[2]) + ")";
}

std::string two_digits(double value) {
    const double size = std::abs(value);
    if (size < 0.0005) return "0";
    const int before = static_cast<int>(std::floor(std::log10(size))) + 1;
    return to_places(value, std::max(0, 2 - before));
}

namespace {

std::string bytes_text_of(double value, int digits) {
    static constexpr std::array<const char*, 5> units{"B", "KiB", "MiB", "GiB", "TiB"};
    std::size_t unit = 0;
    for (; unit + 1 < units.size() && value >= 999.5; ++unit) value /= 1024;
    return to_digits(value, digits) + " " + units[unit];
}

}  // namespace

std::string bytes_text(std::uint64_t bytes, int digits) {
    return bytes_text_of(static_cast<double>(bytes), digits);
}

std::string sufficient_bytes_text(std::uint64_t bytes) {
    double unit = 1;
    while (static_cast<double>(bytes) / unit >= 999.5) unit *= 1024;
    const double value = static_cast<double>(bytes) / unit;
    const double last = value < 10 ? 0.01 : value < 100 ? 0.1 : 1;  // place of the third digit
    return bytes_text_of(std::ceil(value / last) * last * unit, 3);
}

FileBytes read_file(const fs::path& file, std::uint64_t limit) {
    return read_file(FileName(file), limit);
}

bool parse_number(std::string_view token, double& value) {
    if (!token.empty() && token.front() == '+') {
        token.remove_prefix(1);
        if (!token.empty() && (token.front() == '-' || token.front() == '+')) return false;
    }
    if (token.empty()) return false;
    const auto* last = token.data() + token.size();
    const auto result = std::from_chars(token.data(), last, value);
    if (result.ptr != last || result.ec == std::errc::invalid_argument) return false;
    if (result.ec == std::errc::result_out_of_range) {
        // from_chars does not tell too large from too small; strtod does, and this is rare.
        static const locale_t classic = ::newlocale(LC_ALL_MASK, "C", nullptr);
        value = ::strtod_l(std::string(token).c_str(), nullptr, classic);
    }
    return true;
}

bool parse_count(std::string_view token, std::uint64_t& value) {
    if (token.empty() || token.front() < '0' || token.front() > '9') return false;
    const auto* last = token.data() + token.size();
    const auto result = std::from_chars(token.data(), last, value);
    return result.ptr == last && result.ec == std::errc();
}

}  // namespace topple::io

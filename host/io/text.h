// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "core/printable.h"
#include "core/short_number.h"
#include "topple/error.h"

// What the readers share: files as bytes, lines with numbers, tokens, numbers, and messages that
// stay one printable line whatever the input holds.
namespace topple::io {

using topple::printable;
using topple::short_number;
// As printable(), between double quotes.
std::string in_quotes(std::string_view text);
// A path, whole.
std::string path_text(const std::filesystem::path& path);

// Throws Error(input) saying "<file>: <message>".
[[noreturn]] void fail(const std::filesystem::path& file, const std::string& message);

// "3 points", "1 point".
std::string counted(std::uint64_t count, const char* noun);
// "640 x 480".
std::string size_text(std::uint64_t width, std::uint64_t height);

// "(1, 2, 0.5)", each as short_number().
std::string vector_text(const std::array<double, 3>& v);
// Two digits, or all before the point, without an exponent; below half a thousandth it is nothing.
std::string two_digits(double value);

// "512 B", "200 MiB", "1.5 GiB": to so many digits.
std::string bytes_text(std::uint64_t bytes, int digits = 3);
// The same to three digits, and no less than these bytes.
std::string sufficient_bytes_text(std::uint64_t bytes);

// A file's bytes, held once and not initialised before they are read.
struct FileBytes {
    std::unique_ptr<char[]> data;
    std::size_t size = 0;
    std::string_view text() const { return {data.get(), size}; }
};

// Reads a regular file whole. Throws Error(input) where it is missing, no regular file, unreadable,
// empty, larger than `limit` bytes, or where memory does not suffice.
FileBytes read_file(const std::filesystem::path& file, std::uint64_t limit = UINT64_MAX);

// Letters of ASCII alone, whatever the locale.
std::string lower_case(std::string_view text);

// The lines of a text, with or without \r, counted from 1.
class Lines {
  public:
    explicit Lines(std::string_view text, std::size_t offset = 0, std::uint64_t line_number = 0)
        : text_(text), offset_(offset), number_(line_number) {}
    // False at the end of the text.
    bool next(std::string_view& line) {
        if (offset_ >= text_.size()) return false;
        const auto end = text_.find('\n', offset_);
        const auto stop = end == std::string_view::npos ? text_.size() : end;
        line = text_.substr(offset_, stop - offset_);
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        offset_ = end == std::string_view::npos ? text_.size() : end + 1;
        ++number_;
        return true;
    }
    std::uint64_t number() const { return number_; }  // of the line read last
    std::size_t offset() const { return offset_; }    // of the line to read next
    std::size_t remaining() const { return text_.size() - offset_; }

  private:
    std::string_view text_;
    std::size_t offset_;
    std::uint64_t number_;
};

// The next run of characters in `line` that are no separators, taken off its front; empty where
// there is none. Space, tab, vertical tab, form feed and \r separate; so do , and ; with `commas`.
inline bool is_separator(char c, bool commas) {
    return c == ' ' || (c >= '\t' && c <= '\r') || (commas && (c == ',' || c == ';'));
}
inline std::string_view next_token(std::string_view& line, bool commas = false) {
    std::size_t first = 0;
    while (first < line.size() && is_separator(line[first], commas)) ++first;
    std::size_t last = first;
    while (last < line.size() && !is_separator(line[last], commas)) ++last;
    const auto token = line.substr(first, last - first);
    line.remove_prefix(last);
    return token;
}

// Whole-token numbers, in the C locale. "nan" and "inf" are numbers; what is too large for a double
// is infinite, what is too small is 0.
bool parse_number(std::string_view token, double& value);
// Decimal digits only, up to 2^64 - 1.
bool parse_count(std::string_view token, std::uint64_t& value);

// a * b, or UINT64_MAX where that overflows.
inline std::uint64_t saturating_multiply(std::uint64_t a, std::uint64_t b) {
    std::uint64_t product;
    return __builtin_mul_overflow(a, b, &product) ? UINT64_MAX : product;
}

}  // namespace topple::io

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>

#include "io/text.h"
#include "points/formats/ply_file.h"

namespace topple::io {
namespace {

using namespace std::string_view_literals;

// Whether the whole token is a number of that type, so that whoever reads as many digits as he
// understands ends where the token does.
bool is_number(Scalar type, std::string_view token) {
    double value = 0;
    switch (type) {
        case Scalar::f32:
        case Scalar::f64:
            return parse_number(token, value);
        case Scalar::i8:
        case Scalar::i16:
        case Scalar::i32:
            if (token.starts_with('-')) token.remove_prefix(1);
            [[fallthrough]];
        default:
            return !token.empty() && token.size() <= 10 &&
                   std::ranges::all_of(token, [](char c) { return c >= '0' && c <= '9'; });
    }
}

// The lines of a text file: every item is one.
class TextItems {
  public:
    TextItems(const std::filesystem::path& file, std::string_view bytes, const PlyHeader& header)
        : file_(file), lines_(bytes, header.data_offset, header.lines) {}

    void step_over_all(const PlyElement& element) {
        for (std::uint64_t i = 0; i < element.count; ++i) {
            if (!lines_.next(rest_))
                ply_cut_short(file_, element, saturating_multiply(element.count - i, 2), 0);
            if (rest_.find_first_of("\v\f\r\0"sv) != std::string_view::npos)
                bad("a control character stands between its values");
            for (const PlyProperty& property : element.properties) step_over(property);
            if (!next_token(rest_).empty()) bad("there are more values than the header promises");
        }
    }

  private:
    [[noreturn]] void bad(const std::string& message) const {
        fail(file_, "line " + std::to_string(lines_.number()) + ": " + message);
    }
    void step_over(const PlyProperty& property) {
        std::uint64_t values = 1;
        if (property.list_count) {
            const auto token = next_token(rest_);
            if (!parse_count(token, values)) bad(in_quotes(token) + " is no length of a list");
        }
        for (; values > 0; --values) {
            const auto token = next_token(rest_);
            if (token.empty()) {
                bad(property.list_count ? "a list has fewer values than its length says"
                                        : "there are fewer values than the header promises");
            }
            if (!is_number(property.type, token))
                bad(in_quotes(token) + " is no number of its property's type");
        }
    }

    const std::filesystem::path& file_;
    Lines lines_;
    std::string_view rest_;  // of the line
};

void check_types(const std::filesystem::path& file, const PlyElement& element) {
    const auto wide = [](Scalar type) { return type == Scalar::i64 || type == Scalar::u64; };
    if (element.properties.empty() && element.count > 0)
        fail(file, "element '" + printable(element.name) + "' has items, but no property");
    for (const PlyProperty& property : element.properties) {
        if (wide(property.type) || (property.list_count && wide(*property.list_count))) {
            fail(file, "property '" + printable(property.name) + "' of element '" +
                           printable(element.name) + "' has 64 bits, and faces have none");
        }
    }
}

}  // namespace

void check_ply(const std::filesystem::path& file, std::string_view bytes) {
    const PlyHeader header = parse_ply_header(file, bytes);
    for (const PlyElement& element : header.elements) check_types(file, element);
    if (header.encoding == PlyEncoding::ascii) {
        TextItems items(file, bytes, header);
        for (const PlyElement& element : header.elements) items.step_over_all(element);
    } else {
        PlyItems items(file, bytes, header);
        for (const PlyElement& element : header.elements) items.step_over_all(element);
    }
}

}  // namespace topple::io

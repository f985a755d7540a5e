// SPDX-License-Identifier: MIT
#include "points/formats/ply_file.h"

#include <utility>

#include "io/text.h"

namespace topple::io {
namespace {

using namespace std::string_view_literals;

// More than any writer needs; a header beyond them is damaged or hostile.
constexpr std::size_t most_elements = 1000, most_properties = 10000;

std::optional<Scalar> scalar_named(std::string_view name) {
    static constexpr std::pair<std::string_view, Scalar> names[] = {
        {"char", Scalar::i8},    {"int8", Scalar::i8},     {"uchar", Scalar::u8},
        {"uint8", Scalar::u8},   {"short", Scalar::i16},   {"int16", Scalar::i16},
        {"ushort", Scalar::u16}, {"uint16", Scalar::u16},  {"int", Scalar::i32},
        {"int32", Scalar::i32},  {"uint", Scalar::u32},    {"uint32", Scalar::u32},
        {"long", Scalar::i64},   {"int64", Scalar::i64},   {"ulong", Scalar::u64},
        {"uint64", Scalar::u64}, {"float", Scalar::f32},   {"float32", Scalar::f32},
        {"double", Scalar::f64}, {"float64", Scalar::f64},
    };
    for (const auto& [known, type] : names) {
        if (known == name) return type;
    }
    return std::nullopt;
}

class PlyHeaderParser {
  public:
    PlyHeaderParser(const std::filesystem::path& file, std::string_view bytes)
        : file_(file), lines_(bytes) {}

    PlyHeader parse() {
        std::string_view line;
        lines_.next(line);  // "ply", as the caller has seen
        bool has_format = false;
        while (lines_.next(line)) {
            if (line.find_first_of("\0\v\f\r"sv) != std::string_view::npos)
                bad("a control character stands in the header");
            auto rest = line;
            const auto keyword = next_token(rest);
            if (keyword == "end_header") {
                if (!has_format) bad("the header has no format line");
                header_.data_offset = lines_.offset();
                header_.lines = lines_.number();
                return std::move(header_);
            }
            if (keyword == "format") {
                if (has_format) bad("the header has two format lines");
                parse_format(rest);
                has_format = true;
            } else if (keyword == "element") {
                parse_element(rest);
            } else if (keyword == "property") {
                parse_property(rest);
            } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
                bad(in_quotes(keyword) + " is no PLY header keyword");
            }
        }
        fail(file_, "the PLY header has no end_header line (looked through " +
                        counted(lines_.number(), "line") + "); the file is cut short or damaged");
    }

  private:
    [[noreturn]] void bad(const std::string& message) const {
        fail(file_, "line " + std::to_string(lines_.number()) + ": " + message);
    }

    // Others may read on in such a line, and understand the header in another way than we do.
    void expect_end(std::string_view rest) const {
        if (const auto more = next_token(rest); !more.empty())
            bad(in_quotes(more) + " stands after what belongs in this line");
    }

    void parse_format(std::string_view rest) {
        const auto name = next_token(rest);
        if (name == "ascii") {
            header_.encoding = PlyEncoding::ascii;
        } else if (name == "binary_little_endian") {
            header_.encoding = PlyEncoding::little;
        } else if (name == "binary_big_endian") {
            header_.encoding = PlyEncoding::big;
        } else {
            bad("format " + in_quotes(name) +
                " is none of ascii, binary_little_endian, binary_big_endian");
        }
        const auto version = next_token(rest);
        if (version != "1.0") bad("PLY version " + in_quotes(version) + " is not 1.0");
        expect_end(rest);
    }

    void parse_element(std::string_view rest) {
        PlyElement element;
        element.name = next_token(rest);
        const auto count = next_token(rest);
        if (element.name.empty() || !parse_count(count, element.count)) {
            bad("element " + in_quotes(element.name) + " needs a count, not " + in_quotes(count));
        }
        expect_end(rest);
        for (const auto& other : header_.elements) {
            if (other.name == element.name)
                bad("element " + in_quotes(element.name) + " occurs twice");
        }
        if (header_.elements.size() == most_elements) bad("more than 1000 elements");
        header_.elements.push_back(std::move(element));
    }

    void parse_property(std::string_view rest) {
        if (header_.elements.empty()) bad("a property stands before the first element");
        PlyProperty property;
        auto type = next_token(rest);
        if (type == "list") {
            property.list_count = scalar(next_token(rest));
            if (*property.list_count == Scalar::f32 || *property.list_count == Scalar::f64) {
                bad("a list's length can't be a floating-point number");
            }
            type = next_token(rest);
        }
        property.type = scalar(type);
        property.name = next_token(rest);
        if (property.name.empty()) bad("a property has no name");
        expect_end(rest);
        auto& properties = header_.elements.back().properties;
        if (properties.size() == most_properties) bad("more than 10000 properties");
        properties.push_back(std::move(property));
    }

    Scalar scalar(std::string_view name) const {
        const auto type = scalar_named(name);
        if (!type) bad(in_quotes(name) + " is no PLY number type");
        return *type;
    }

    const std::filesystem::path& file_;
    Lines lines_;
    PlyHeader header_;
};

}  // namespace

PlyHeader parse_ply_header(const std::filesystem::path& file, std::string_view bytes) {
    return PlyHeaderParser(file, bytes).parse();
}

void ply_cut_short(const std::filesystem::path& file, const PlyElement& element,
                   std::uint64_t needed, std::uint64_t found) {
    fail(file, "the header promises " +
                   counted(element.count, ("element '" + printable(element.name) + "'").c_str()) +
                   ", which need at least " + std::to_string(needed) + " bytes, but " +
                   std::to_string(found) +
                   " are left in the file; it is cut short, or its header is wrong");
}

void PlyItems::expect(const PlyElement& element) const {
    const auto needed = saturating_multiply(element.count, element.least_bytes());
    if (needed > left()) ply_cut_short(file_, element, needed, left());
}

void PlyItems::step_over_all(const PlyElement& element) {
    expect(element);
    if (!element.has_lists()) {
        at_ += element.count * element.least_bytes();
        return;
    }
    for (std::uint64_t i = 0; i < element.count; ++i) step_over(element, i, nullptr);
}

void PlyItems::step_over(const PlyElement& element, std::uint64_t index, const char** starts) {
    for (const auto& property : element.properties) {
        if (starts) *starts++ = at_;
        take(element, index, bytes_of(property.list_count.value_or(property.type)));
        if (!property.list_count) continue;
        const auto bytes = bytes_of(*property.list_count);
        const double length = load_scalar(*property.list_count, at_ - bytes, swapped_);
        if (length < 0 || length > 9e18) {
            fail(file_, "element '" + printable(element.name) + "' " + std::to_string(index) +
                            ": list '" + printable(property.name) + "' has length " +
                            short_number(length));
        }
        take(element, index,
             saturating_multiply(static_cast<std::uint64_t>(length), bytes_of(property.type)));
    }
}

void PlyItems::take(const PlyElement& element, std::uint64_t index, std::uint64_t bytes) {
    if (bytes > left()) {
        fail(file_, "element '" + printable(element.name) + "' " + std::to_string(index) + " of " +
                        std::to_string(element.count) + " needs " + counted(bytes, "more byte") +
                        ", but " + std::to_string(left()) +
                        " are left in the file; it is cut short or damaged");
    }
    at_ += bytes;
}

}  // namespace topple::io

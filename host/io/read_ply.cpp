// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "io/cloud_builder.h"
#include "io/formats.h"
#include "io/scalar.h"
#include "io/text.h"

namespace topple::io {
namespace {

enum class Encoding : std::uint8_t { ascii, little, big };

struct Property {
    std::string name;
    Scalar type = Scalar::f32;
    std::optional<Scalar> list_count;  // the type of a list's length, where this is a list
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;

    bool has_lists() const {
        for (const auto& property : properties) {
            if (property.list_count) return true;
        }
        return false;
    }
    // Bytes of one item where all its lists are empty.
    std::uint64_t least_bytes() const {
        std::uint64_t bytes = 0;
        for (const auto& property : properties)
            bytes += bytes_of(property.list_count.value_or(property.type));
        return bytes;
    }
};

struct Header {
    Encoding encoding = Encoding::ascii;
    std::vector<Element> elements;
    std::size_t data_offset = 0;
    std::uint64_t lines = 0;
};

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

class HeaderParser {
  public:
    HeaderParser(const std::filesystem::path& file, std::string_view bytes)
        : file_(file), lines_(bytes) {}

    Header parse() {
        std::string_view line;
        lines_.next(line);  // "ply", as the caller has seen
        bool has_format = false;
        while (lines_.next(line)) {
            auto rest = line;
            const auto keyword = next_token(rest);
            if (keyword == "end_header") {
                if (!has_format) bad("the header has no format line");
                header_.data_offset = lines_.offset();
                header_.lines = lines_.number();
                return std::move(header_);
            }
            if (keyword == "format") {
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

    void parse_format(std::string_view rest) {
        const auto name = next_token(rest);
        if (name == "ascii") {
            header_.encoding = Encoding::ascii;
        } else if (name == "binary_little_endian") {
            header_.encoding = Encoding::little;
        } else if (name == "binary_big_endian") {
            header_.encoding = Encoding::big;
        } else {
            bad("format " + in_quotes(name) +
                " is none of ascii, binary_little_endian, binary_big_endian");
        }
        const auto version = next_token(rest);
        if (version != "1.0") bad("PLY version " + in_quotes(version) + " is not 1.0");
    }

    void parse_element(std::string_view rest) {
        Element element;
        element.name = next_token(rest);
        const auto count = next_token(rest);
        if (element.name.empty() || !parse_count(count, element.count)) {
            bad("element " + in_quotes(element.name) + " needs a count, not " + in_quotes(count));
        }
        for (const auto& other : header_.elements) {
            if (other.name == element.name)
                bad("element " + in_quotes(element.name) + " occurs twice");
        }
        if (header_.elements.size() == most_elements) bad("more than 1000 elements");
        header_.elements.push_back(std::move(element));
    }

    void parse_property(std::string_view rest) {
        if (header_.elements.empty()) bad("a property stands before the first element");
        Property property;
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
    Header header_;
};

// Where in a vertex the coordinates and the normal are: indices into its properties.
struct Wanted {
    std::array<std::size_t, 3> point{}, normal{};
    bool has_normal = false;
};

std::optional<std::size_t> find_property(const std::filesystem::path& file, const Element& vertex,
                                         std::string_view name) {
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < vertex.properties.size(); ++i) {
        if (vertex.properties[i].name != name) continue;
        if (found) fail(file, "the vertices have two properties " + std::string(name));
        if (vertex.properties[i].list_count)
            fail(file, "the vertex property " + std::string(name) + " is a list");
        found = i;
    }
    return found;
}

Wanted find_wanted(const std::filesystem::path& file, const Element& vertex) {
    Wanted wanted;
    static constexpr std::array<const char*, 3> point{"x", "y", "z"};
    static constexpr std::array<const char*, 3> normal{"nx", "ny", "nz"},
        long_normal{"normal_x", "normal_y", "normal_z"};
    int normals = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = find_property(file, vertex, point[axis]);
        if (!at)
            fail(file, std::string("the vertices have no property ") + point[axis] +
                           "; x, y and z are needed");
        wanted.point[axis] = *at;
        auto of_normal = find_property(file, vertex, normal[axis]);
        if (!of_normal) of_normal = find_property(file, vertex, long_normal[axis]);
        if (of_normal) {
            wanted.normal[axis] = *of_normal;
            ++normals;
        }
    }
    wanted.has_normal = normals == 3;
    return wanted;
}

[[noreturn]] void cut_short(const std::filesystem::path& file, const Element& element,
                            std::uint64_t needed, std::uint64_t found) {
    fail(file, "the header promises " +
                   counted(element.count, ("element '" + printable(element.name) + "'").c_str()) +
                   ", which need at least " + std::to_string(needed) + " bytes, but " +
                   std::to_string(found) +
                   " are left in the file; it is cut short, or its header is wrong");
}

// Reads vertex lines. Every item is one line.
PointCloud read_ascii(const std::filesystem::path& file, std::string_view bytes,
                      const Header& header, const CloudSink* sink) {
    Lines lines(bytes, header.data_offset, header.lines);
    std::string_view line;
    for (const auto& element : header.elements) {
        const bool is_vertex = element.name == "vertex";
        // Each value takes a character and a separator; the last line may lack its end.
        const auto needed = saturating_multiply(
            element.count, std::max<std::uint64_t>(1, 2 * element.properties.size()));
        if (needed > lines.remaining() + 1) cut_short(file, element, needed - 1, lines.remaining());
        if (!is_vertex) {
            for (std::uint64_t i = 0; i < element.count; ++i) {
                if (!lines.next(line)) cut_short(file, element, needed, 0);
            }
            continue;
        }
        const auto wanted = find_wanted(file, element);
        CloudBuilder cloud(file, element.count, wanted.has_normal, sink);
        // What to do with each value on the line: 0-2 point, 3-5 normal, -1 skip.
        std::vector<int> role(element.properties.size(), -1);
        for (int axis = 0; axis < 3; ++axis) {
            role[wanted.point[std::size_t(axis)]] = axis;
            if (wanted.has_normal) role[wanted.normal[std::size_t(axis)]] = 3 + axis;
        }
        const auto bad = [&](const std::string& message) {
            fail(file, "line " + std::to_string(lines.number()) + ": " + message);
        };
        while (cloud.seen() < element.count) {
            if (!lines.next(line)) {
                fail(file, "the header promises " + std::to_string(element.count) +
                               " vertices, the file has " + std::to_string(cloud.seen()) +
                               "; it is cut short, or its header is wrong");
            }
            std::array<double, 3> point{}, normal{};
            auto rest = line;
            for (std::size_t i = 0; i < role.size(); ++i) {
                const auto token = next_token(rest);
                if (token.empty()) {
                    bad(std::to_string(i) + " of the " + counted(role.size(), "value") +
                        " that each vertex has");
                }
                if (element.properties[i].list_count) {
                    std::uint64_t length = 0;
                    if (!parse_count(token, length))
                        bad(in_quotes(token) + " is no length of a list");
                    for (; length > 0; --length) {
                        if (next_token(rest).empty())
                            bad("a list has fewer values than its length says");
                    }
                } else if (role[i] >= 0) {
                    auto& value = role[i] < 3 ? point[std::size_t(role[i])]
                                              : normal[std::size_t(role[i] - 3)];
                    if (!parse_number(token, value)) bad(in_quotes(token) + " is not a number");
                }
            }
            if (!next_token(rest).empty()) {
                bad("more than the " + counted(role.size(), "value") + " that each vertex has");
            }
            cloud.add(point, normal);
        }
        return cloud.finish();
    }
    fail(file, "has no element vertex");
}

class BinaryReader {
  public:
    BinaryReader(const std::filesystem::path& file, std::string_view bytes, const Header& header)
        : file_(file),
          header_(header),
          at_(bytes.data() + header.data_offset),
          end_(bytes.data() + bytes.size()),
          swapped_(must_swap(header.encoding == Encoding::big)) {}

    PointCloud read(const CloudSink* sink) {
        for (const auto& element : header_.elements) {
            const auto needed = saturating_multiply(element.count, element.least_bytes());
            if (needed > left()) cut_short(file_, element, needed, left());
            if (element.name == "vertex") return read_vertices(element, sink);
            if (!element.has_lists()) {
                at_ += needed;
                continue;
            }
            for (std::uint64_t i = 0; i < element.count; ++i) step_over(element, i, nullptr);
        }
        fail(file_, "has no element vertex");
    }

  private:
    std::uint64_t left() const { return static_cast<std::uint64_t>(end_ - at_); }

    PointCloud read_vertices(const Element& vertex, const CloudSink* sink) {
        const auto wanted = find_wanted(file_, vertex);
        CloudBuilder cloud(file_, vertex.count, wanted.has_normal, sink);
        // Where each property of the current vertex starts.
        std::vector<const char*> starts(vertex.properties.size());
        const bool fixed = !vertex.has_lists();
        const auto stride = vertex.least_bytes();
        for (std::uint64_t i = 0; i < vertex.count; ++i) {
            if (!fixed || i == 0) {
                step_over(vertex, i, starts.data());
            } else {
                for (auto& start : starts) start += stride;
            }
            cloud.add(load(vertex, wanted.point, starts), wanted.has_normal
                                                              ? load(vertex, wanted.normal, starts)
                                                              : std::array<double, 3>{});
        }
        return cloud.finish();
    }

    std::array<double, 3> load(const Element& vertex, const std::array<std::size_t, 3>& which,
                               const std::vector<const char*>& starts) const {
        std::array<double, 3> values;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            values[axis] =
                load_scalar(vertex.properties[which[axis]].type, starts[which[axis]], swapped_);
        }
        return values;
    }

    // Moves behind item `index` of the element; writes where its properties start, unless null.
    void step_over(const Element& element, std::uint64_t index, const char** starts) {
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

    void take(const Element& element, std::uint64_t index, std::uint64_t bytes) {
        if (bytes > left()) {
            fail(file_, "element '" + printable(element.name) + "' " + std::to_string(index) +
                            " of " + std::to_string(element.count) + " needs " +
                            counted(bytes, "more byte") + ", but " + std::to_string(left()) +
                            " are left in the file; it is cut short or damaged");
        }
        at_ += bytes;
    }

    const std::filesystem::path& file_;
    const Header& header_;
    const char* at_;
    const char* end_;
    bool swapped_;
};

}  // namespace

PointCloud parse_ply(const std::filesystem::path& file, std::string_view bytes,
                     const CloudSink* sink) {
    const auto header = HeaderParser(file, bytes).parse();
    if (header.encoding == Encoding::ascii) return read_ascii(file, bytes, header, sink);
    return BinaryReader(file, bytes, header).read(sink);
}

}  // namespace topple::io

// SPDX-License-Identifier: MIT
#include <liblzf/lzf.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "io/text.h"
#include "points/formats/cloud_builder.h"
#include "points/formats/formats.h"
#include "points/formats/point_values.h"
#include "points/formats/scalar.h"

namespace topple::io {
namespace {

enum class Data : std::uint8_t { ascii, binary, compressed };

struct Field {
    std::string name;
    std::uint64_t size = 4;
    char type = 'F';
    std::uint64_t count = 1;
    Scalar scalar = Scalar::f32;
    std::uint64_t offset = 0;  // in a point, bytes
    std::uint64_t column = 0;  // in a point, values
};

struct PcdHeader {
    std::vector<Field> fields;
    std::optional<std::uint64_t> width, height, points;
    std::array<double, 7> viewpoint{0, 0, 0, 1, 0, 0, 0};  // position, then quaternion w x y z
    Data data = Data::ascii;
    std::size_t data_offset = 0;
    std::uint64_t lines = 0;
    std::uint64_t stride = 0;   // bytes of a point
    std::uint64_t columns = 0;  // values of a point
};

// A point of more than this many values or bytes is no point.
constexpr std::uint64_t most_pcd_columns = 1'000'000, most_fields = 10'000;

std::optional<Scalar> scalar_of(char type, std::uint64_t size) {
    if (type == 'F' && size == 4) return Scalar::f32;
    if (type == 'F' && size == 8) return Scalar::f64;
    if (type != 'I' && type != 'U') return std::nullopt;
    const bool is_signed = type == 'I';
    switch (size) {
        case 1:
            return is_signed ? Scalar::i8 : Scalar::u8;
        case 2:
            return is_signed ? Scalar::i16 : Scalar::u16;
        case 4:
            return is_signed ? Scalar::i32 : Scalar::u32;
        case 8:
            return is_signed ? Scalar::i64 : Scalar::u64;
        default:
            return std::nullopt;
    }
}

class HeaderParser {
  public:
    HeaderParser(const std::filesystem::path& file, std::string_view bytes)
        : file_(file), lines_(bytes) {}

    PcdHeader parse() {
        std::string_view line;
        while (lines_.next(line)) {
            auto rest = line;
            const auto keyword = next_token(rest);
            if (keyword.empty() || keyword.front() == '#') continue;
            if (keyword == "DATA") {
                parse_data(next_token(rest));
                finish();
                return std::move(header_);
            }
            parse_line(keyword, rest);
        }
        fail(file_, "the PCD header has no DATA line (looked through " +
                        counted(lines_.number(), "line") +
                        "); the file is cut short, or no PCD file");
    }

  private:
    [[noreturn]] void bad(const std::string& message) const {
        fail(file_, "line " + std::to_string(lines_.number()) + ": " + message);
    }

    void parse_line(std::string_view keyword, std::string_view rest) {
        if (keyword == "FIELDS" || keyword == "COLUMNS") {
            parse_fields(rest);
        } else if (keyword == "SIZE" || keyword == "COUNT") {
            each_field(keyword, rest, [&](Field& field, std::string_view token) {
                // Some writers give fields of padding, "_", a COUNT of 0.
                if (keyword == "COUNT") return parse_count(token, field.count);
                return parse_count(token, field.size) && field.size > 0;
            });
        } else if (keyword == "TYPE") {
            each_field(keyword, rest, [](Field& field, std::string_view token) {
                field.type = token.front();
                return token == "F" || token == "I" || token == "U";
            });
        } else if (keyword == "WIDTH") {
            header_.width = count(keyword, rest);
        } else if (keyword == "HEIGHT") {
            header_.height = count(keyword, rest);
        } else if (keyword == "POINTS") {
            header_.points = count(keyword, rest);
        } else if (keyword == "VIEWPOINT") {
            for (auto& value : header_.viewpoint) {
                const auto token = next_token(rest);
                if (!parse_number(token, value) || !std::isfinite(value)) {
                    bad("VIEWPOINT needs 7 numbers, not " + in_quotes(token));
                }
            }
        } else if (keyword != "VERSION") {
            bad(in_quotes(keyword) + " is no PCD header keyword");
        }
    }

    void parse_fields(std::string_view rest) {
        if (!header_.fields.empty()) bad("FIELDS occurs twice");
        for (auto token = next_token(rest); !token.empty(); token = next_token(rest)) {
            if (header_.fields.size() == most_fields) bad("more than 10000 FIELDS");
            header_.fields.emplace_back();
            header_.fields.back().name = token;
        }
    }

    template <class Set>
    void each_field(std::string_view keyword, std::string_view rest, Set set) {
        const std::string name(keyword);
        if (header_.fields.empty()) bad(name + " stands before FIELDS");
        for (auto& field : header_.fields) {
            const auto token = next_token(rest);
            if (token.empty()) bad(name + " has fewer values than there are FIELDS");
            if (!set(field, token))
                bad(name + " of field " + printable(field.name) + " can't be " + in_quotes(token));
        }
        if (!next_token(rest).empty()) bad(name + " has more values than there are FIELDS");
    }

    std::uint64_t count(std::string_view keyword, std::string_view rest) const {
        std::uint64_t value = 0;
        const auto token = next_token(rest);
        if (!parse_count(token, value)) bad(std::string(keyword) + " can't be " + in_quotes(token));
        return value;
    }

    void parse_data(std::string_view token) {
        if (token == "ascii") {
            header_.data = Data::ascii;
        } else if (token == "binary") {
            header_.data = Data::binary;
        } else if (token == "binary_compressed") {
            header_.data = Data::compressed;
        } else {
            bad("DATA " + in_quotes(token) + " is none of ascii, binary, binary_compressed");
        }
    }

    // Checks what must agree, and lays out a point.
    void finish() {
        for (auto& field : header_.fields) {
            const auto scalar = scalar_of(field.type, field.size);
            if (!scalar) {
                fail(file_, "field " + printable(field.name) + " has TYPE " + field.type +
                                " and SIZE " + std::to_string(field.size) +
                                "; F may have 4 or 8, I and U 1, 2, 4 or 8");
            }
            if (field.count > most_pcd_columns ||
                header_.columns + field.count > most_pcd_columns) {
                fail(file_, "field " + printable(field.name) + " has COUNT " +
                                std::to_string(field.count) +
                                "; a point may have 1000000 values in all");
            }
            field.scalar = *scalar;
            field.offset = header_.stride;
            field.column = header_.columns;
            header_.stride += field.size * field.count;
            header_.columns += field.count;
        }
        if (!header_.points && !header_.width)
            fail(file_, "the header has neither WIDTH nor POINTS");
        if (!header_.width) header_.width = header_.points;
        if (!header_.height) header_.height = 1;
        const auto area = saturating_multiply(*header_.width, *header_.height);
        if (!header_.points) header_.points = area;
        if (area != *header_.points) {
            fail(file_, "WIDTH " + std::to_string(*header_.width) + " times HEIGHT " +
                            std::to_string(*header_.height) + " is not POINTS " +
                            std::to_string(*header_.points));
        }
        constexpr std::uint64_t most_pixels = std::numeric_limits<std::uint32_t>::max();
        if (*header_.height > 1 && area > most_pixels) {
            fail(file_, "an image of " + std::to_string(area) + " pixels is beyond the limit of " +
                            std::to_string(most_pixels));
        }
        header_.data_offset = lines_.offset();
        header_.lines = lines_.number();
    }

    const std::filesystem::path& file_;
    Lines lines_;
    PcdHeader header_;
};

// The fields to read, by place in the header.
class PcdWanted {
  public:
    PcdWanted(const std::filesystem::path& file, const PcdHeader& header)
        : file_(file), header_(header) {
        const auto find = [&](const std::string& name) { return find_field(name); };
        fields = read.take_named(file, find, "FIELDS has no ", {"normal_", "n"});
        for (const char* name : {"rgb", "rgba"}) {
            const auto found = find(name);
            if (!found || colour) continue;
            const Field& field = header.fields[*found];
            if (field.size == 4 && field.count == 1) colour = &field;
        }
        if (colour) fields.colours = ColourValues::bytes;
    }

    PointValues read;
    const Field* colour = nullptr;  // four bytes that hold 0xAARRGGBB
    CloudFields fields;

  private:
    std::optional<std::size_t> find_field(const std::string& name) const {
        std::optional<std::size_t> found;
        for (std::size_t i = 0; i < header_.fields.size(); ++i) {
            if (header_.fields[i].name != name) continue;
            if (found) fail(file_, "there are two FIELDS " + name);
            if (header_.fields[i].count == 0) fail(file_, "field " + name + " has COUNT 0");
            found = i;
        }
        return found;
    }

    const std::filesystem::path& file_;
    const PcdHeader& header_;
};

std::array<double, 3> unpacked_colour(std::uint32_t packed) {
    return {static_cast<double>(packed >> 16 & 0xFF), static_cast<double>(packed >> 8 & 0xFF),
            static_cast<double>(packed & 0xFF)};
}

// The packed colour that a text stands for: as a whole number, or as the float that has its bits.
// Of floats, programs have written either: as bits, 1 to 2^24 would be colours whose alpha is next
// to no program's.
std::uint32_t packed_colour(const Field& field, double value) {
    if (!std::isfinite(value)) return 0;
    if (field.type != 'F' || (value >= 1 && value <= 0xFFFFFF)) {
        if (value < -0x1p31 || value >= 0x1p32) return 0;
        return static_cast<std::uint32_t>(static_cast<std::int64_t>(value));
    }
    return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

[[noreturn]] void cut_short(const std::filesystem::path& file, std::uint64_t points,
                            std::uint64_t needed, std::uint64_t found) {
    fail(file, "the header promises " + counted(points, "point") + ", which need at least " +
                   std::to_string(needed) + " bytes, but " + std::to_string(found) +
                   " are left in the file; it is cut short, or its header is wrong");
}

void read_ascii(const std::filesystem::path& file, std::string_view bytes, const PcdHeader& header,
                PcdWanted& wanted, CloudBuilder& cloud) {
    Lines lines(bytes, header.data_offset, header.lines);
    const auto bad = [&](const std::string& message) {
        fail(file, "line " + std::to_string(lines.number()) + ": " + message);
    };
    // Where each value goes; null: nowhere.
    double colour = 0;
    std::vector<double*> place(header.columns, nullptr);
    for (const auto& [field, to] : wanted.read.values) place[header.fields[field].column] = to;
    if (wanted.colour) place[wanted.colour->column] = &colour;
    std::string_view line;
    while (lines.next(line)) {
        auto rest = line;
        auto token = next_token(rest);
        if (token.empty() || token.front() == '#') continue;
        if (cloud.seen() == *header.points)
            bad("more than the " + counted(*header.points, "point") + " that the header promises");
        for (std::size_t i = 0; i < place.size(); ++i) {
            if (i > 0) token = next_token(rest);
            if (token.empty())
                bad(std::to_string(i) + " of the " + counted(place.size(), "value") +
                    " that each point has");
            if (place[i] && !parse_number(token, *place[i]))
                bad(in_quotes(token) + " is not a number");
        }
        if (!next_token(rest).empty())
            bad("more than the " + counted(place.size(), "value") + " that each point has");
        if (wanted.colour)
            wanted.read.point.colour = unpacked_colour(packed_colour(*wanted.colour, colour));
        cloud.add(wanted.read.point);
    }
    if (cloud.seen() != *header.points) {
        fail(file, "the header promises " + counted(*header.points, "point") + ", the file has " +
                       std::to_string(cloud.seen()) + "; it is cut short, or its header is wrong");
    }
}

// Points one after another, or, where the data was compressed, field after field.
void read_binary(std::string_view data, const PcdHeader& header, PcdWanted& wanted, bool by_field,
                 CloudBuilder& cloud) {
    const bool swapped = must_swap(false);
    const auto points = *header.points;
    const auto bytes_at = [&](const Field& field, std::uint64_t i) {
        return data.data() + (by_field ? field.offset * points + i * field.size * field.count
                                       : i * header.stride + field.offset);
    };
    for (std::uint64_t i = 0; i < points; ++i) {
        for (const auto& [number, to] : wanted.read.values) {
            const Field& field = header.fields[number];
            *to = load_scalar(field.scalar, bytes_at(field, i), swapped);
        }
        // Its bits: as a float many a colour is no number.
        if (wanted.colour)
            wanted.read.point.colour =
                unpacked_colour(load_as<std::uint32_t>(bytes_at(*wanted.colour, i), swapped));
        cloud.add(wanted.read.point);
    }
}

// The data of a binary_compressed file: two sizes, then one LZF stream.
FileBytes decompress(const std::filesystem::path& file, std::string_view data,
                     std::uint64_t needed) {
    if (data.size() < 8) {
        fail(file, "the compressed data needs 8 bytes of sizes, but " +
                       std::to_string(data.size()) + " are left in the file; it is cut short");
    }
    const bool swapped = must_swap(false);
    const std::uint64_t packed = load_as<std::uint32_t>(data.data(), swapped);
    const std::uint64_t unpacked = load_as<std::uint32_t>(data.data() + 4, swapped);
    data.remove_prefix(8);
    if (unpacked != needed) {
        fail(file, "the points need " + counted(needed, "byte") +
                       ", but the compressed data says it holds " + std::to_string(unpacked) +
                       "; the header is wrong or the file is damaged");
    }
    if (packed > data.size()) {
        fail(file, "the compressed data has " + counted(packed, "byte") + ", but " +
                       std::to_string(data.size()) + " are left in the file; it is cut short");
    }
    // LZF's longest match makes 264 bytes of 3, so more than 88 to 1 can't be true.
    if (unpacked / 88 > packed) {
        fail(file, counted(packed, "byte") + " can't unpack to " + std::to_string(unpacked) +
                       "; the file is damaged");
    }
    FileBytes out;
    try {
        out.data = std::make_unique_for_overwrite<char[]>(unpacked);
    } catch (const std::bad_alloc&) {
        fail(file,
             "its points need " + counted(unpacked, "byte") + ", which don't fit into memory");
    }
    out.size = unpacked;
    const auto got = lzf_decompress(data.data(), static_cast<unsigned>(packed), out.data.get(),
                                    static_cast<unsigned>(unpacked));
    if (got != unpacked) {
        fail(file, "the compressed data does not unpack to the " + counted(unpacked, "byte") +
                       " that it should hold; the file is damaged");
    }
    return out;
}

void set_viewpoint(const PcdHeader& header, PointCloud& cloud) {
    const auto& v = header.viewpoint;
    const bool given = v != std::array<double, 7>{0, 0, 0, 1, 0, 0, 0};
    cloud.has_viewpoint = given || cloud.height > 1;
    if (cloud.has_viewpoint) cloud.viewpoint = {v[0], v[1], v[2]};
}

}  // namespace

PointCloud parse_pcd(const std::filesystem::path& file, std::string_view bytes,
                     const CloudSink* sink) {
    const auto header = HeaderParser(file, bytes).parse();
    PcdWanted wanted(file, header);
    const auto points = *header.points;
    if (points == 0) fail(file, "has no points (POINTS 0)");
    const auto data = bytes.substr(header.data_offset);
    const auto needed = saturating_multiply(points, header.stride);

    FileBytes unpacked;
    if (header.data == Data::ascii) {
        // Each value takes a character and a separator; the last line may lack its end.
        const auto least = saturating_multiply(points, 2 * header.columns);
        if (least > data.size() + 1) cut_short(file, points, least - 1, data.size());
    } else if (header.data == Data::binary) {
        if (needed > data.size()) cut_short(file, points, needed, data.size());
    } else {
        unpacked = decompress(file, data, needed);
    }

    CloudBuilder cloud(file, points, wanted.fields, sink);
    if (header.data == Data::ascii) {
        read_ascii(file, bytes, header, wanted, cloud);
    } else {
        const bool by_field = header.data == Data::compressed;
        read_binary(by_field ? unpacked.text() : data, header, wanted, by_field, cloud);
    }
    const bool organised = *header.height > 1;
    auto result = cloud.finish(organised ? static_cast<std::uint32_t>(*header.width) : 0,
                               organised ? static_cast<std::uint32_t>(*header.height) : 0);
    set_viewpoint(header, result);
    return result;
}

}  // namespace topple::io

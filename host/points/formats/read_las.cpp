// SPDX-License-Identifier: MIT
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "io/text.h"
#include "points/formats/cloud_builder.h"
#include "points/formats/formats.h"
#include "points/formats/scalar.h"

// LAS 1.0 to 1.4 (ASPRS). Debian has no library for it; LAZ, its compressed form, is refused.
namespace topple::io {
namespace {

// Where 32-bit coordinates resolve less than half a millimetre, the points are moved.
constexpr double near_m = 4096;
constexpr std::uint16_t least_header = 227;
// Bytes of a point of format 0 to 10.
constexpr std::array<std::uint16_t, 11> least_record{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

// Where red, green and blue begin in one of those, 16 bits each; 0: they have none.
constexpr std::array<std::uint16_t, 11> colour_at{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};

struct LasHeader {
    unsigned minor = 0, format = 0;
    std::uint64_t first = 0, record = 0, points = 0;
    std::array<double, 3> scale{}, offset{};
};

LasHeader read_header(const std::filesystem::path& file, std::string_view bytes) {
    if (bytes.size() < least_header) {
        fail(file, "is cut short: a LAS header has " + std::to_string(least_header) +
                       " bytes, the file " + std::to_string(bytes.size()));
    }
    LasHeader h;
    const unsigned major = value_at<std::uint8_t>(bytes, 24);
    h.minor = value_at<std::uint8_t>(bytes, 25);
    if (major != 1 || h.minor > 4) {
        fail(file, "is LAS " + std::to_string(major) + "." + std::to_string(h.minor) +
                       "; 1.0 to 1.4 are read");
    }
    h.first = value_at<std::uint32_t>(bytes, 96);
    h.format = value_at<std::uint8_t>(bytes, 104);
    h.record = value_at<std::uint16_t>(bytes, 105);
    h.points = value_at<std::uint32_t>(bytes, 107);
    if (h.format & 0xC0) {
        fail(file,
             "is compressed (LAZ), which only topple.parse of Python reads; unpack it to .las: "
             "python3 "
             "-m topple.formats convert FILE.laz FILE.las, or with laszip or las2las");
    }
    if (h.minor == 4) {
        if (bytes.size() < 375) fail(file, "is cut short: a LAS 1.4 header has 375 bytes");
        h.points = value_at<std::uint64_t>(bytes, 247);
    }
    if (h.format >= least_record.size()) {
        fail(file, "has points of format " + std::to_string(h.format) + "; 0 to 10 are read");
    }
    if (h.record < least_record[h.format]) {
        fail(file, "has points of " + std::to_string(h.record) + " bytes, but format " +
                       std::to_string(h.format) + " takes " +
                       std::to_string(least_record[h.format]));
    }
    if (h.first > bytes.size() ||
        saturating_multiply(h.points, h.record) > bytes.size() - h.first) {
        fail(file, "promises " + counted(h.points, "point") + " of " + std::to_string(h.record) +
                       " bytes from byte " + std::to_string(h.first) + " on, but has " +
                       counted(bytes.size(), "byte") + "; it is cut short");
    }
    for (std::size_t a = 0; a < 3; ++a) {
        h.scale[a] = value_at<double>(bytes, 131 + 8 * a);
        h.offset[a] = value_at<double>(bytes, 155 + 8 * a);
        if (!std::isfinite(h.scale[a]) || h.scale[a] == 0 || !std::isfinite(h.offset[a])) {
            fail(file, "its scale " + short_number(h.scale[a]) + " and offset " +
                           short_number(h.offset[a]) + " must be finite, the scale not 0");
        }
        // The step from the offset to the next number that there is.
        const double step = std::nextafter(std::abs(h.offset[a]), INFINITY) - std::abs(h.offset[a]);
        if (step > std::abs(h.scale[a])) {
            fail(file, "its offset " + short_number(h.offset[a]) +
                           " is so large that its scale of " + short_number(h.scale[a]) +
                           " is lost in it: points would fall together; check the header");
        }
    }
    return h;
}

}  // namespace

bool starts_as_las(std::string_view bytes) {
    return bytes.starts_with("LASF");
}

PointCloud parse_las(const std::filesystem::path& file, std::string_view bytes, double unit_m,
                     const CloudSink* sink) {
    if (!starts_as_las(bytes)) {
        fail(file, "starts with " + in_quotes(bytes.substr(0, 4)) +
                       ", where a LAS file starts with \"LASF\"");
    }
    const LasHeader h = read_header(file, bytes);
    // Coordinates are whole multiples of the scale, from an offset: nothing of it is lost in
    // doubles. As floats they must lie near the origin.
    std::array<double, 3> shift{};
    if (h.points > 0) {
        bool far = false;
        for (std::size_t a = 0; a < 3; ++a) {
            const double first =
                value_at<std::int32_t>(bytes, h.first + 4 * a) * h.scale[a] + h.offset[a];
            shift[a] = std::floor(first);
            far = far || !(std::abs(first) * unit_m <= near_m);
        }
        if (!far) shift = {};
    }
    // "Shall not be included in processing", in byte 15 of every format.
    const unsigned withheld = h.format >= 6 ? 0x04 : 0x80;
    const std::size_t colour = colour_at[h.format];
    // Full brightness should be 65535, but many programs leave it at 255.
    const ColourValues colours = colour > 0 ? ColourValues::whole : ColourValues::none;
    CloudBuilder cloud(file, h.points, {.colours = colours}, sink);
    for (std::uint64_t n = 0; n < h.points; ++n) {
        const std::size_t at = h.first + n * h.record;
        FilePoint point;
        for (std::size_t a = 0; a < 3; ++a)
            point.at[a] =
                value_at<std::int32_t>(bytes, at + 4 * a) * h.scale[a] + h.offset[a] - shift[a];
        if (value_at<std::uint8_t>(bytes, at + 15) & withheld) point.at.fill(NAN);
        for (std::size_t c = 0; colour > 0 && c < 3; ++c)
            point.colour[c] = value_at<std::uint16_t>(bytes, at + colour + 2 * c);
        cloud.add(point);
    }
    PointCloud out = cloud.finish();
    out.offset_m = shift;
    if (shift != std::array<double, 3>{})
        for (std::size_t a = 0; a < 3; ++a) out.origin_m[a] = h.offset[a] - shift[a];
    return out;
}

}  // namespace topple::io

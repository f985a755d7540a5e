// SPDX-License-Identifier: MIT
#include <bit>
#include <csetjmp>

#include "io/text.h"
#include "points/formats/frame_sequence.h"
#include "points/formats/png_reader.h"

namespace topple::io {
namespace {

bool read_depth_rows(png_structp png, png_infop info, png_bytepp rows) {
    if (setjmp(png_jmpbuf(png))) return false;
    if (std::endian::native == std::endian::little) png_set_swap(png);
    png_read_image(png, rows);
    png_read_end(png, info);
    return true;
}

const char* colour_name(int colour) {
    switch (colour) {
        case PNG_COLOR_TYPE_GRAY:
            return "grey";
        case PNG_COLOR_TYPE_GRAY_ALPHA:
            return "grey with alpha";
        case PNG_COLOR_TYPE_PALETTE:
            return "palette";
        default:
            return "colour";
    }
}

}  // namespace

std::vector<std::uint16_t> read_depth_png(const FileName& name, std::uint32_t width,
                                          std::uint32_t height) {
    const std::filesystem::path& file = name.path();
    const auto bytes = read_file(name);
    if (!starts_as_png(bytes.text())) {
        fail(file, "is no PNG file; a depth image must be a 16-bit grey PNG");
    }
    PngSource source(bytes.text());
    const PngReader reader(source);
    if (!reader.info) fail(file, "can't be read: no memory for the PNG reader");

    PngShape shape{};
    if (!read_png_shape(reader, &source, &shape)) {
        fail(file, printable(source.message, sizeof(source.message)));
    }
    if (shape.depth != 16 || shape.colour != PNG_COLOR_TYPE_GRAY) {
        fail(file, "is a " + std::to_string(shape.depth) + "-bit " + colour_name(shape.colour) +
                       " PNG; a depth image must be 16-bit grey (value / depth_scale = metres)");
    }
    if (shape.width != width || shape.height != height) {
        fail(file, "is " + std::to_string(shape.width) + " x " + std::to_string(shape.height) +
                       " pixels, but intrinsics.json says " + std::to_string(width) + " x " +
                       std::to_string(height));
    }
    std::vector<std::uint16_t> depth(std::size_t(width) * height);
    std::vector<png_bytep> rows(height);
    for (std::uint32_t v = 0; v < height; ++v) {
        rows[v] = reinterpret_cast<png_bytep>(depth.data() + std::size_t(v) * width);
    }
    if (!read_depth_rows(reader.png, reader.info, rows.data())) {
        fail(file, printable(source.message, sizeof(source.message)));
    }
    return depth;
}

}  // namespace topple::io

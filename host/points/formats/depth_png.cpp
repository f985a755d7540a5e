// SPDX-License-Identifier: MIT
#include <bit>

#include "io/text.h"
#include "points/formats/frame_sequence.h"
#include "points/formats/png_reader.h"

namespace topple::io {
namespace {

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
    PngReader png(file, bytes.text());
    if (png.depth() != 16 || png.colour() != PNG_COLOR_TYPE_GRAY) {
        fail(file, "is a " + std::to_string(png.depth()) + "-bit " + colour_name(png.colour()) +
                       " PNG; a depth image must be 16-bit grey (value / depth_scale = metres)");
    }
    if (png.width() != width || png.height() != height) {
        fail(file, "is " + size_text(png.width(), png.height()) +
                       " pixels, but intrinsics.json says " + size_text(width, height));
    }
    png.turn([](png_structp p) {
        if (std::endian::native == std::endian::little) png_set_swap(p);
        png_set_interlace_handling(p);
    });
    std::vector<std::uint16_t> depth(std::size_t(width) * height);
    png.read(depth.data(), std::size_t{2} * width);
    return depth;
}

}  // namespace topple::io

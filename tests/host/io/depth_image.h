// SPDX-License-Identifier: MIT
#pragma once

#include <png.h>

#include "standard.h"

namespace topple::test {

// A PNG in memory; `pixels` holds big-endian 16-bit or plain 8-bit samples, row by row.
inline std::string png_bytes(std::uint32_t width, std::uint32_t height, int depth, int colour,
                             const std::vector<std::uint8_t>& pixels,
                             int interlace = PNG_INTERLACE_NONE) {
    std::string out;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    if (setjmp(png_jmpbuf(png))) throw std::runtime_error("libpng can't write");
    png_set_write_fn(
        png, &out,
        [](png_structp p, png_bytep data, std::size_t size) {
            static_cast<std::string*>(png_get_io_ptr(p))
                ->append(reinterpret_cast<char*>(data), size);
        },
        nullptr);
    png_set_IHDR(png, info, width, height, depth, colour, interlace, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_color palette[1] = {{0, 0, 0}};
    if (colour == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette, 1);
    const std::size_t stride = pixels.size() / height;
    std::vector<png_bytep> rows;
    for (std::uint32_t v = 0; v < height; ++v)
        rows.push_back(const_cast<png_bytep>(pixels.data()) + v * stride);
    png_set_rows(png, info, rows.data());
    png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    png_destroy_write_struct(&png, &info);
    return out;
}

// 16-bit grey; pixel i has the value first + i.
inline std::string depth_png(std::uint32_t width, std::uint32_t height, std::uint16_t first,
                             int interlace = PNG_INTERLACE_NONE) {
    std::vector<std::uint8_t> pixels;
    for (std::uint32_t i = 0; i < width * height; ++i) {
        const auto value = static_cast<std::uint16_t>(first + i);
        pixels.push_back(static_cast<std::uint8_t>(value >> 8));
        pixels.push_back(static_cast<std::uint8_t>(value & 255));
    }
    return png_bytes(width, height, 16, PNG_COLOR_TYPE_GRAY, pixels, interlace);
}

}  // namespace topple::test

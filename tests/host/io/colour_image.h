// SPDX-License-Identifier: MIT
#pragma once

// This needs what comes before.
#include <jpeglib.h>

#include "depth_image.h"

namespace topple::test {

// 8-bit RGB; pixel (u, v) is of what `colour` returns, three bytes.
template <class Colour>
std::vector<std::uint8_t> rgb_pixels(std::uint32_t width, std::uint32_t height,
                                     const Colour& colour) {
    std::vector<std::uint8_t> out;
    for (std::uint32_t v = 0; v < height; ++v) {
        for (std::uint32_t u = 0; u < width; ++u) {
            for (const int channel : colour(u, v))
                out.push_back(static_cast<std::uint8_t>(channel));
        }
    }
    return out;
}

// A JPEG in memory of rows of `channels` bytes a pixel: 1 grey, 3 RGB, 4 CMYK.
inline std::string jpeg_bytes(std::uint32_t width, std::uint32_t height,
                              std::vector<std::uint8_t> pixels, int channels = 3,
                              bool progressive = false) {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &bytes, &size);
    jpeg.image_width = width;
    jpeg.image_height = height;
    jpeg.input_components = channels;
    jpeg.in_color_space = channels == 1 ? JCS_GRAYSCALE : channels == 3 ? JCS_RGB : JCS_CMYK;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 98, TRUE);
    if (progressive) jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    const auto stride = static_cast<std::size_t>(channels) * width;
    while (jpeg.next_scanline < height) {
        JSAMPROW row = pixels.data() + jpeg.next_scanline * stride;
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    const std::string out(reinterpret_cast<char*>(bytes), size);
    std::free(bytes);
    return out;
}

}  // namespace topple::test

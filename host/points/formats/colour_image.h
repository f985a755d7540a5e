// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

namespace topple::io {

struct ColourImage {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgb;  // sRGB, row by row, 3 bytes a pixel
};

// Called with an image's width and height before memory is taken for it; may throw.
using SizeCheck = std::function<void(std::uint32_t, std::uint32_t)>;

// PNG of any kind and JPEG, told apart by their first bytes. Alpha is not looked at. `file` is for
// messages only. Throws Error(input) where the bytes are neither, are damaged or cut short, or the
// image has more than 2^26 pixels, or far more than its file can show.
ColourImage decode_colour_image(const std::filesystem::path& file, std::string_view bytes,
                                const SizeCheck& check = nullptr);

inline constexpr std::uint64_t most_image_pixels = std::uint64_t{1} << 26;

// Its part for JPEG.
ColourImage decode_colour_jpeg(const std::filesystem::path& file, std::string_view bytes,
                               const SizeCheck& check);

}  // namespace topple::io

// SPDX-License-Identifier: MIT
#include "points/formats/colour_image.h"

#include <string>

#include "io/text.h"
#include "points/formats/png_reader.h"

namespace topple::io {
namespace {

// Pictures of rooms are packed to a tenth or twentieth; what is packed to much less shows nothing,
// or was made to fill memory. Small ones may.
std::uint64_t most_rgb_bytes(std::uint64_t file_bytes) {
    return (std::uint64_t{32} << 20) + saturating_multiply(60, file_bytes);
}

ColourImage decode_colour_png(const std::filesystem::path& file, std::string_view bytes,
                              const SizeCheck& check) {
    PngReader png(file, bytes);
    check(png.width(), png.height());
    // Whatever there is becomes 8 bits of red, green and blue.
    const std::size_t row_bytes = png.turn([](png_structp p) {
        png_set_expand(p);
        png_set_strip_16(p);
        png_set_strip_alpha(p);
        png_set_gray_to_rgb(p);
        png_set_interlace_handling(p);
    });
    if (row_bytes != std::size_t{3} * png.width()) {
        fail(file, "has rows of " + counted(row_bytes, "byte") + ", where " +
                       std::to_string(png.width()) + " pixels take 3 each; save it as RGB");
    }
    ColourImage image{png.width(), png.height(), {}};
    image.rgb.resize(row_bytes * png.height());
    png.read(image.rgb.data(), row_bytes);
    return image;
}

}  // namespace

ColourImage decode_colour_image(const std::filesystem::path& file, std::string_view bytes,
                                const SizeCheck& check) {
    const SizeCheck both = [&](std::uint32_t width, std::uint32_t height) {
        if (check) check(width, height);
        const std::string is = "is " + size_text(width, height) + " pixels, more than ";
        if (std::uint64_t{width} * height > most_image_pixels)
            fail(file, is + std::to_string(most_image_pixels) + " in all; scale it down");
        if (std::uint64_t{3} * width * height > most_rgb_bytes(bytes.size())) {
            fail(file, is + "a picture of " + counted(bytes.size(), "byte") +
                           " has; it is cut short or shows nothing");
        }
    };
    if (starts_as_png(bytes)) return decode_colour_png(file, bytes, both);
    if (bytes.starts_with("\xFF\xD8\xFF")) return decode_colour_jpeg(file, bytes, both);
    fail(file, "starts with " + in_quotes(bytes.substr(0, 4)) +
                   ", and is neither a PNG nor a JPEG; a colour image must be one of them");
}

}  // namespace topple::io

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

}  // namespace

ColourImage decode_colour_image(const std::filesystem::path& file, std::string_view bytes,
                                const SizeCheck& check) {
    const SizeCheck both = [&](std::uint32_t width, std::uint32_t height) {
        if (check) check(width, height);
        if (std::uint64_t{width} * height > most_image_pixels) {
            fail(file, "is " + std::to_string(width) + " x " + std::to_string(height) +
                           " pixels, more than " + std::to_string(most_image_pixels) +
                           " in all; scale it down");
        }
        if (std::uint64_t{3} * width * height > most_rgb_bytes(bytes.size())) {
            fail(file, "is " + std::to_string(width) + " x " + std::to_string(height) +
                           " pixels, more than a picture of " + counted(bytes.size(), "byte") +
                           " has; it is cut short or shows nothing");
        }
    };
    if (starts_as_png(bytes)) return decode_colour_png(file, bytes, both);
    if (bytes.starts_with("\xFF\xD8\xFF")) return decode_colour_jpeg(file, bytes, both);
    fail(file, "starts with " + in_quotes(bytes.substr(0, 4)) +
                   ", and is neither a PNG nor a JPEG; a colour image must be one of them");
}

}  // namespace topple::io

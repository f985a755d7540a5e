// SPDX-License-Identifier: MIT
#include "io/colour_image.h"

#include <string>

#include "io/png_reader.h"
#include "io/text.h"

namespace topple::io {

ColourImage decode_colour_image(const std::filesystem::path& file, std::string_view bytes,
                                const SizeCheck& check) {
    const SizeCheck both = [&](std::uint32_t width, std::uint32_t height) {
        if (check) check(width, height);
        if (std::uint64_t{width} * height > most_image_pixels) {
            fail(file, "is " + std::to_string(width) + " x " + std::to_string(height) +
                           " pixels, more than " + std::to_string(most_image_pixels) +
                           " in all; scale it down");
        }
    };
    if (starts_as_png(bytes)) return decode_colour_png(file, bytes, both);
    if (bytes.starts_with("\xFF\xD8\xFF")) return decode_colour_jpeg(file, bytes, both);
    fail(file, "starts with " + in_quotes(bytes.substr(0, 4)) +
                   ", and is neither a PNG nor a JPEG; a colour image must be one of them");
}

}  // namespace topple::io

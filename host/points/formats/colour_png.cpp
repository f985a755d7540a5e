// SPDX-License-Identifier: MIT
#include <string>

#include "io/text.h"
#include "points/formats/colour_image.h"
#include "points/formats/png_reader.h"

namespace topple::io {

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

}  // namespace topple::io

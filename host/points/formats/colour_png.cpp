// SPDX-License-Identifier: MIT
#include <csetjmp>
#include <string>

#include "io/text.h"
#include "points/formats/colour_image.h"
#include "points/formats/png_reader.h"

namespace topple::io {
namespace {

// Whatever there is becomes 8 bits of red, green and blue.
bool turn_to_rgb(png_structp png, png_infop info, std::size_t* row_bytes) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_expand(png);
    png_set_strip_16(png);
    png_set_strip_alpha(png);
    png_set_gray_to_rgb(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    *row_bytes = png_get_rowbytes(png, info);
    return true;
}

bool read_colour_rows(png_structp png, png_infop info, png_bytepp rows) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_read_image(png, rows);
    png_read_end(png, info);
    return true;
}

}  // namespace

ColourImage decode_colour_png(const std::filesystem::path& file, std::string_view bytes,
                              const SizeCheck& check) {
    PngSource source(bytes);
    const PngReader reader(source);
    if (!reader.info) fail(file, "can't be read: no memory for the PNG reader");
    const auto refuse = [&] { fail(file, printable(source.message, sizeof(source.message))); };
    PngShape shape{};
    if (!read_png_shape(reader, &source, &shape)) refuse();
    check(shape.width, shape.height);
    std::size_t row_bytes = 0;
    if (!turn_to_rgb(reader.png, reader.info, &row_bytes)) refuse();
    if (row_bytes != std::size_t{3} * shape.width) {
        fail(file, "has rows of " + counted(row_bytes, "byte") + ", where " +
                       std::to_string(shape.width) + " pixels take 3 each; save it as RGB");
    }
    ColourImage image{shape.width, shape.height, {}};
    image.rgb.resize(row_bytes * shape.height);
    std::vector<png_bytep> rows(shape.height);
    for (std::uint32_t v = 0; v < shape.height; ++v) rows[v] = image.rgb.data() + v * row_bytes;
    if (!read_colour_rows(reader.png, reader.info, rows.data())) refuse();
    return image;
}

}  // namespace topple::io

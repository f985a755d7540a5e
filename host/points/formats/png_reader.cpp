// SPDX-License-Identifier: MIT
#include "points/formats/png_reader.h"

#include <csetjmp>
#include <cstdio>
#include <cstring>

namespace topple::io {
namespace {

void read_bytes(png_structp png, png_bytep to, std::size_t count) {
    auto* source = static_cast<PngSource*>(png_get_io_ptr(png));
    if (count > source->left) {
        std::snprintf(source->message, sizeof(source->message),
                      "is cut short: its image data goes on after its %zu bytes", source->size);
        png_longjmp(png, 1);
    }
    std::memcpy(to, source->at, count);
    source->at += count;
    source->left -= count;
}

void on_error(png_structp png, png_const_charp message) {
    auto* source = static_cast<PngSource*>(png_get_error_ptr(png));
    std::snprintf(source->message, sizeof(source->message), "is a damaged PNG (%s)", message);
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

}  // namespace

bool starts_as_png(std::string_view bytes) {
    return bytes.size() >= 8 &&
           png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, 8) == 0;
}

PngReader::PngReader(PngSource& source)
    : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, on_error, on_warning)) {
    if (png) info = png_create_info_struct(png);
}

PngReader::~PngReader() {
    png_destroy_read_struct(&png, &info, nullptr);
}

bool read_png_shape(const PngReader& reader, PngSource* source, PngShape* shape) {
    if (setjmp(png_jmpbuf(reader.png))) return false;
    png_set_read_fn(reader.png, source, read_bytes);
    // Callers check sizes; a text chunk must not unpack to gigabytes.
    png_set_user_limits(reader.png, 0x7fffffff, 0x7fffffff);
    png_set_chunk_malloc_max(reader.png, 1 << 20);
    png_read_info(reader.png, reader.info);
    shape->width = png_get_image_width(reader.png, reader.info);
    shape->height = png_get_image_height(reader.png, reader.info);
    shape->depth = png_get_bit_depth(reader.png, reader.info);
    shape->colour = png_get_color_type(reader.png, reader.info);
    return true;
}

}  // namespace topple::io

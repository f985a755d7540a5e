// SPDX-License-Identifier: MIT
#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstring>

#include "io/frame_sequence.h"
#include "io/text.h"

// libpng reports errors by longjmp, which runs no destructors: the functions that it can jump out
// of hold plain data only, and what owns memory lives in their caller.
namespace topple::io {
namespace {

struct Source {
    const char* at;
    std::size_t left;
    std::size_t size;  // of the whole file
    char message[160];
};

void read_bytes(png_structp png, png_bytep to, std::size_t count) {
    auto* source = static_cast<Source*>(png_get_io_ptr(png));
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
    auto* source = static_cast<Source*>(png_get_error_ptr(png));
    std::snprintf(source->message, sizeof(source->message), "is a damaged PNG (%s)", message);
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

// The reader's structures, destroyed when it goes.
struct Reader {
    png_structp png = nullptr;
    png_infop info = nullptr;
    explicit Reader(Source& source)
        : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, on_error, on_warning)) {
        if (png) info = png_create_info_struct(png);
    }
    ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;
};

struct Shape {
    png_uint_32 width, height;
    int depth, colour;
};

bool read_shape(png_structp png, png_infop info, Source* source, Shape* shape) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_read_fn(png, source, read_bytes);
    // Sizes are checked against the intrinsics; a text chunk must not unpack to gigabytes.
    png_set_user_limits(png, 0x7fffffff, 0x7fffffff);
    png_set_chunk_malloc_max(png, 1 << 20);
    png_read_info(png, info);
    shape->width = png_get_image_width(png, info);
    shape->height = png_get_image_height(png, info);
    shape->depth = png_get_bit_depth(png, info);
    shape->colour = png_get_color_type(png, info);
    return true;
}

bool read_pixels(png_structp png, png_infop info, png_bytepp rows) {
    if (setjmp(png_jmpbuf(png))) return false;
    if (std::endian::native == std::endian::little) png_set_swap(png);
    png_read_image(png, rows);
    png_read_end(png, info);
    return true;
}

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

std::vector<std::uint16_t> read_depth_png(const std::filesystem::path& file, std::uint32_t width,
                                          std::uint32_t height) {
    const auto bytes = read_file(file);
    if (bytes.size < 8 ||
        png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data.get()), 0, 8) != 0) {
        fail(file, "is no PNG file; a depth image must be a 16-bit grey PNG");
    }
    Source source{bytes.data.get(), bytes.size, bytes.size, ""};
    const Reader reader(source);
    if (!reader.info) fail(file, "can't be read: no memory for the PNG reader");

    Shape shape{};
    if (!read_shape(reader.png, reader.info, &source, &shape)) {
        fail(file, printable(source.message, sizeof(source.message)));
    }
    if (shape.depth != 16 || shape.colour != PNG_COLOR_TYPE_GRAY) {
        fail(file, "is a " + std::to_string(shape.depth) + "-bit " + colour_name(shape.colour) +
                       " PNG; a depth image must be 16-bit grey (value / depth_scale = metres)");
    }
    if (shape.width != width || shape.height != height) {
        fail(file, "is " + std::to_string(shape.width) + " x " + std::to_string(shape.height) +
                       " pixels, but intrinsics.json says " + std::to_string(width) + " x " +
                       std::to_string(height));
    }
    std::vector<std::uint16_t> depth(std::size_t(width) * height);
    std::vector<png_bytep> rows(height);
    for (std::uint32_t v = 0; v < height; ++v) {
        rows[v] = reinterpret_cast<png_bytep>(depth.data() + std::size_t(v) * width);
    }
    if (!read_pixels(reader.png, reader.info, rows.data())) {
        fail(file, printable(source.message, sizeof(source.message)));
    }
    return depth;
}

}  // namespace topple::io

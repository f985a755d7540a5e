// SPDX-License-Identifier: MIT
#include "points/formats/png_reader.h"

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <vector>

#include "io/text.h"

namespace topple::io {

bool starts_as_png(std::string_view bytes) {
    return bytes.size() >= 8 &&
           png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, 8) == 0;
}

void PngReader::give_bytes(png_structp png, png_bytep to, std::size_t count) {
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

void PngReader::on_error(png_structp png, png_const_charp message) {
    auto* source = static_cast<Source*>(png_get_error_ptr(png));
    std::snprintf(source->message, sizeof(source->message), "is a damaged PNG (%s)", message);
    png_longjmp(png, 1);
}

// Whether the library jumped out of the step, which then has set the message.
template <class Step>
bool PngReader::jumps(Step step) {
    if (setjmp(png_jmpbuf(png_))) return true;
    step(this);
    return false;
}

void PngReader::refuse() const {
    fail(file_, printable(source_.message, sizeof(source_.message)));
}

PngReader::PngReader(const std::filesystem::path& file, std::string_view bytes)
    : file_(file),
      source_{bytes.data(), bytes.size(), bytes.size(), ""},
      png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &source_, on_error,
                                  [](png_structp, png_const_charp) {})) {
    if (png_) info_ = png_create_info_struct(png_);
    const bool failed = info_ && jumps([](PngReader* r) {
                            png_set_read_fn(r->png_, &r->source_, give_bytes);
                            // Callers check sizes; a text chunk must not unpack to gigabytes.
                            png_set_user_limits(r->png_, 0x7fffffff, 0x7fffffff);
                            png_set_chunk_malloc_max(r->png_, 1 << 20);
                            png_read_info(r->png_, r->info_);
                            r->width_ = png_get_image_width(r->png_, r->info_);
                            r->height_ = png_get_image_height(r->png_, r->info_);
                            r->depth_ = png_get_bit_depth(r->png_, r->info_);
                            r->colour_ = png_get_color_type(r->png_, r->info_);
                        });
    if (info_ && !failed) return;
    png_destroy_read_struct(&png_, &info_, nullptr);
    if (!failed) fail(file, "can't be read: no memory for the PNG reader");
    refuse();
}

PngReader::~PngReader() {
    png_destroy_read_struct(&png_, &info_, nullptr);
}

std::size_t PngReader::turn(Turn how) {
    turn_ = how;
    const auto step = [](PngReader* r) {
        r->turn_(r->png_);
        png_read_update_info(r->png_, r->info_);
    };
    if (jumps(step)) refuse();
    return png_get_rowbytes(png_, info_);
}

void PngReader::read(void* to, std::size_t row_bytes) {
    std::vector<png_bytep> rows(height_);
    for (png_uint_32 v = 0; v < height_; ++v) rows[v] = static_cast<png_bytep>(to) + v * row_bytes;
    rows_ = rows.data();
    const auto step = [](PngReader* r) {
        png_read_image(r->png_, r->rows_);
        png_read_end(r->png_, r->info_);
    };
    if (jumps(step)) refuse();
}

}  // namespace topple::io

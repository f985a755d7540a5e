// SPDX-License-Identifier: MIT
#pragma once

#include <png.h>

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace topple::io {

bool starts_as_png(std::string_view bytes);

// What the readers of PNG files share. libpng reports errors by longjmp, which runs no destructors:
// what it can jump out of holds plain data only, and what owns memory lives in the callers of this.
// Throws Error(input) naming the file.
class PngReader {
  public:
    // Reads up to the pixels. bytes: the whole file; they must stay.
    PngReader(const std::filesystem::path& file, std::string_view bytes);
    ~PngReader();
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    png_uint_32 width() const { return width_; }
    png_uint_32 height() const { return height_; }
    int depth() const { return depth_; }    // bits of a channel
    int colour() const { return colour_; }  // PNG_COLOR_TYPE_...

    // Has the library turn the pixels into others; returns the bytes of a row of them.
    using Turn = void (*)(png_structp);
    std::size_t turn(Turn how);
    // The pixels, row by row.
    void read(void* to, std::size_t row_bytes);

  private:
    struct Source {
        const char* at;
        std::size_t left, size;  // size: of the whole file
        char message[160];
    };
    static void give_bytes(png_structp png, png_bytep to, std::size_t count);
    static void on_error(png_structp png, png_const_charp message);
    template <class Step>
    bool jumps(Step step);
    [[noreturn]] void refuse() const;

    const std::filesystem::path& file_;
    Source source_;
    png_structp png_;
    png_infop info_ = nullptr;
    png_uint_32 width_ = 0, height_ = 0;
    int depth_ = 0, colour_ = 0;
    Turn turn_ = nullptr;        // of the step that runs,
    png_bytepp rows_ = nullptr;  // as these
};

}  // namespace topple::io

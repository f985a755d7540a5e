// SPDX-License-Identifier: MIT
#pragma once

#include <png.h>

#include <cstddef>
#include <string_view>

// What the readers of PNG files share. libpng reports errors by longjmp, which runs no destructors:
// the functions that it can jump out of hold plain data only, and what owns memory lives in their
// caller.
namespace topple::io {

bool starts_as_png(std::string_view bytes);

struct PngSource {
    explicit PngSource(std::string_view bytes)
        : at(bytes.data()), left(bytes.size()), size(bytes.size()) {}
    const char* at;
    std::size_t left;
    std::size_t size;  // of the whole file
    char message[160] = "";
};

// libpng's structures, destroyed when it goes. Its errors jump, with the source's message set.
struct PngReader {
    png_structp png = nullptr;
    png_infop info = nullptr;  // null: there was no memory
    explicit PngReader(PngSource& source);
    ~PngReader();
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;
};

struct PngShape {
    png_uint_32 width, height;
    int depth, colour;
};

// Reads up to the pixels; false: the source's message says why not.
bool read_png_shape(const PngReader& reader, PngSource* source, PngShape* shape);

}  // namespace topple::io

// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/colour_space.h"

// Drawing without a display, by cairo.
namespace topple::report {

struct Colour {
    double red = 0, green = 0, blue = 0;  // 0 to 1, sRGB
};
Colour colour(const Rgb8& bytes);

// Pixels, row by row from the top.
struct Raster {
    int width = 0, height = 0;
    std::vector<Colour> pixels;
    Raster(int w, int h, const Colour& fill)
        : width(w), height(h), pixels(static_cast<std::size_t>(w) * h, fill) {}
    Colour& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
};

enum class Align { left, middle, right };
struct Font {
    double size = 13;
    bool bold = false;
    bool upright = false;  // turned to read from below
    Colour colour{0.1, 0.1, 0.1};
};

// A white page; x to the right and y downwards from the upper left corner, in pixels.
class Canvas {
  public:
    // A .svg is drawn as shapes, any other name as PNG. Throws Error(input) where it can't be made.
    Canvas(const std::filesystem::path& path, int width, int height);
    ~Canvas();
    Canvas(Canvas&&) noexcept;

    void rectangle(double x, double y, double width, double height, const Colour& fill);
    void line(double x0, double y0, double x1, double y1, const Colour& colour, double width = 1);
    void disc(double x, double y, double radius, const Colour& fill);
    // `y` is the base line.
    void text(double x, double y, const std::string& text, Align align, const Font& font = {});
    double text_width(const std::string& text, const Font& font) const;
    // The raster's upper left corner.
    void image(double x, double y, const Raster& raster);
    // Writes the file. Throws Error(input) where it can't be written.
    void save();

  private:
    struct Page;
    std::unique_ptr<Page> page_;
};

}  // namespace topple::report

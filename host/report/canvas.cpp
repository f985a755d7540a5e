// SPDX-License-Identifier: MIT
#include "report/canvas.h"

#include <cairo-svg.h>
#include <cairo.h>

#include <new>
#include <numbers>

#include "io/replace_file.h"
#include "io/text.h"

namespace topple::report {
namespace {

std::uint32_t packed(const Colour& c) {
    return std::uint32_t{channel_byte(c.red)} << 16 | std::uint32_t{channel_byte(c.green)} << 8 |
           channel_byte(c.blue);
}

}  // namespace

struct Canvas::Page {
    std::filesystem::path path;
    bool svg;
    std::string written;
    cairo_surface_t* surface;
    cairo_t* context;

    Page(const std::filesystem::path& file, int width, int height)
        : path(file),
          svg(file.extension() == ".svg"),
          surface(svg ? cairo_svg_surface_create_for_stream(append, this, width, height)
                      : cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)),
          context(cairo_create(surface)) {
        if (svg) cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PX);
    }
    Page(const Page&) = delete;
    Page& operator=(const Page&) = delete;
    ~Page() {
        cairo_destroy(context);
        cairo_surface_destroy(surface);
    }
    void check(cairo_status_t status) const {
        if (status == CAIRO_STATUS_SUCCESS) return;
        if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
        io::fail(path, std::string("can't be drawn: ") + cairo_status_to_string(status));
    }
    static cairo_status_t append(void* page, const unsigned char* bytes, unsigned count) {
        try {
            static_cast<Page*>(page)->written.append(reinterpret_cast<const char*>(bytes), count);
        } catch (const std::bad_alloc&) {
            return CAIRO_STATUS_NO_MEMORY;
        }
        return CAIRO_STATUS_SUCCESS;
    }
    void choose(const Font& font) const {
        cairo_select_font_face(context, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                               font.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
        cairo_set_font_size(context, font.size);
    }
    double advance(const std::string& text) const {
        cairo_text_extents_t extents;
        cairo_text_extents(context, text.c_str(), &extents);
        return extents.x_advance;
    }
    void use(const Colour& c) const { cairo_set_source_rgb(context, c.red, c.green, c.blue); }
};

Colour colour(const Rgb8& bytes) {
    return {bytes[0] / 255.0, bytes[1] / 255.0, bytes[2] / 255.0};
}

Canvas::Canvas(const std::filesystem::path& path, int width, int height)
    : page_(std::make_unique<Page>(path, width, height)) {
    page_->check(cairo_surface_status(page_->surface));
    rectangle(0, 0, width, height, {1, 1, 1});
}

Canvas::~Canvas() = default;
Canvas::Canvas(Canvas&&) noexcept = default;

void Canvas::rectangle(double x, double y, double width, double height, const Colour& fill) {
    page_->use(fill);
    cairo_rectangle(page_->context, x, y, width, height);
    cairo_fill(page_->context);
}

void Canvas::line(double x0, double y0, double x1, double y1, const Colour& colour, double width) {
    page_->use(colour);
    cairo_set_line_width(page_->context, width);
    cairo_move_to(page_->context, x0, y0);
    cairo_line_to(page_->context, x1, y1);
    cairo_stroke(page_->context);
}

void Canvas::disc(double x, double y, double radius, const Colour& fill) {
    page_->use(fill);
    cairo_arc(page_->context, x, y, radius, 0, 2 * std::numbers::pi);
    cairo_fill(page_->context);
}

void Canvas::text(double x, double y, const std::string& text, Align align, const Font& font) {
    cairo_t* const c = page_->context;
    page_->use(font.colour);
    page_->choose(font);
    const double share = align == Align::left ? 0 : align == Align::middle ? 0.5 : 1;
    cairo_save(c);
    cairo_translate(c, x, y);
    if (font.upright) cairo_rotate(c, -std::numbers::pi / 2);
    cairo_move_to(c, -share * page_->advance(text), 0);
    cairo_show_text(c, text.c_str());
    cairo_restore(c);
}

double Canvas::text_width(const std::string& text, const Font& font) const {
    page_->choose(font);
    return page_->advance(text);
}

void Canvas::image(double x, double y, const Raster& raster) {
    cairo_surface_t* const pixels =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, raster.width, raster.height);
    unsigned char* const data = cairo_image_surface_get_data(pixels);
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(pixels));
    for (int row = 0; data && row < raster.height; ++row) {
        auto* const to =
            reinterpret_cast<std::uint32_t*>(data + static_cast<std::size_t>(row) * stride);
        for (int n = 0; n < raster.width; ++n)
            to[n] = packed(raster.pixels[static_cast<std::size_t>(row) * raster.width + n]);
    }
    cairo_surface_mark_dirty(pixels);
    cairo_set_source_surface(page_->context, pixels, x, y);
    cairo_paint(page_->context);
    cairo_surface_destroy(pixels);
}

void Canvas::save() {
    page_->check(cairo_status(page_->context));
    if (!page_->svg)
        page_->check(cairo_surface_write_to_png_stream(page_->surface, Page::append, page_.get()));
    cairo_surface_finish(page_->surface);
    page_->check(cairo_surface_status(page_->surface));
    io::replace_file(page_->path, page_->written);
}

}  // namespace topple::report

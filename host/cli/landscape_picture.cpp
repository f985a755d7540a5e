// SPDX-License-Identifier: MIT
#include "cli/landscape_picture.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "core/vectors.h"
#include "report/canvas.h"
#include "report/drawing.h"

namespace topple::cli {
namespace {

using report::Canvas;
using report::Colour;
using report::Drawing;
using report::Point;

constexpr double scale = 2, margin = 24, gap = 30;
constexpr Colour ink{0.11, 0.13, 0.15}, accent{0.08, 0.33, 0.6}, white{1, 1, 1};

struct Paint {
    Colour line, fill;
    double width;
};
Paint paint_of(Drawing::Style style) {
    using enum Drawing::Style;
    if (style == axis) return {{0.67, 0.7, 0.73}, white, 1};
    if (style == curve) return {accent, white, 2};
    if (style == lowest) return {{0.79, 0.17, 0.17}, {1, 0.82, 0.24}, 2};
    if (style == now) return {accent, {1, 0.95, 0.84}, 2};
    return {ink, white, 1};
}

// Draws one drawing with its upper left corner at a place.
class Painter {
  public:
    Painter(Canvas& canvas, const Drawing& drawing, double x, double y)
        : canvas_(canvas), d_(drawing), x_(x), y_(y) {}

    void paint() {
        if (d_.sphere) paint_sphere(*d_.sphere);
        if (d_.raster) paint_raster(*d_.raster);
        for (const Drawing::Swatch& s : d_.swatches) {
            const Point at = place(s.corner);
            canvas_.rectangle(at[0], at[1], scale * s.width, scale * s.height,
                              report::colour(s.colour));
        }
        for (const Drawing::Stroke& stroke : d_.strokes) {
            const Paint with = paint_of(stroke.style);
            for (std::size_t n = 0; n + 1 < stroke.points.size(); ++n) {
                const Point a = place(stroke.points[n]), b = place(stroke.points[n + 1]);
                canvas_.line(a[0], a[1], b[0], b[1], with.line, scale * with.width);
            }
        }
        for (const Drawing::Dot& dot : d_.dots) {
            const Paint with = paint_of(dot.style);
            const Point at = place(dot.at);
            const Colour rim = dot.style == Drawing::Style::lowest ? ink : with.line;
            canvas_.disc(at[0], at[1], scale * (dot.radius + 0.5 * with.width), rim);
            canvas_.disc(at[0], at[1], scale * (dot.radius - 0.5 * with.width), with.fill);
        }
        for (const Drawing::Label& label : d_.labels) {
            const Point at = place(label.at);
            constexpr report::Align align[]{report::Align::left, report::Align::middle,
                                            report::Align::right};
            canvas_.text(at[0], at[1], label.text, align[static_cast<std::size_t>(label.anchor)],
                         {.size = 11 * scale, .bold = label.strong});
        }
    }

  private:
    Point place(const Point& p) const { return {x_ + scale * p[0], y_ + scale * p[1]}; }

    // A square of pixels; colour(row, column, side) of each.
    template <class ColourOf>
    void paint_square(const Point& corner, double size, const ColourOf& colour) {
        const int side = static_cast<int>(scale * size);
        report::Raster raster(side, side, white);
        for (int row = 0; row < side; ++row)
            for (int column = 0; column < side; ++column)
                raster.at(column, row) = colour(row, column, side);
        const Point at = place(corner);
        canvas_.image(at[0], at[1], raster);
    }

    void paint_sphere(const Drawing::Sphere& s) {
        const auto colour = [&](int row, int column, int side) {
            const Point at{(column + 0.5) / side * 2 - 1, (row + 0.5) / side * 2 - 1};
            if (at[0] * at[0] + at[1] * at[1] > 1) return white;
            const Vec3 d = report::direction_at(at);
            double height = -1e300;
            for (const Vec3& v : s.corners) height = std::max(height, -dot(v, d));
            const double share = (height - s.lowest_m) / std::max(s.highest_m - s.lowest_m, 1e-9);
            const double band =
                std::clamp(std::floor(share * report::bands), 0.0, report::bands - 1.0);
            return report::colour(report::ramp_colour((band + 0.5) / report::bands));
        };
        paint_square({s.middle[0] - s.radius, s.middle[1] - s.radius}, 2 * s.radius, colour);
    }

    void paint_raster(const Drawing::Raster& r) {
        paint_square(r.corner, r.size, [&](int row, int column, int side) {
            const int at = (row * r.side / side) * r.side + column * r.side / side;
            return report::colour(r.palette[r.code[static_cast<std::size_t>(at)]]);
        });
    }

    Canvas& canvas_;
    const Drawing& d_;
    double x_, y_;
};

std::vector<std::string> lines_of(const std::string& text, std::size_t longest) {
    std::vector<std::string> lines{""};
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (!lines.back().empty() && lines.back().size() + 1 + word.size() > longest)
            lines.emplace_back();
        if (!lines.back().empty()) lines.back().append(" ");
        lines.back().append(word);
    }
    return lines;
}

}  // namespace

void draw_landscape(const Scene& scene, const Object& object, const std::filesystem::path& path) {
    const std::vector<Drawing> drawings = report::landscape_drawings(scene, object);
    const std::vector<std::string> text = lines_of(object.why.sentence, 95);
    const double head = margin + scale * (20 + 17 * static_cast<double>(text.size())) + gap;
    // Two in a row.
    double width = 0, height = head;
    std::vector<std::array<double, 2>> corner;
    for (std::size_t n = 0; n < drawings.size(); n += 2) {
        double tallest = 0, x = margin;
        for (std::size_t m = n; m < std::min(n + 2, drawings.size()); ++m) {
            corner.push_back({x, height});
            x += scale * drawings[m].width + gap;
            tallest = std::max(tallest, scale * drawings[m].height);
        }
        width = std::max(width, x);
        height += tallest + scale * 20 + gap;
    }
    Canvas canvas(path, static_cast<int>(std::max(width, scale * 2 * 330 + gap + 2 * margin)),
                  static_cast<int>(height));
    canvas.text(margin, margin + scale * 14, "Object " + std::to_string(object.id),
                report::Align::left, {.size = 16 * scale, .bold = true});
    for (std::size_t n = 0; n < text.size(); ++n) {
        canvas.text(margin, margin + scale * (36 + 17 * static_cast<double>(n)), text[n],
                    report::Align::left, {.size = 13 * scale});
    }
    for (std::size_t n = 0; n < drawings.size(); ++n) {
        const auto [x, y] = corner[n];
        canvas.text(x, y + scale * 12, drawings[n].title, report::Align::left,
                    {.size = 13 * scale, .bold = true});
        Painter(canvas, drawings[n], x, y + scale * 20).paint();
    }
    canvas.save();
}

}  // namespace topple::cli

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "lab/evaluation/pictures.h"
#include "lab/evaluation/tables.h"
#include "report/canvas.h"

namespace topple::evaluation {
namespace {

using report::Align;
using report::Canvas;
using report::Colour;
using scenes::SegmentationScore;

// Colours that are told apart in grey and by the colour-blind, too (Okabe and Ito).
constexpr Colour orange{0.90, 0.62, 0.0}, blue{0.0, 0.45, 0.70}, green{0.0, 0.62, 0.45},
    grey{0.85, 0.85, 0.85}, dark{0.25, 0.25, 0.25};

std::string number(double value, const char* format) {
    char digits[32];
    std::snprintf(digits, sizeof(digits), format, value);
    return digits;
}

struct Method {
    const char* name;
    SegmentationScore RoomScore::*score;
    Colour colour;
};
struct Measure {
    const char* name;
    double SegmentationScore::*value;
};
constexpr Measure measures[] = {{"cut discrepancy", &SegmentationScore::cut_discrepancy},
                                {"Hamming", &SegmentationScore::hamming},
                                {"missing", &SegmentationScore::missing},
                                {"false alarm", &SegmentationScore::false_alarm}};

// A plot's rectangle on the page and the values at its upper and lower edge.
struct Axes {
    double x, y, width, height, top_value;
    double at(double value) const { return y + height * (1 - value / top_value); }
};

void draw_grid(Canvas& canvas, const Axes& a, double step) {
    for (int n = 0; n * step <= a.top_value * 1.0001; ++n) {
        const double at = a.at(n * step);
        canvas.line(a.x, at, a.x + a.width, at, grey);
        canvas.text(a.x - 8, at + 4, number(n * step, "%.2g"), Align::right);
    }
}

void draw_bars(Canvas& canvas, const Axes& a, const std::vector<RoomScore>& rooms,
               const std::vector<Method>& methods) {
    const double group = a.width / static_cast<double>(std::size(measures));
    const double bar = 0.8 * group / static_cast<double>(methods.size());
    for (std::size_t g = 0; g < std::size(measures); ++g) {
        const double left = a.x + group * (static_cast<double>(g) + 0.1);
        for (std::size_t m = 0; m < methods.size(); ++m) {
            const Spread s = spread(rooms, [&](const RoomScore& r) {
                return (r.*methods[m].score).*measures[g].value;
            });
            const double x = left + bar * static_cast<double>(m);
            canvas.rectangle(x + 1, a.at(s.median), bar - 2, a.at(0) - a.at(s.median),
                             methods[m].colour);
            canvas.line(x + bar / 2, a.at(s.least), x + bar / 2, a.at(s.greatest), dark, 1.5);
            canvas.text(x + bar / 2, a.at(s.greatest) - 5, number(s.median, "%.3f"), Align::middle,
                        {.size = 10});
        }
        canvas.text(left + 0.4 * group, a.y + a.height + 20, measures[g].name, Align::middle);
    }
    canvas.line(a.x, a.at(0), a.x + a.width, a.at(0), dark, 1.5);
}

void draw_legend(Canvas& canvas, double x, double y, const std::vector<Method>& methods) {
    for (const Method& m : methods) {
        canvas.rectangle(x, y - 11, 12, 12, m.colour);
        canvas.text(x + 18, y, m.name, Align::left);
        x += 110;
    }
}

double greatest(const std::vector<RoomScore>& rooms, const std::vector<Method>& methods) {
    double most = 0.01;
    for (const Method& m : methods) {
        for (const Measure& v : measures) {
            for (const RoomScore& r : rooms) most = std::max(most, (r.*m.score).*v.value);
        }
    }
    return most;
}

}  // namespace

void draw_segmentation_chart(const std::vector<RoomScore>& rooms,
                             const std::filesystem::path& path) {
    const std::vector<Method> by_object{{"regions", &RoomScore::objects_by_region, orange},
                                        {"primitives", &RoomScore::objects_by_primitive, blue},
                                        {"objects", &RoomScore::objects_by_object, green}};
    const std::vector<Method> by_part{{"regions", &RoomScore::parts_by_region, orange},
                                      {"primitives", &RoomScore::parts_by_primitive, blue}};
    Canvas canvas(path, 1120, 440);
    const double most = std::max(greatest(rooms, by_object), greatest(rooms, by_part));
    const double step = most > 0.5 ? 0.2 : most > 0.2 ? 0.1 : 0.05;
    const double top = step * std::ceil(1.08 * most / step);
    const auto panel = [&](double x, double width, const std::string& title, const auto& methods) {
        canvas.text(x, 28, title, Align::left, {.size = 15, .bold = true});
        draw_legend(canvas, x, 54, methods);
        const Axes axes{x, 74, width, 310, top};
        draw_grid(canvas, axes, step);
        draw_bars(canvas, axes, rooms, methods);
    };
    panel(60, 580,
          "Errors against true objects: median and range of " + std::to_string(rooms.size()) +
              " rooms",
          by_object);
    panel(700, 400, "Errors against true parts", by_part);
    canvas.save();
}

void draw_volume_chart(const std::vector<RoomScore>& rooms, const std::filesystem::path& path) {
    struct Cloud {
        const char* name;
        scenes::VolumeScore RoomScore::*score;
        PaperFigures::Volume paper;
        Colour colour;
    };
    const Cloud clouds[] = {
        {"surface alone", &RoomScore::surface, PaperFigures::surface, orange},
        {"invisible space", &RoomScore::invisible, PaperFigures::invisible, blue},
        {"after filling", &RoomScore::completed, PaperFigures::completed, green}};
    Canvas canvas(path, 640, 560);
    canvas.text(70, 28, "Volume: precision against recall", Align::left,
                {.size = 15, .bold = true});
    const Axes axes{70, 80, 540, 410, 1};
    draw_grid(canvas, axes, 0.1);
    const auto at_recall = [&](double recall) { return axes.x + axes.width * recall; };
    for (int n = 0; n <= 10; ++n) {
        canvas.line(at_recall(n / 10.0), axes.y, at_recall(n / 10.0), axes.y + axes.height, grey);
        canvas.text(at_recall(n / 10.0), axes.y + axes.height + 20, number(n / 10.0, "%.1f"),
                    Align::middle);
    }
    canvas.text(axes.x + axes.width / 2, 540, "recall", Align::middle);
    canvas.text(22, axes.y + axes.height / 2, "precision", Align::middle, {.upright = true});
    double x = axes.x;
    for (const Cloud& cloud : clouds) {
        canvas.disc(x + 6, 52, 5, cloud.colour);
        canvas.text(x + 18, 56, cloud.name, Align::left);
        x += 135;
        for (const RoomScore& r : rooms) {
            const scenes::VolumeScore& s = r.*cloud.score;
            if (std::isnan(s.precision.value) || std::isnan(s.recall.value)) continue;
            canvas.disc(at_recall(s.recall.value), axes.at(s.precision.value), 4, cloud.colour);
        }
        canvas.target(at_recall(cloud.paper.recall), axes.at(cloud.paper.precision), 6,
                      cloud.colour);
    }
    canvas.target(x + 6, 52, 5, dark);
    canvas.text(x + 20, 56, "the paper", Align::left);
    canvas.save();
}

}  // namespace topple::evaluation

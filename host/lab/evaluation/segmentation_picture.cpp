// SPDX-License-Identifier: MIT
#include "lab/evaluation/segmentation_picture.h"

#include <array>
#include <cmath>

#include "core/number_text.h"
#include "io/text.h"
#include "lab/evaluation/tables.h"

namespace topple::evaluation {
namespace {

using scenes::SegmentationScore;

struct Method {
    const char *name, *colour;
    SegmentationScore RoomScore::*score;
};
constexpr std::array methods{
    Method{"region growing", "#b9b9b9", &RoomScore::objects_by_region},
    Method{"primitives (geometry)", "#7aa6c2", &RoomScore::objects_by_primitive},
    Method{"objects (physics)", "#1b6ca8", &RoomScore::objects_by_object}};
struct ErrorShown {
    const char* name;
    double SegmentationScore::*value;
};
constexpr std::array errors_shown{
    ErrorShown{"cut discrepancy", &SegmentationScore::cut_discrepancy},
    ErrorShown{"Hamming", &SegmentationScore::hamming},
    ErrorShown{"missing", &SegmentationScore::missing},
    ErrorShown{"false alarm", &SegmentationScore::false_alarm}};

std::string label(double x, double y, const char* anchor, const std::string& says) {
    return "<text x='" + io::short_number(x) + "' y='" + io::short_number(y) + "' text-anchor='" +
           anchor + "'>" + says + "</text>\n";
}
std::string bar(double x, double y, double wide, double tall, const char* colour) {
    return "<rect x='" + io::short_number(x) + "' y='" + io::short_number(y) + "' width='" +
           io::short_number(wide) + "' height='" + io::short_number(tall) + "' fill='" + colour +
           "'/>\n";
}

}  // namespace

std::string segmentation_picture(const std::vector<RoomScore>& rooms) {
    constexpr double left = 50, foot = 300, tall = 220, group = 130, wide = 34;  // pixels
    std::string out =
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 580 350' font-family='sans-serif' "
        "font-size='13'>\n<rect width='580' height='350' fill='#fff'/>\n";
    for (std::size_t w = 0; w < methods.size(); ++w) {
        const double x = left + 180 * static_cast<double>(w);
        out += bar(x, 18, 12, 12, methods[w].colour) + label(x + 18, 29, "start", methods[w].name);
    }
    for (int tenth = 0; tenth <= 10; tenth += 2) {
        const double y = foot - tall * tenth / 10;
        out += bar(left, y, 4 * group, 1, "#ddd") +
               label(left - 8, y + 4, "end", io::short_number(tenth / 10.0));
    }
    for (std::size_t m = 0; m < errors_shown.size(); ++m) {
        const double x = left + group * static_cast<double>(m) + 14;
        for (std::size_t w = 0; w < methods.size(); ++w) {
            const double error = spread(rooms, [&](const RoomScore& room) {
                                     return room.*methods[w].score.*errors_shown[m].value;
                                 }).median;
            const double at = x + wide * static_cast<double>(w);
            if (std::isnan(error)) continue;
            const double high = tall * std::min(error, 1.0);
            out += bar(at, foot - high, wide - 3, high, methods[w].colour) +
                   label(at + (wide - 3) / 2, foot - high - 4, "middle", to_places(error, 2));
        }
        out += label(x + 1.5 * wide, foot + 20, "middle", errors_shown[m].name);
    }
    return out + label(left, foot + 42, "start", "Medians over the rooms; less is better.") +
           "</svg>\n";
}

}  // namespace topple::evaluation

// SPDX-License-Identifier: MIT
#include "lab/evaluation/tables.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "lab/evaluation/text.h"

namespace topple::evaluation {
namespace {

using scenes::SegmentationScore;
using scenes::Share;
using scenes::VolumeScore;

void add_segmentation(const std::vector<RoomScore>& rooms, const char* name,
                      SegmentationScore RoomScore::*which, std::string& text) {
    append(text, "  %-18s", name);
    for (double SegmentationScore::*measure :
         {&SegmentationScore::cut_discrepancy, &SegmentationScore::hamming,
          &SegmentationScore::missing, &SegmentationScore::false_alarm}) {
        const Spread s = spread(rooms, [&](const RoomScore& r) { return r.*which.*measure; });
        append(text, "  %6.3f %6.3f", s.median, s.greatest);
    }
    const Spread s = spread(rooms, [&](const RoomScore& r) { return (r.*which).miou; });
    append(text, "  %6.3f %6.3f\n", s.median, s.least);
}

void add_volume(const std::vector<RoomScore>& rooms, const char* name,
                VolumeScore RoomScore::*which, const PaperFigures::Volume& paper,
                std::string& text) {
    append(text, "  %-18s", name);
    const auto add = [&](Share VolumeScore::*measure, double in_paper) {
        const Spread s =
            spread(rooms, [&](const RoomScore& r) { return (r.*which.*measure).value; });
        append(text, "  %7s %7s %7s", percent(s.median).c_str(), percent(s.least).c_str(),
               percent(in_paper).c_str());
    };
    add(&VolumeScore::precision, paper.precision);
    add(&VolumeScore::recall, paper.recall);
    text.append("\n");
}

void add_relations(const std::vector<RoomScore>& rooms, const char* name,
                   Share scenes::RelationScore::*recall, Share scenes::RelationScore::*precision,
                   double paper, double greedy, std::string& text) {
    append(text, "  %-18s", name);
    for (Share scenes::RelationScore::*measure : {recall, precision}) {
        const Spread s =
            spread(rooms, [&](const RoomScore& r) { return (r.relations.*measure).value; });
        append(text, "  %7s %7s", percent(s.median).c_str(), percent(s.least).c_str());
    }
    append(text, "  %7s %7s\n", percent(paper).c_str(), percent(greedy).c_str());
}

void add_rooms(const std::vector<RoomScore>& rooms, std::string& text) {
    text.append(
        "\nEach room (errors as shares, the rest in percent; r recall, p precision)\n"
        "  seed  parts   points  mIoU  Hamming  cuts  volume p   r  fixed r   p  support r   p  "
        "up, deg    s\n");
    for (const RoomScore& r : rooms) {
        append(text, "  %4llu  %5zu  %7zu  %4s  %7.3f %5.3f  %8s %4s",
               static_cast<unsigned long long>(r.seed), r.parts, r.points,
               percent(r.parts_by_primitive.miou).c_str(), r.parts_by_primitive.hamming,
               r.parts_by_primitive.cut_discrepancy, percent(r.completed.precision.value).c_str(),
               percent(r.completed.recall.value).c_str());
        append(text, "  %6s %4s  %8s %4s  %7.3f %5.1f\n",
               percent(r.relations.fixed_recall.value).c_str(),
               percent(r.relations.fixed_precision.value).c_str(),
               percent(r.relations.support_recall.value).c_str(),
               percent(r.relations.support_precision.value).c_str(), r.gravity_deg, r.parse_s);
    }
}

using Columns = std::vector<std::pair<std::string, double>>;

void add(Columns& columns, const std::string& name, const scenes::SegmentationScore& s) {
    columns.emplace_back(name + "_cut_discrepancy", s.cut_discrepancy);
    columns.emplace_back(name + "_hamming", s.hamming);
    columns.emplace_back(name + "_missing", s.missing);
    columns.emplace_back(name + "_false_alarm", s.false_alarm);
    columns.emplace_back(name + "_miou", s.miou);
}

void add(Columns& columns, const std::string& name, const scenes::VolumeScore& s) {
    columns.emplace_back(name + "_precision", s.precision.value);
    columns.emplace_back(name + "_recall", s.recall.value);
}

Columns columns_of(const RoomScore& r) {
    Columns c;
    c.emplace_back("seed", static_cast<double>(r.seed));
    c.emplace_back("points", static_cast<double>(r.points));
    c.emplace_back("parts", static_cast<double>(r.parts));
    c.emplace_back("objects", static_cast<double>(r.objects));
    add(c, "parts_by_region", r.parts_by_region);
    add(c, "parts_by_primitive", r.parts_by_primitive);
    add(c, "objects_by_region", r.objects_by_region);
    add(c, "objects_by_primitive", r.objects_by_primitive);
    add(c, "objects_by_object", r.objects_by_object);
    add(c, "surface", r.surface);
    add(c, "invisible", r.invisible);
    add(c, "completed", r.completed);
    c.emplace_back("fixed_recall", r.relations.fixed_recall.value);
    c.emplace_back("fixed_precision", r.relations.fixed_precision.value);
    c.emplace_back("support_recall", r.relations.support_recall.value);
    c.emplace_back("support_precision", r.relations.support_precision.value);
    c.emplace_back("gravity_deg", r.gravity_deg);
    c.emplace_back("parse_s", r.parse_s);
    return c;
}

}  // namespace

Spread spread(const std::vector<RoomScore>& rooms,
              const std::function<double(const RoomScore&)>& measure) {
    std::vector<double> values = known(rooms, measure);
    const double none = std::numeric_limits<double>::quiet_NaN();
    if (values.empty()) return {none, none, none};
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    const double median = values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
    return {median, values.front(), values.back()};
}

std::string tables(const std::vector<RoomScore>& rooms) {
    std::string text;
    append(
        text,
        "Segmentation (6.1, Fig. 14), errors: median and worst of %zu rooms. The paper draws bars "
        "without numbers.\n",
        rooms.size());
    append(text, "  %-18s  %13s  %13s  %13s  %13s  %13s\n", "", "cut discr.", "Hamming", "missing",
           "false alarm", "mIoU");
    text.append(" true parts\n");
    add_segmentation(rooms, "regions", &RoomScore::parts_by_region, text);
    add_segmentation(rooms, "primitives", &RoomScore::parts_by_primitive, text);
    text.append(" true objects\n");
    add_segmentation(rooms, "regions", &RoomScore::objects_by_region, text);
    add_segmentation(rooms, "primitives", &RoomScore::objects_by_primitive, text);
    add_segmentation(rooms, "objects", &RoomScore::objects_by_object, text);

    text.append("\nVolume (6.2, Table 2), percent\n");
    append(text, "  %-18s  %23s  %23s\n", "", "precision", "recall");
    append(text, "  %-18s  %7s %7s %7s  %7s %7s %7s\n", "", "median", "worst", "paper", "median",
           "worst", "paper");
    add_volume(rooms, "surface alone", &RoomScore::surface, PaperFigures::surface, text);
    add_volume(rooms, "invisible space", &RoomScore::invisible, PaperFigures::invisible, text);
    add_volume(rooms, "after filling", &RoomScore::completed, PaperFigures::completed, text);

    text.append(
        "\nJoints and supports (6.3, Table 3), percent; the paper's accuracy is a recall\n");
    append(text, "  %-18s  %15s  %15s  %15s\n", "", "recall", "precision", "paper");
    append(text, "  %-18s  %7s %7s  %7s %7s  %7s %7s\n", "", "median", "worst", "median", "worst",
           "SWC", "greedy");
    using scenes::RelationScore;
    add_relations(rooms, "fixed joints", &RelationScore::fixed_recall,
                  &RelationScore::fixed_precision, PaperFigures::fixed_joints,
                  PaperFigures::greedy_fixed_joints, text);
    add_relations(rooms, "supports", &RelationScore::support_recall,
                  &RelationScore::support_precision, PaperFigures::support,
                  PaperFigures::greedy_support, text);
    add_rooms(rooms, text);
    return text;
}

std::string csv(const std::vector<RoomScore>& rooms) {
    std::string text;
    const auto end_line = [&] {
        if (!text.empty()) text.back() = '\n';
    };
    for (const auto& [name, value] : columns_of(RoomScore{})) text.append(name).append(",");
    end_line();
    for (const RoomScore& room : rooms) {
        for (const auto& [name, value] : columns_of(room)) {
            append(text, "%.6g,", value);
        }
        end_line();
    }
    return text;
}

}  // namespace topple::evaluation

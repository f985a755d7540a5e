// SPDX-License-Identifier: MIT
#include <cstdio>
#include <utility>

#include "lab/evaluation/tables.h"

namespace topple::evaluation {
namespace {

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

std::string csv(const std::vector<RoomScore>& rooms) {
    std::string text;
    const auto end_line = [&] {
        if (!text.empty()) text.back() = '\n';
    };
    for (const auto& [name, value] : columns_of(RoomScore{})) text.append(name).append(",");
    end_line();
    for (const RoomScore& room : rooms) {
        for (const auto& [name, value] : columns_of(room)) {
            char digits[32];
            std::snprintf(digits, sizeof(digits), "%.6g,", value);
            text.append(digits);
        }
        end_line();
    }
    return text;
}

}  // namespace topple::evaluation

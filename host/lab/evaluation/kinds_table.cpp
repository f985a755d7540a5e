// SPDX-License-Identifier: MIT
#include <array>

#include "lab/evaluation/kind_score.h"
#include "lab/evaluation/text.h"

namespace topple::evaluation {
namespace {

struct Column {
    const char* name;
    double KindScore::*value;
};
constexpr std::array columns{
    Column{"mIoU", &KindScore::miou},
    Column{"found", &KindScore::found},
    Column{"alone", &KindScore::found_alone},
    Column{"best", &KindScore::found_best},
    Column{"joint r", &KindScore::joint_recall},
    Column{"joint p", &KindScore::joint_precision},
    Column{"support r", &KindScore::support_recall},
    Column{"support p", &KindScore::support_precision},
    Column{"swallowed", &KindScore::swallowed},
};

// Means over rooms; those without a case left out.
void add_row(const std::vector<KindScore>& rooms, const char* name, std::string& text) {
    std::size_t objects = 0;
    for (const KindScore& s : rooms) objects += s.objects;
    append(text, "  %-12s %5zu %7zu", name, rooms.size(), objects);
    for (const Column& column : columns)
        append(text, " %9s", percent(mean(known(rooms, column.value))).c_str());
    text.append("\n");
}

}  // namespace

std::string kinds_table(const std::vector<KindScore>& scores) {
    std::string text =
        "Kinds of rooms: means over rooms, percent (r recall, p precision). found: objects with "
        "IoU\n"
        "> 0.5; alone: if every primitive were an object; best: the best grouping of primitives\n";
    append(text, "  %-12s %5s %7s", "kind", "rooms", "objects");
    for (const Column& column : columns) append(text, " %9s", column.name);
    text.append("\n");
    std::vector<std::string> kinds;
    for (const KindScore& s : scores) {
        if (kinds.empty() || kinds.back() != s.kind) kinds.push_back(s.kind);
    }
    for (const std::string& kind : kinds)
        add_row(scores_of(scores, &KindScore::kind, kind), kind.c_str(), text);
    if (kinds.size() > 1) add_row(scores, "all", text);
    return text;
}

std::string kinds_csv(const std::vector<KindScore>& scores) {
    std::string text = "kind,seed,points,objects";
    for (const Column& column : columns) append(text, ",%s", column.name);
    text.append(",parse_s\n");
    for (const KindScore& s : scores) {
        append(text, "%s,%llu,%zu,%zu", s.kind.c_str(), static_cast<unsigned long long>(s.seed),
               s.points, s.objects);
        for (const Column& column : columns) append(text, ",%.4f", s.*column.value);
        append(text, ",%.2f\n", s.parse_s);
    }
    return text;
}

}  // namespace topple::evaluation

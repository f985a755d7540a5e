// SPDX-License-Identifier: MIT
#include "export/summary_notes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace topple::exports {
namespace {

// " (object_3, object_9)" of the bodies that are so, the first few of many; "" of none.
template <class IsSo>
std::string names_of(const ExportSummary& summary, const IsSo& is_so) {
    constexpr std::size_t most_names = 20;
    std::string out;
    std::size_t named = 0;
    for (const ExportedBody& body : summary.bodies) {
        if (!is_so(body)) continue;
        if (named == most_names) return out + ", ...)";
        out += named++ == 0 ? " (" : ", ";
        out += body.name;
    }
    return out.empty() ? out : out + ")";
}

void add_footings(const ExportSummary& summary, std::vector<std::string>& notes) {
    std::uint64_t pads = 0, held = 0, struts = 0;
    for (const ExportedBody& body : summary.bodies) {
        pads += body.on_pad;
        held += body.held;
        struts += body.struts;
    }
    if (pads + held + struts == 0) return;
    std::string note = "Without a footing, which was not seen or lay in others: ";
    note += std::to_string(pads) + " stand on pads made for them";
    note += names_of(summary, [](const ExportedBody& body) { return body.on_pad; });
    note += ", " + std::to_string(held) + " are held where they are";
    note += names_of(summary, [](const ExportedBody& body) { return body.held; });
    note += "; " + std::to_string(struts) + " struts stand for feet";
    note += names_of(summary, [](const ExportedBody& body) { return body.struts > 0; });
    notes.push_back(note + ".");
}

// Those that lost most first.
void add_cuts(const ExportSummary& summary, std::vector<std::string>& notes) {
    constexpr double much = 0.5;
    constexpr std::size_t most_named = 5;
    std::vector<const ExportedBody*> cut;
    for (const ExportedBody& body : summary.bodies)
        if (body.lost_share() > much) cut.push_back(&body);
    if (cut.empty()) return;
    std::ranges::stable_sort(cut, std::ranges::greater{},
                             [](const ExportedBody* body) { return body->lost_share(); });
    std::string note = std::to_string(cut.size());
    note +=
        " lay in others so deep that more than half of each was cut off, as a share of its solid: ";
    for (std::size_t n = 0; n < std::min(cut.size(), most_named); ++n) {
        if (n > 0) note += ", ";
        note += cut[n]->name;
        note += ' ';
        note += std::to_string(std::lround(100 * cut[n]->lost_share()));
        note += " %";
    }
    note += cut.size() > most_named ? ", ..." : ".";
    notes.push_back(std::move(note));
}

}  // namespace

std::vector<std::string> notes_of(const ExportSummary& summary) {
    std::vector<std::string> notes;
    add_footings(summary, notes);
    add_cuts(summary, notes);
    return notes;
}

}  // namespace topple::exports

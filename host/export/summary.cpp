// SPDX-License-Identifier: MIT
#include "export/summary.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/field_rules.h"
#include "io/json_values.h"

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
        " lay in others so deep that what was cut off their hulls, which fill hollows, is more "
        "than "
        "half of their solids: ";
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

// null for a vector that is not finite.
OrderedJson vector_or_null(const Vec3& v) {
    return rules::finite(v) ? OrderedJson(v) : OrderedJson(nullptr);
}

OrderedJson front_json(const ExportedFront& front) {
    return {{"name", front.name},
            {"object", front.object},
            {"opens", front.opens},
            {"probability", io::number(front.probability)},
            {"middle_m", vector_or_null(front.middle_m)},
            {"wide_m", io::number(front.wide_m)},
            {"high_m", io::number(front.high_m)},
            {"handle_m", vector_or_null(front.handle_m)},
            {"mass_kg", io::number(front.mass_kg)},
            {"axis", vector_or_null(front.axis)},
            {"at_m", vector_or_null(front.at_m)},
            {"most", io::number(front.most)}};
}

OrderedJson body_json(const ExportedBody& body) {
    return {
        {"name", body.name},
        {"object", body.object},
        {"fixed", body.fixed},
        {"on_pad", body.on_pad},
        {"held", body.held},
        {"struts", body.struts},
        {"moved_m", vector_or_null(body.moved_m)},
        {"parts", body.parts},
        {"mass_kg", io::number(body.mass_kg)},
        {"solid_m3", io::number(body.solid_m3)},
        {"parts_m3", io::number(body.parts_m3)},
        {"excess_share",
         body.solid_m3 > 0 ? io::number(body.parts_m3 / body.solid_m3 - 1) : OrderedJson(nullptr)},
        {"lost_m3", io::number(body.lost_m3)},
        {"lost_share", body.solid_m3 > 0 ? io::number(body.lost_share()) : OrderedJson(nullptr)}};
}

}  // namespace

std::vector<std::string> notes_of(const ExportSummary& summary) {
    std::vector<std::string> notes;
    add_footings(summary, notes);
    add_cuts(summary, notes);
    return notes;
}

std::string bodies_json(const ExportSummary& summary) {
    OrderedJson bodies = OrderedJson::array();
    for (const ExportedBody& body : summary.bodies) bodies.push_back(body_json(body));
    OrderedJson fronts = OrderedJson::array();
    for (const ExportedFront& front : summary.fronts) fronts.push_back(front_json(front));
    const OrderedJson json{{"schema", bodies_schema},
                           {"deepest_overlap_m", io::number(summary.deepest_overlap_m)},
                           {"floor_m", io::number(summary.floor_m)},
                           {"free_place_m", vector_or_null(summary.free_place_m)},
                           {"free_radius_m", io::number(summary.free_radius_m)},
                           {"notes", summary.notes},
                           {"bodies", std::move(bodies)},
                           {"fronts", std::move(fronts)}};
    return json.dump(1) + "\n";
}

}  // namespace topple::exports

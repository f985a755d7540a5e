// SPDX-License-Identifier: MIT
#include "objects/corrections_json.h"

#include "io/text.h"

namespace topple::io {

std::optional<Correction::Kind> correction_kind(std::string_view name) {
    for (const auto& [kind, known] : correction_kinds)
        if (name == known) return kind;
    return std::nullopt;
}

std::string known_corrections() {
    std::string known;
    for (const auto& [kind, name] : correction_kinds)
        known.append(known.empty() ? "" : ", ").append(name);
    return known;
}

OrderedJson json_of_correction(const AppliedCorrection& applied) {
    using Kind = Correction::Kind;
    const Correction& c = applied.correction;
    OrderedJson json{{"do", to_string(c.kind)}, {"at_m", c.at_m}};
    if (c.kind == Kind::apart) json["from_m"] = c.from_m;
    if (c.kind == Kind::hollow) json["wall_m"] = c.wall_m;
    if (c.kind == Kind::mass) json["kg"] = c.mass_kg;
    if (c.kind == Kind::friction) json["coefficient"] = c.coefficient;
    if (c.kind == Kind::name) json["name"] = c.name;
    if (!c.was.empty()) json["was"] = c.was;
    json["held"] = applied.held;
    json["outcome"] = applied.outcome;
    json["objects"] = applied.objects;
    return json;
}

AppliedCorrection correction_of(const OrderedJson& json) {
    AppliedCorrection out;
    Correction& c = out.correction;
    const auto name = json.at("do").get<std::string>();
    const auto kind = correction_kind(name);
    if (!kind)
        throw OrderedJson::other_error::create(
            501,
            "\"do\" of a correction is " + in_quotes(name) + "; there are " + known_corrections(),
            &json);
    c.kind = *kind;
    c.at_m = json.at("at_m").get<std::vector<Vec3>>();
    if (json.contains("from_m")) c.from_m = json.at("from_m").get<std::vector<Vec3>>();
    if (json.contains("wall_m")) c.wall_m = json.at("wall_m").get<double>();
    if (json.contains("kg")) c.mass_kg = json.at("kg").get<double>();
    if (json.contains("coefficient")) c.coefficient = json.at("coefficient").get<double>();
    if (json.contains("name")) c.name = json.at("name").get<std::string>();
    if (json.contains("was")) c.was = json.at("was").get<std::string>();
    out.held = json.at("held").get<bool>();
    out.outcome = json.at("outcome").get<std::string>();
    out.objects = json.at("objects").get<std::vector<std::int32_t>>();
    return out;
}

}  // namespace topple::io

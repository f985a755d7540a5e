// SPDX-License-Identifier: MIT
#include "io/corrections_json.h"

namespace topple::io {

OrderedJson json_of_correction(const AppliedCorrection& applied) {
    using Kind = Correction::Kind;
    const Correction& c = applied.correction;
    OrderedJson json{{"do", to_string(c.kind)}, {"at_m", c.at_m}};
    if (c.kind == Kind::apart) json["from_m"] = c.from_m;
    if (c.kind == Kind::hollow) json["wall_m"] = c.wall_m;
    if (c.kind == Kind::mass) json["kg"] = c.mass_kg;
    if (c.kind == Kind::name) json["name"] = c.name;
    json["held"] = applied.held;
    json["outcome"] = applied.outcome;
    json["objects"] = applied.objects;
    return json;
}

AppliedCorrection correction_of(const OrderedJson& json) {
    AppliedCorrection out;
    Correction& c = out.correction;
    const auto what = json.at("do").get<std::string>();
    while (c.kind != Correction::Kind::one_thing && what != to_string(c.kind))  // from the last on
        c.kind = static_cast<Correction::Kind>(static_cast<int>(c.kind) - 1);
    c.at_m = json.at("at_m").get<std::vector<Vec3>>();
    if (json.contains("from_m")) c.from_m = json.at("from_m").get<std::vector<Vec3>>();
    if (json.contains("wall_m")) c.wall_m = json.at("wall_m").get<double>();
    if (json.contains("kg")) c.mass_kg = json.at("kg").get<double>();
    if (json.contains("name")) c.name = json.at("name").get<std::string>();
    out.held = json.at("held").get<bool>();
    out.outcome = json.at("outcome").get<std::string>();
    out.objects = json.at("objects").get<std::vector<std::int32_t>>();
    return out;
}

}  // namespace topple::io

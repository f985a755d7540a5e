// SPDX-License-Identifier: MIT
#include "io/object_json.h"

#include <cmath>
#include <limits>
#include <utility>

#include "io/json_values.h"

namespace topple::io {
namespace {

using Json = OrderedJson;

Json to_json(const Why& w) {
    return {{"azimuth_deg", number(w.azimuth_deg)},
            {"edge_m", list(w.edge_m, vector)},
            {"W_J", number(w.W_J)},
            {"S_J", number(w.S_J)},
            {"way_m", number(w.way_m)},
            {"drop_m", number(w.drop_m)},
            {"lands_on", w.lands_on},
            {"stands_on", w.stands_on},
            {"sentence", w.sentence}};
}

Json to_json(const Fall& f) {
    return {{"falls", f.falls},           {"lands_m", vector(f.lands_m)},
            {"drop_m", number(f.drop_m)}, {"lands_on", f.lands_on},
            {"leans_on", f.leans_on},     {"takes_along", f.takes_along},
            {"hits_J", number(f.hits_J)}, {"people_share", number(f.people_share)}};
}

Json to_json(const Advice& a) {
    return {{"kind", a.kind},
            {"move_m", vector(a.move_m)},
            {"risk_J", number(a.risk_J)},
            {"hold_N", number(a.hold_N)},
            {"hold_height_m", number(a.hold_height_m)},
            {"sentence", a.sentence},
            {"action", a.action}};
}

Json to_json(const Overturning& o) {
    return {{"tilt_deg", number(o.tilt_deg)},
            {"tilt_error_deg", number(o.tilt_error_deg)},
            {"direction", vector(o.direction)},
            {"push_N", number(o.push_N)},
            {"push_error_N", number(o.push_error_N)},
            {"slide_N", number(o.slide_N)},
            {"hand_push_N", number(o.hand_push_N)},
            {"hand_push_error_N", number(o.hand_push_error_N)},
            {"hand_height_m", number(o.hand_height_m)},
            {"gust_m_s", number(o.gust_m_s)},
            {"gust_error_m_s", number(o.gust_error_m_s)},
            {"shake_g", number(o.shake_g)}};
}

Json to_json(const Fragility& f) {
    return {{"pga_g", number(f.pga_g)},
            {"pga_dispersion", number(f.pga_dispersion)},
            {"firm_pga_g", number(f.firm_pga_g)},
            {"pgv_m_s", number(f.pgv_m_s)},
            {"pgv_dispersion", number(f.pgv_dispersion)},
            {"counted",
             list(f.counted,
                  [](const Fragility::Step& step) {
                      return Json{{"pga_g", number(step.pga_g)}, {"chance", number(step.chance)}};
                  })},
            {"falls_per_year", number(f.falls_per_year)},
            {"return_years", number(f.return_years)}};
}

// A row of blows at each height for each direction.
Json rows(const std::vector<double>& blows, const DirectedBarrier& b) {
    auto out = Json::array();
    for (std::size_t n = 0; n < b.push_J.size(); ++n) {
        auto row = Json::array();
        for (std::size_t h = 0; h < b.height_m.size(); ++h)
            row.push_back(number(blows[n * b.height_m.size() + h]));
        out.push_back(std::move(row));
    }
    return out;
}

Json to_json(const DirectedBarrier& b) {
    return {{"height_m", numbers(b.height_m)},        {"push_J", numbers(b.push_J)},
            {"blow_Ns", rows(b.blow_Ns, b)},          {"blow_J", rows(b.blow_J, b)},
            {"direction", list(b.direction, vector)}, {"push_N", numbers(b.push_N)},
            {"push_error_N", numbers(b.push_error_N)}};
}

Why why_of(const Json& json) {
    Why w;
    w.azimuth_deg = number_at(json, "azimuth_deg");
    for (const Json& end : json.at("edge_m")) w.edge_m.push_back(vector_of(end));
    w.W_J = number_at(json, "W_J");
    w.S_J = number_at(json, "S_J");
    w.way_m = number_at(json, "way_m");
    w.drop_m = number_at(json, "drop_m");
    w.lands_on = json.at("lands_on").get<std::int32_t>();
    w.stands_on = json.at("stands_on").get<std::vector<std::int32_t>>();
    w.sentence = json.at("sentence").get<std::string>();
    return w;
}

Fall fall_of(const Json& json) {
    Fall f;
    f.falls = json.at("falls").get<bool>();
    f.lands_m = vector_at(json, "lands_m");
    f.drop_m = number_at(json, "drop_m");
    f.lands_on = json.at("lands_on").get<std::int32_t>();
    if (json.contains("leans_on")) f.leans_on = json.at("leans_on").get<std::int32_t>();
    f.takes_along = json.at("takes_along").get<std::vector<std::int32_t>>();
    if (json.contains("hits_J")) {
        f.hits_J = number_at(json, "hits_J");
        f.people_share = number_at(json, "people_share");
    }
    return f;
}

Advice advice_of(const Json& json) {
    Advice a;
    a.kind = json.at("kind").get<std::string>();
    a.move_m = vector_at(json, "move_m");
    a.risk_J = number_at(json, "risk_J");
    a.hold_N = number_at(json, "hold_N");
    a.hold_height_m = number_at(json, "hold_height_m");
    a.sentence = json.at("sentence").get<std::string>();
    if (json.contains("action")) a.action = json.at("action").get<std::string>();
    return a;
}

Overturning overturning_of(const Json& json) {
    Overturning o;
    o.tilt_deg = number_at(json, "tilt_deg");
    o.tilt_error_deg = number_at(json, "tilt_error_deg");
    o.direction = vector_at(json, "direction");
    o.push_N = number_at(json, "push_N");
    o.push_error_N = number_at(json, "push_error_N");
    o.slide_N = number_at(json, "slide_N");
    o.shake_g = number_at(json, "shake_g");
    if (!json.contains("gust_m_s")) return o;
    o.hand_push_N = number_at(json, "hand_push_N");
    o.hand_push_error_N = number_at(json, "hand_push_error_N");
    o.hand_height_m = number_at(json, "hand_height_m");
    o.gust_m_s = number_at(json, "gust_m_s");
    o.gust_error_m_s = number_at(json, "gust_error_m_s");
    return o;
}

Fragility fragility_of(const Json& json) {
    Fragility f;
    f.pga_g = number_at(json, "pga_g");
    f.pga_dispersion = number_at(json, "pga_dispersion");
    if (json.contains("firm_pga_g")) f.firm_pga_g = number_at(json, "firm_pga_g");
    f.pgv_m_s = number_at(json, "pgv_m_s");
    f.pgv_dispersion = number_at(json, "pgv_dispersion");
    for (const Json& step : json.at("counted"))
        f.counted.push_back({number_at(step, "pga_g"), number_at(step, "chance")});
    f.falls_per_year = number_at(json, "falls_per_year");
    f.return_years = number_at(json, "return_years");
    return f;
}

DirectedBarrier directed_of(const Json& json) {
    constexpr double never = std::numeric_limits<double>::infinity();  // falls: null
    DirectedBarrier b;
    b.height_m = json.at("height_m").get<std::vector<double>>();
    for (const Json& value : json.at("push_J")) b.push_J.push_back(number_of(value, never));
    const auto blows = [&](const char* name) {
        std::vector<double> out;
        for (const Json& row : json.at(name))
            for (const Json& value : row) out.push_back(number_of(value, never));
        return out;
    };
    b.blow_J = blows("blow_J");
    // Earlier versions did not write it.
    b.blow_Ns =
        json.contains("blow_Ns")
            ? blows("blow_Ns")
            : std::vector<double>(b.blow_J.size(), std::numeric_limits<double>::quiet_NaN());
    if (!json.contains("push_N")) return b;
    for (const Json& way : json.at("direction")) b.direction.push_back(vector_of(way));
    for (const Json& value : json.at("push_N")) b.push_N.push_back(number_of(value, never));
    for (const Json& value : json.at("push_error_N"))
        b.push_error_N.push_back(number_of(value, never));
    return b;
}

}  // namespace

OrderedJson json_of_object(const Object& o) {
    Json json{
        {"id", o.id},
        {"primitives", o.primitives},
        {"grounded", o.grounded},
        {"agreement", number(o.agreement)},
        {"mass_kg", number(o.mass_kg)},
        {"mass_model", o.mass_model},
        {"center_of_mass_m", vector(o.center_of_mass_m)},
        {"support_height_m", number(o.support_height_m)},
        {"center_height_m", number(o.center_height_m)},
        {"size_m", vector(o.size_m)},
        {"box_middle_m", std::isfinite(o.box_middle_m[0]) ? vector(o.box_middle_m) : Json(nullptr)},
        {"piece_of", o.piece_of},
        {"piece_probability", number(o.piece_probability)},
        {"joint_probability", number(o.joint_probability)},
        {"weakest_joint", o.weakest_joint},
        {"inertia_kg_m2", matrix(o.inertia_kg_m2)},
        {"mass_error_kg", number(o.mass_error_kg)},
        {"center_of_mass_error_m", vector(o.center_of_mass_error_m)},
        {"footprint_error_m", number(o.footprint_error_m)},
        {"barrier_J", number(o.barrier_J)},
        {"barrier_error_J", number(o.barrier_error_J)},
        {"release_J", number(o.release_J)},
        {"overturning", to_json(o.overturning)},
        {"fragility", to_json(o.fragility)},
        {"mode", o.mode},
        {"direction", vector(o.direction)},
        {"instability", list(o.instability,
                             [](const InstabilityStep& step) {
                                 return Json{{"W_J", number(step.W_J)}, {"S_J", number(step.S_J)}};
                             })},
        {"barrier_by_direction", to_json(o.barrier_by_direction)},
        {"why", to_json(o.why)},
        {"risk_J", numbers_by_name(o.risk_J)},
        {"risk_spread_J", numbers_by_name(o.risk_spread_J)},
        {"risk_error_J", numbers_by_name(o.risk_error_J)},
        {"fall_chance", numbers_by_name(o.fall_chance)},
        {"unsafety", number(o.unsafety)},
        {"unsafety_category",
         o.unsafety_category.empty() ? Json(nullptr) : Json(o.unsafety_category)},
        {"unsafety_certain", o.unsafety_certain},
        {"seen_enough", o.seen_enough},
        {"rests_by", o.rests_by},
        {"rest_probability", number(o.rest_probability)},
        {"fall", to_json(o.fall)},
        {"advice", to_json(o.advice)}};
    if (!o.name.empty()) json["name"] = o.name;
    if (!o.corrected.empty()) json["corrected"] = o.corrected;
    return json;
}

Object object_of(const OrderedJson& json) {
    Object o;
    o.id = json.at("id").get<std::int32_t>();
    o.primitives = json.at("primitives").get<std::vector<std::int32_t>>();
    o.grounded = json.at("grounded").get<bool>();
    if (json.contains("agreement")) o.agreement = number_at(json, "agreement");
    o.mass_kg = number_at(json, "mass_kg");
    o.center_of_mass_m = vector_at(json, "center_of_mass_m");
    if (json.contains("support_height_m")) {  // earlier versions did not write these
        o.support_height_m = number_at(json, "support_height_m");
        o.center_height_m = number_at(json, "center_height_m");
    }
    if (json.contains("size_m")) o.size_m = vector_at(json, "size_m");
    if (json.contains("box_middle_m") && !json.at("box_middle_m").is_null())
        o.box_middle_m = vector_at(json, "box_middle_m");
    if (json.contains("piece_of")) {
        o.piece_of = json.at("piece_of").get<std::int32_t>();
        o.piece_probability = number_at(json, "piece_probability");
    }
    if (json.contains("weakest_joint")) {
        o.joint_probability = number_at(json, "joint_probability");
        o.weakest_joint = json.at("weakest_joint").get<std::array<std::int32_t, 2>>();
    }
    o.barrier_J = number_at(json, "barrier_J");
    // Earlier versions did not write it.
    if (json.contains("barrier_error_J")) o.barrier_error_J = number_at(json, "barrier_error_J");
    if (json.contains("mass_error_kg")) {  // nor these
        o.mass_error_kg = number_at(json, "mass_error_kg");
        o.center_of_mass_error_m = vector_at(json, "center_of_mass_error_m");
        o.footprint_error_m = number_at(json, "footprint_error_m");
    }
    if (json.contains("mass_model")) {  // nor these
        o.mass_model = json.at("mass_model").get<std::string>();
        o.inertia_kg_m2 = matrix_at<9>(json, "inertia_kg_m2");
    }
    o.release_J = number_at(json, "release_J");
    if (json.contains("overturning")) o.overturning = overturning_of(json.at("overturning"));
    if (json.contains("fragility")) o.fragility = fragility_of(json.at("fragility"));
    o.mode = json.at("mode").get<std::string>();
    o.direction = vector_at(json, "direction");
    for (const auto& step : json.at("instability")) {
        o.instability.push_back({number_at(step, "W_J"), number_at(step, "S_J")});
    }
    if (json.contains("barrier_by_direction"))
        o.barrier_by_direction = directed_of(json.at("barrier_by_direction"));
    if (json.contains("why")) o.why = why_of(json.at("why"));  // nor this
    o.risk_J = numbers_by_name_at(json, "risk_J");
    if (json.contains("fall")) {  // nor these
        o.risk_spread_J = numbers_by_name_at(json, "risk_spread_J");
        o.fall_chance = numbers_by_name_at(json, "fall_chance");
        o.fall = fall_of(json.at("fall"));
        o.advice = advice_of(json.at("advice"));
    }
    o.unsafety = number_at(json, "unsafety");
    o.unsafety_category.clear();
    o.unsafety_certain = false;
    if (json.contains("unsafety_category")) {  // nor these
        const Json& category = json.at("unsafety_category");
        o.unsafety_category = category.is_null() ? "" : category.get<std::string>();
        o.unsafety_certain = json.at("unsafety_certain").get<bool>();
        o.risk_error_J = numbers_by_name_at(json, "risk_error_J");
    }
    if (json.contains("seen_enough")) {  // nor these
        o.seen_enough = json.at("seen_enough").get<bool>();
        o.rests_by = json.at("rests_by").get<std::string>();
        o.rest_probability = number_at(json, "rest_probability");
    }
    if (json.contains("name")) o.name = json.at("name").get<std::string>();
    if (json.contains("corrected"))
        o.corrected = json.at("corrected").get<std::vector<std::int32_t>>();
    return o;
}

}  // namespace topple::io

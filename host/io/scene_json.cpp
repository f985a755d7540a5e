// SPDX-License-Identifier: MIT
#include "io/scene_json.h"

#include <cmath>
#include <limits>

#include "core/json.h"
#include "io/corrections_json.h"
#include "io/file_writer.h"
#include "io/json_text.h"
#include "io/text.h"

namespace topple::io {
namespace {

using Json = OrderedJson;

constexpr const char* scene_schema = "topple.scene/1";

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json vector(const Vec3& v) {
    return Json::array({number(v[0]), number(v[1]), number(v[2])});
}

Json numbers(const std::vector<double>& values) {
    auto json = Json::array();
    for (const double value : values) json.push_back(number(value));
    return json;
}

template <class T, class Convert>
Json list(const std::vector<T>& items, Convert convert) {
    auto json = Json::array();
    for (const auto& item : items) json.push_back(convert(item));
    return json;
}

// Square, row-major.
template <std::size_t N>
Json matrix(const std::array<double, N>& m) {
    constexpr std::size_t side = N == 16 ? 4 : 3;
    static_assert(side * side == N);
    auto rows = Json::array();
    for (std::size_t row = 0; row < side; ++row) {
        auto values = Json::array();
        for (std::size_t column = 0; column < side; ++column)
            values.push_back(number(m[row * side + column]));
        rows.push_back(std::move(values));
    }
    return rows;
}

Json to_json(const Primitive& p) {
    Json json{{"id", p.id},
              {"object", p.object},
              {"model", p.model},
              {"points", p.points},
              {"solid_voxels", p.solid_voxels},
              {"volume_m3", number(p.volume_m3)},
              {"mass_kg", number(p.mass_kg)},
              {"center_of_mass_m", vector(p.center_of_mass_m)}};
    if (!p.name.empty()) json["name"] = p.name;
    return json;
}

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
            {"sentence", a.sentence}};
}

Json numbers_by_name(const std::map<std::string, double>& values) {
    auto json = Json::object();
    for (const auto& [disturbance, value] : values) json[disturbance] = number(value);
    return json;
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

Json to_json(const DirectedBarrier& b) {
    auto blows = Json::array();
    for (std::size_t n = 0; n < b.push_J.size(); ++n) {
        auto row = Json::array();
        for (std::size_t h = 0; h < b.height_m.size(); ++h)
            row.push_back(number(b.blow_J[n * b.height_m.size() + h]));
        blows.push_back(std::move(row));
    }
    return {{"height_m", numbers(b.height_m)},
            {"push_J", numbers(b.push_J)},
            {"blow_J", std::move(blows)}};
}

Json to_json(const Object& o) {
    Json json{
        {"id", o.id},
        {"primitives", o.primitives},
        {"grounded", o.grounded},
        {"agreement", number(o.agreement)},
        {"mass_kg", number(o.mass_kg)},
        {"mass_model", o.mass_model},
        {"center_of_mass_m", vector(o.center_of_mass_m)},
        {"size_m", vector(o.size_m)},
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

Json to_json(const Contact& c) {
    return {{"a", c.a},
            {"b", c.b},
            {"area_m2", number(c.area_m2)},
            {"normal", vector(c.normal)},
            {"relation", c.relation},
            {"probability", number(c.probability)}};
}

Json to_json(const Support& s) {
    return {{"supporter", s.supporter},
            {"supported", s.supported},
            {"area_m2", number(s.area_m2)},
            {"probability", number(s.probability)}};
}

double number_of(const Json& json) {
    return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

double number_at(const Json& json, const char* key) {
    return number_of(json.at(key));
}

Vec3 vector_at(const Json& json, const char* key) {
    const auto& v = json.at(key);
    return {number_of(v.at(0)), number_of(v.at(1)), number_of(v.at(2))};
}

Primitive primitive_of(const Json& json) {
    Primitive p;
    p.id = json.at("id").get<std::int32_t>();
    p.object = json.at("object").get<std::int32_t>();
    p.model = json.at("model").get<std::string>();
    p.points = json.at("points").get<std::uint64_t>();
    p.solid_voxels = json.at("solid_voxels").get<std::uint64_t>();
    p.volume_m3 = number_at(json, "volume_m3");
    p.mass_kg = number_at(json, "mass_kg");
    p.center_of_mass_m = vector_at(json, "center_of_mass_m");
    if (json.contains("name")) p.name = json.at("name").get<std::string>();
    return p;
}

Why why_of(const Json& json) {
    Why w;
    w.azimuth_deg = number_at(json, "azimuth_deg");
    for (const Json& end : json.at("edge_m")) {
        w.edge_m.push_back({number_of(end.at(0)), number_of(end.at(1)), number_of(end.at(2))});
    }
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
    return a;
}

std::map<std::string, double> numbers_by_name(const Json& json) {
    std::map<std::string, double> values;
    for (const auto& [disturbance, value] : json.items()) values[disturbance] = number_of(value);
    return values;
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

// Null: it does not fall.
double barrier_of(const Json& json) {
    return json.is_null() ? std::numeric_limits<double>::infinity() : json.get<double>();
}

DirectedBarrier directed_of(const Json& json) {
    DirectedBarrier b;
    b.height_m = json.at("height_m").get<std::vector<double>>();
    for (const Json& value : json.at("push_J")) b.push_J.push_back(barrier_of(value));
    for (const Json& row : json.at("blow_J")) {
        for (const Json& value : row) b.blow_J.push_back(barrier_of(value));
    }
    return b;
}

Object object_of(const Json& json) {
    Object o;
    o.id = json.at("id").get<std::int32_t>();
    o.primitives = json.at("primitives").get<std::vector<std::int32_t>>();
    o.grounded = json.at("grounded").get<bool>();
    if (json.contains("agreement")) o.agreement = number_at(json, "agreement");
    o.mass_kg = number_at(json, "mass_kg");
    o.center_of_mass_m = vector_at(json, "center_of_mass_m");
    if (json.contains("size_m")) o.size_m = vector_at(json, "size_m");
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
        for (std::size_t i = 0; i < 9; ++i)
            o.inertia_kg_m2[i] = number_of(json.at("inertia_kg_m2").at(i / 3).at(i % 3));
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
    o.risk_J = numbers_by_name(json.at("risk_J"));
    if (json.contains("fall")) {  // nor these
        o.risk_spread_J = numbers_by_name(json.at("risk_spread_J"));
        o.fall_chance = numbers_by_name(json.at("fall_chance"));
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
        o.risk_error_J = numbers_by_name(json.at("risk_error_J"));
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

Contact contact_of(const Json& json) {
    Contact c;
    c.a = json.at("a").get<std::int32_t>();
    c.b = json.at("b").get<std::int32_t>();
    c.area_m2 = number_at(json, "area_m2");
    c.normal = vector_at(json, "normal");
    c.relation = json.at("relation").get<std::string>();
    c.probability = number_at(json, "probability");
    return c;
}

Scene scene_of(const Json& json) {
    Scene scene;
    scene.source = json.at("source").get<std::string>();
    scene.topple_version = json.at("topple_version").get<std::string>();
    scene.backend = json.at("backend").get<std::string>();
    scene.device = json.at("device").get<std::string>();
    scene.seed = json.at("seed").get<std::uint64_t>();
    scene.voxel_size_m = number_at(json, "voxel_size_m");
    scene.up = vector_at(json, "up");
    scene.up_method = json.at("up_method").get<std::string>();
    scene.manhattan_found = json.at("manhattan_found").get<bool>();
    for (std::size_t i = 0; i < 16; ++i) {
        scene.manhattan_from_input[i] =
            number_of(json.at("manhattan_from_input").at(i / 4).at(i % 4));
    }
    scene.density_kg_m3 = number_at(json, "density_kg_m3");
    scene.friction = number_at(json, "friction");
    if (json.contains("events")) scene.events = numbers_by_name(json.at("events"));
    for (const auto& item : json.at("primitives")) scene.primitives.push_back(primitive_of(item));
    for (const auto& item : json.at("objects")) scene.objects.push_back(object_of(item));
    for (const auto& item : json.at("contacts")) scene.contacts.push_back(contact_of(item));
    for (const auto& item : json.at("supports")) {
        scene.supports.push_back(
            {item.at("supporter").get<std::int32_t>(), item.at("supported").get<std::int32_t>(),
             number_at(item, "area_m2"),
             // Scenes of before 0.2 have none.
             item.contains("probability") ? number_at(item, "probability") : 1});
    }
    if (json.contains("corrections"))
        for (const Json& item : json.at("corrections"))
            scene.corrections.push_back(correction_of(item));
    for (const auto& [stage, seconds] : json.at("timings_s").items()) {
        scene.timings_s.emplace_back(stage, number_of(seconds));
    }
    for (const auto& value : json.at("swc_energy")) scene.swc_energy.push_back(number_of(value));
    if (json.contains("offset_m")) scene.offset_m = vector_at(json, "offset_m");
    scene.notes = json.at("notes").get<std::vector<std::string>>();
    return scene;
}

}  // namespace

OrderedJson scene_document(const Scene& scene) {
    Json json = Json::object();
    json["schema"] = scene_schema;
    json["source"] = scene.source;
    json["topple_version"] = scene.topple_version;
    json["backend"] = scene.backend;
    json["device"] = scene.device;
    json["seed"] = scene.seed;
    json["voxel_size_m"] = number(scene.voxel_size_m);
    json["up"] = vector(scene.up);
    json["up_method"] = scene.up_method;
    json["manhattan_found"] = scene.manhattan_found;
    json["offset_m"] = vector(scene.offset_m);
    json["manhattan_from_input"] = matrix(scene.manhattan_from_input);
    json["density_kg_m3"] = number(scene.density_kg_m3);
    json["friction"] = number(scene.friction);
    json["events"] = numbers_by_name(scene.events);
    json["primitives"] = list(scene.primitives, [](const Primitive& p) { return to_json(p); });
    json["objects"] = list(scene.objects, [](const Object& o) { return to_json(o); });
    json["contacts"] = list(scene.contacts, [](const Contact& c) { return to_json(c); });
    json["supports"] = list(scene.supports, [](const Support& s) { return to_json(s); });
    if (!scene.corrections.empty())
        json["corrections"] = list(scene.corrections, json_of_correction);
    auto timings = Json::object();
    // A stage that ran twice counts once, with its sum.
    for (const auto& [stage, seconds] : scene.timings_s) {
        const auto before = timings.find(stage);
        const double sum =
            seconds + (before == timings.end() || before->is_null() ? 0.0 : before->get<double>());
        timings[stage] = number(sum);
    }
    json["timings_s"] = std::move(timings);
    json["swc_energy"] = numbers(scene.swc_energy);
    json["notes"] = scene.notes;
    return json;
}

std::string scene_json(const Scene& scene) {
    return scene_document(scene).dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_scene_json(const std::filesystem::path& file, const Scene& scene) {
    write_file(file, scene_json(scene));
}

Scene read_scene_json(const std::filesystem::path& file) {
    const auto bytes = read_file(file);
    const auto text = bytes.text();
    check_json_nesting(file, text);
    try {
        const auto json = Json::parse(text.begin(), text.end());
        if (json.at("schema") != scene_schema) {
            fail(file, "its schema is not " + std::string(scene_schema));
        }
        return scene_of(json);
    } catch (const Json::exception& error) {
        fail(file, "is no scene.json: " + json_problem(error));
    }
}

}  // namespace topple::io

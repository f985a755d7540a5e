// SPDX-License-Identifier: MIT
#include "io/scene_json.h"

#include <utility>

#include "core/json.h"
#include "io/check_scene.h"
#include "io/corrections_json.h"
#include "io/file_writer.h"
#include "io/json_text.h"
#include "io/json_values.h"
#include "io/object_json.h"
#include "io/text.h"

namespace topple::io {
namespace {

using Json = OrderedJson;

constexpr const char* scene_schema = "topple.scene/1";

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
    scene.manhattan_from_input = matrix_at<16>(json, "manhattan_from_input");
    scene.density_kg_m3 = number_at(json, "density_kg_m3");
    scene.friction = number_at(json, "friction");
    if (json.contains("events")) scene.events = numbers_by_name_at(json, "events");
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
    json["objects"] = list(scene.objects, json_of_object);
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

Scene read_scene_json(const FileName& name) {
    const std::filesystem::path& file = name.path();
    const auto bytes = read_file(name);
    const auto text = bytes.text();
    check_json_nesting(file, text);
    try {
        const auto json = Json::parse(text.begin(), text.end());
        if (json.at("schema") != scene_schema) {
            fail(file, "its schema is not " + std::string(scene_schema));
        }
        Scene scene = scene_of(json);
        check_scene(scene, file);
        return scene;
    } catch (const Json::exception& error) {
        fail(file, "is no scene.json: " + json_problem(error));
    }
}

}  // namespace topple::io

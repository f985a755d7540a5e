// SPDX-License-Identifier: MIT
#include "result/scene_json.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/json.h"
#include "core/result_fields.h"
#include "io/file_writer.h"
#include "io/json_text.h"
#include "io/json_values.h"
#include "io/text.h"
#include "objects/corrections_json.h"
#include "result/check_scene.h"

namespace topple::io {
namespace {

using Json = OrderedJson;

constexpr const char* scene_schema = "topple.scene/1";

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

// A stage that ran twice counts once, with its sum.
using Timings = decltype(Scene::timings_s);
Json seconds_by_stage(const Timings& timings) {
    auto json = Json::object();
    for (const auto& [stage, seconds] : timings) {
        const auto before = json.find(stage);
        const double sum =
            seconds + (before == json.end() || before->is_null() ? 0.0 : before->get<double>());
        json[stage] = number(sum);
    }
    return json;
}

template <class Item>
Json json_of_item(const Item& item);

template <class T>
Json json_of(const T& value) {
    if constexpr (std::is_same_v<T, AppliedCorrection>)
        return json_of_correction(value);
    else if constexpr (Listed<T>)
        return json_of_item(value);
    else if constexpr (std::is_same_v<T, double>)
        return number(value);
    else if constexpr (array_size<T> == 3)
        return vector(value);
    else if constexpr (array_size<T> > 3)
        return matrix(value);
    else if constexpr (is_a<T, std::map>)
        return numbers_by_name(value);
    else if constexpr (std::is_same_v<T, Timings>)
        return seconds_by_stage(value);
    else if constexpr (is_a<T, std::vector>)
        return list(value, json_of<typename T::value_type>);
    else
        return value;
}

template <class Item, class T>
Json json_in(const Item&, const T& value, const Note&) {
    return json_of(value);
}
Json json_in(const DirectedBarrier& b, const std::vector<double>& values, const Note& note) {
    return note.rows ? rows(values, b) : numbers(values);
}

template <class Item>
Json json_of_item(const Item& item) {
    auto json = Json::object();
    fields(item, [&](const auto& field, const auto& value) {
        const Note& note = field.note;
        if (note.elsewhere || (note.if_any && is_none(value))) return;
        json[field.name] =
            note.whole_null && is_none(value) ? Json(nullptr) : json_in(item, value, note);
    });
    return json;
}

template <class Item>
Item item_of(const Json& json);

template <class T>
T value_of(const Json& json, const Note& note);

template <class T>
std::vector<T> values_of(const Json& json, const Note& note) {
    if (std::is_integral_v<T> || std::is_same_v<T, std::string> || note.null == Null::refused)
        if constexpr (!Listed<T> && !is_a<T, std::pair>) return json.get<std::vector<T>>();
    std::vector<T> values;
    if constexpr (is_a<T, std::pair>) {
        for (const auto& [name, value] : json.items()) values.emplace_back(name, number_of(value));
        return values;
    } else {
        Note of_each = note;
        of_each.rows = false;
        for (const Json& item : json)
            if (!note.rows)
                values.push_back(value_of<T>(item, note));
            else
                for (T& value : values_of<T>(item, of_each)) values.push_back(std::move(value));
        return values;
    }
}

template <class T>
T value_of(const Json& json, const Note& note) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    if constexpr (std::is_same_v<T, AppliedCorrection>)
        return correction_of(json);
    else if constexpr (Listed<T>)
        return item_of<T>(json);
    else if constexpr (std::is_same_v<T, double>)
        return number_of(json, note.null == Null::infinity ? HUGE_VAL : nan);
    else if constexpr (array_size<T> == 3)
        return vector_of(json);
    else if constexpr (array_size<T> > 3)
        return matrix_of<array_size<T>>(json);
    else if constexpr (is_a<T, std::map>)
        return numbers_by_name_of(json);
    else if constexpr (is_a<T, std::vector>)
        return values_of<typename T::value_type>(json, note);
    else
        return json.get<T>();
}

// What earlier versions did not write stays as a new item has it. Throws nlohmann's exceptions for
// what is none.
template <class Item>
Item item_of(const Json& json) {
    Item item;
    if constexpr (std::is_same_v<Item, Object>) {  // a new one is not of unknown category
        item.unsafety_category.clear();
        item.unsafety_certain = false;
    }
    fields<Item>([&](const auto& field) {
        const Note& note = field.note;
        if (note.elsewhere || (note.since && !json.contains(note.since))) return;
        const Json& value = json.at(field.name);
        if (note.whole_null && value.is_null()) return;
        auto& to = item.*field.member;
        to = value_of<std::remove_reference_t<decltype(to)>>(value, note);
    });
    if constexpr (std::is_same_v<Item, DirectedBarrier>)  // as many as there are of the others
        if (!json.contains("blow_Ns"))
            item.blow_Ns.assign(item.blow_J.size(), std::numeric_limits<double>::quiet_NaN());
    return item;
}

}  // namespace

OrderedJson scene_document(const Scene& scene) {
    Json json{{"schema", scene_schema}};
    json.update(json_of_item(scene));
    return json;
}

std::string scene_json(const Scene& scene) {
    return scene_document(scene).dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_scene_json(const std::filesystem::path& file, const Scene& scene) {
    write_file(file, scene_json(scene));
}

Scene read_scene_json(const FileName& name) {
    return read_document(name, "scene.json", scene_schema, [&](const Json& json) {
        Scene scene = item_of<Scene>(json);
        check_scene(scene, name.path());
        return scene;
    });
}

}  // namespace topple::io

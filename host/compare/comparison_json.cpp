// SPDX-License-Identifier: MIT
#include "compare/comparison_json.h"

#include "core/json.h"
#include "io/json_values.h"

namespace topple::comparing {
namespace {

constexpr const char* comparison_schema = "topple.comparison/1";

using Json = OrderedJson;

// An object as far as a comparison is about it.
Json object_json(const Scene& scene, std::int32_t id) {
    if (id < 0) return nullptr;
    const Object& object = scene.objects[static_cast<std::size_t>(id)];
    Json out{{"object", id}};
    if (!object.name.empty()) out["name"] = object.name;
    out["box_middle_m"] = io::vector(object.box_middle_m);
    out["size_m"] = io::vector(object.size_m);
    out["mass_kg"] = io::number(object.mass_kg);
    out["unsafety_category"] = object.unsafety_category;
    out["risk_J"] = io::numbers_by_name(object.risk_J);
    auto on = Json::array();
    for (const Support& support : scene.supports)
        if (support.supported == id) on.push_back(support.supporter);
    out["stands_on"] = std::move(on);
    return out;
}

}  // namespace

std::string comparison_json(const Comparison& found) {
    const Alignment& laid = found.alignment;
    Json json{{"schema", comparison_schema},
              {"a", found.a.source},
              {"b", found.b.source},
              {"alignment",
               {{"a_from_b", io::matrix(laid.a_from_b)},
                {"same_frame", laid.same_frame},
                {"seen", io::number(laid.seen)},
                {"agreeing", io::number(laid.agreeing)},
                {"next_agreeing", io::number(laid.next_agreeing)},
                {"error_m", io::number(laid.error_m)}}}};
    json["things"] = io::list(found.things, [&](const ComparedThing& thing) {
        return Json{{"became", to_string(thing.became)},
                    {"a", object_json(found.a, thing.a)},
                    {"b", object_json(found.b, thing.b)},
                    {"moved_m", io::number(thing.moved_m)},
                    {"free", io::number(thing.free)},
                    {"solid", io::number(thing.solid)},
                    {"less_safe", thing.less_safe},
                    {"safer", thing.safer},
                    {"stands_otherwise", thing.stands_otherwise}};
    });
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace topple::comparing

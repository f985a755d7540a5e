// SPDX-License-Identifier: MIT
#include "result/things_json.h"

#include <cstddef>

#include "core/json.h"
#include "io/file_writer.h"
#include "io/json_values.h"

namespace topple::io {
namespace {

constexpr const char* things_schema = "topple.things/1";

}  // namespace

void write_things_json(const std::filesystem::path& file, const LiveScene& found) {
    auto json = OrderedJson::object();
    json["schema"] = things_schema;
    json["frames"] = found.frames;
    json["things"] = list(found.things, [&](const Thing& thing) {
        auto out = OrderedJson::object();
        out["id"] = thing.id;
        out["object"] = thing.object;
        out["change"] = to_string(thing.change);
        out["moved_m"] = number(thing.moved_m);
        if (thing.object >= 0) {
            const Object& object =
                found.result->scene.objects[static_cast<std::size_t>(thing.object)];
            if (!object.name.empty()) out["name"] = object.name;
        }
        return out;
    });
    write_file(file, json.dump(1, ' ', false, OrderedJson::error_handler_t::replace) + "\n");
}

}  // namespace topple::io

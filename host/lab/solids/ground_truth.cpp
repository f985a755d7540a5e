// SPDX-License-Identifier: MIT
#include "lab/solids/ground_truth.h"

#include <nlohmann/json.hpp>

#include "io/file_writer.h"

namespace topple::scenes {

using nlohmann::json;

json part_json(const Part& p) {
    json out{
        {"kind", to_string(p.shape)}, {"center", p.center}, {"size", p.size},      {"yaw", p.yaw},
        {"top_ratio", p.top_ratio},   {"name", p.name},     {"volume", p.volume()}};
    if (p.lean != 0) out["lean"] = p.lean;
    if (p.shape == Shape::rounded_box) out["rounding"] = p.rounding;
    if (p.shape == Shape::revolved) out["profile"] = p.profile;
    return out;
}

json parts_json(const World& world) {
    json parts = json::array();
    for (std::size_t k = 0; k < world.parts.size(); ++k) {
        const Part& p = world.parts[k];
        parts.push_back(part_json(p));
        parts.back()["id"] = k;
        parts.back()["object"] = p.object;
    }
    return parts;
}

void write_truth(const std::filesystem::path& path, const World& world) {
    json objects = json::array();
    for (std::size_t k = 0; k < world.objects.size(); ++k) {
        objects.push_back(
            {{"id", k}, {"name", world.objects[k].name}, {"where", world.objects[k].where}});
    }
    const auto& t = world.tilt;
    const json root{{"seed", world.seed},
                    {"tilt", {{t[0], t[1], t[2]}, {t[3], t[4], t[5]}, {t[6], t[7], t[8]}}},
                    {"room", world.room},
                    {"parts", parts_json(world)},
                    {"objects", objects},
                    {"fixed", world.fixed},
                    {"support", world.support}};
    io::write_file(path, root.dump(1) + "\n");
}

}  // namespace topple::scenes

// SPDX-License-Identifier: MIT
#include "lab/solids/ground_truth.h"

#include <nlohmann/json.hpp>

#include "io/file_writer.h"
#include "io/text.h"
#include "lab/solids/part_json.h"
#include "topple/error.h"

namespace topple::scenes {
namespace {

using nlohmann::json;

Shape shape_of(const std::string& kind) {
    for (const Shape shape : {Shape::box, Shape::rounded_box, Shape::cylinder,
                              Shape::lying_cylinder, Shape::sphere, Shape::cone, Shape::revolved}) {
        if (kind == to_string(shape)) return shape;
    }
    throw Error(ErrorKind::input, "ground truth: a part is of the unknown kind \"" + kind + "\"");
}

World from_json(const json& root) {
    World world;
    world.seed = root.value("seed", std::uint64_t{0});
    world.room = root.value("room", Vec3{});
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column) {
            world.tilt[3 * row + column] = root.at("tilt").at(row).at(column).get<double>();
        }
    }
    for (const json& o : root.at("objects")) {
        const json& where = o.at("where");
        world.objects.push_back(
            {o.at("name").get<std::string>(), where.is_string() ? where.get<std::string>() : ""});
    }
    for (const json& p : root.at("parts")) {
        Part part;
        part.shape = shape_of(p.at("kind").get<std::string>());
        part.center = p.at("center").get<Vec3>();
        part.size = p.at("size").get<Vec3>();
        part.yaw = p.at("yaw").get<double>();
        part.top_ratio = p.value("top_ratio", 0.0);
        part.lean = p.value("lean", 0.0);
        part.rounding = p.value("rounding", 0.0);
        part.profile = p.value("profile", solids::Profile{});
        part.object = p.at("object").get<std::int32_t>();
        part.name = p.at("name").get<std::string>();
        if (part.object < 0 || static_cast<std::size_t>(part.object) >= world.objects.size()) {
            throw Error(ErrorKind::input, "ground truth: a part belongs to object " +
                                              std::to_string(part.object) + " of " +
                                              std::to_string(world.objects.size()));
        }
        world.parts.push_back(std::move(part));
    }
    const auto pairs = [&](const char* key) {
        auto list = root.at(key).get<std::vector<std::pair<std::int32_t, std::int32_t>>>();
        const auto count = static_cast<std::int32_t>(world.parts.size());
        for (const auto& [a, b] : list) {
            if (a < 0 || b < 0 || a >= count || b >= count) {
                throw Error(ErrorKind::input, std::string("ground truth: ") + key + " names part " +
                                                  std::to_string(std::max(a, b)) + " of " +
                                                  std::to_string(count));
            }
        }
        return list;
    };
    world.fixed = pairs("fixed");
    world.support = pairs("support");
    return world;
}

}  // namespace

json part_json(const Part& p) {
    json out{
        {"kind", to_string(p.shape)}, {"center", p.center}, {"size", p.size},      {"yaw", p.yaw},
        {"top_ratio", p.top_ratio},   {"name", p.name},     {"volume", p.volume()}};
    if (p.lean != 0) out["lean"] = p.lean;
    if (p.shape == Shape::rounded_box) out["rounding"] = p.rounding;
    if (p.shape == Shape::revolved) out["profile"] = p.profile;
    return out;
}

void write_truth(const std::filesystem::path& path, const World& world) {
    json parts = json::array(), objects = json::array();
    for (std::size_t k = 0; k < world.parts.size(); ++k) {
        const Part& p = world.parts[k];
        parts.push_back(part_json(p));
        parts.back()["id"] = k;
        parts.back()["object"] = p.object;
    }
    for (std::size_t k = 0; k < world.objects.size(); ++k) {
        objects.push_back(
            {{"id", k}, {"name", world.objects[k].name}, {"where", world.objects[k].where}});
    }
    const auto& t = world.tilt;
    const json root{{"seed", world.seed},
                    {"tilt", {{t[0], t[1], t[2]}, {t[3], t[4], t[5]}, {t[6], t[7], t[8]}}},
                    {"room", world.room},
                    {"parts", parts},
                    {"objects", objects},
                    {"fixed", world.fixed},
                    {"support", world.support}};
    io::write_file(path, root.dump(1) + "\n");
}

World read_truth(const std::filesystem::path& path) {
    const io::FileBytes bytes = io::read_file(path);
    try {
        return from_json(json::parse(bytes.text()));
    } catch (const json::exception& error) {
        throw Error(ErrorKind::input, path.string() + ": " + error.what());
    }
}

}  // namespace topple::scenes

// SPDX-License-Identifier: MIT
#include "result/landscapes_json.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "core/json.h"
#include "io/file_writer.h"
#include "io/json_text.h"
#include "io/json_values.h"
#include "io/text.h"

namespace topple::io {
namespace {

using Json = OrderedJson;

constexpr const char* landscapes_schema = "topple.landscapes/1";

double rounded(double value, int digits) {
    if (value == 0 || !std::isfinite(value)) return value;
    const double scale = std::pow(10, digits - 1 - std::floor(std::log10(std::abs(value))));
    return std::round(value * scale) / scale;
}

Json rounded_number(double value) {
    return std::isfinite(value) ? Json(rounded(value, 6)) : Json(nullptr);
}

Json rounded_vector(const Vec3& v) {
    auto json = Json::array();
    for (const double x : v) json.push_back(std::round(x * 1e4) / 1e4);
    return json;
}

// A line, of which points that are one after rounding are written once.
Json rounded_line(const std::vector<Vec3>& all) {
    auto json = Json::array();
    for (const Vec3& v : all) {
        Json point = rounded_vector(v);
        if (json.empty() || point != json.back()) json.push_back(std::move(point));
    }
    return json;
}

Json places_json(const Landscape::Places& places) {
    auto energy = Json::array(), blocked = Json::array();
    for (std::size_t n = 0; n < places.energy_J.size(); ++n) {
        const float value = places.energy_J[n];
        energy.push_back(std::isfinite(value) ? Json(rounded(double{value}, 3)) : Json(nullptr));
        if (std::isinf(value)) blocked.push_back(n);
    }
    return {{"side", places.side},
            {"step_m", places.step_m},
            {"energy_J", std::move(energy)},
            {"blocked", std::move(blocked)}};
}

Json landscape_json(const Object& object) {
    const Landscape& l = object.landscape;
    const auto pose_json = [](const Landscape::Pose& pose) {
        return Json{{"up", rounded_vector(pose.up)},
                    {"energy_J", rounded_number(pose.energy_J)},
                    {"joins_at_J", rounded_number(pose.joins_at_J)},
                    {"joins", pose.joins},
                    {"probability", rounded_number(pose.probability)}};
    };
    const auto pass_json = [](const Landscape::Pass& pass) {
        return Json{{"up", rounded_vector(pass.up)},
                    {"energy_J", rounded_number(pass.energy_J)},
                    {"poses", pass.poses},
                    {"border", rounded_line(pass.border)}};
    };
    return {{"id", object.id},
            {"hull_m", list(l.hull_m, rounded_vector)},
            {"now", l.now},
            {"poses", list(l.poses, pose_json)},
            {"passes", list(l.passes, pass_json)},
            {"places", places_json(l.places)}};
}

Vec3 finite_vector_of(const Json& json) {
    return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

std::vector<Vec3> vectors_of(const Json& json) {
    std::vector<Vec3> out;
    for (const Json& v : json) out.push_back(finite_vector_of(v));
    return out;
}

// A number of a pose, of which there are `poses`, or -1.
std::int32_t pose_of(const Json& json, std::size_t poses, const std::filesystem::path& file) {
    const auto n = json.get<std::int64_t>();
    if (n < -1 || n >= static_cast<std::int64_t>(poses))
        fail(file, "names pose " + std::to_string(n) + " of " + std::to_string(poses));
    return static_cast<std::int32_t>(n);
}

// Each basin joins that of a deeper pose: following them ends.
void check_joins(const Landscape& l, const std::filesystem::path& file) {
    for (const Landscape::Pose& pose : l.poses) {
        std::size_t steps = 0;
        for (std::int32_t n = pose.joins; n >= 0; n = l.poses[n].joins) {
            if (++steps > l.poses.size()) fail(file, "has poses that join one another in a circle");
        }
    }
}

Landscape landscape_of(const Json& json, const std::filesystem::path& file) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    Landscape l;
    l.hull_m = vectors_of(json.at("hull_m"));
    const Json& poses = json.at("poses");
    l.now = pose_of(json.at("now"), poses.size(), file);
    for (const Json& pose : poses) {
        l.poses.push_back(
            {finite_vector_of(pose.at("up")), pose.at("energy_J").get<double>(),
             number_of(pose.at("joins_at_J"), std::numeric_limits<double>::infinity()),
             pose_of(pose.at("joins"), poses.size(), file),
             number_of(pose.at("probability"), nan)});
    }
    check_joins(l, file);
    for (const Json& pass : json.at("passes")) {
        const Json& sides = pass.at("poses");
        Landscape::Pass out{finite_vector_of(pass.at("up")),
                            pass.at("energy_J").get<double>(),
                            {},
                            vectors_of(pass.at("border"))};
        for (std::size_t side = 0; side < 2; ++side) {
            out.poses[side] = pose_of(sides.at(side), poses.size(), file);
            if (out.poses[side] < 0) fail(file, "has a pass without two poses");
        }
        l.passes.push_back(std::move(out));
    }
    const Json& places = json.at("places");
    l.places.side = places.at("side").get<std::int32_t>();
    l.places.step_m = places.at("step_m").get<double>();
    for (const Json& value : places.at("energy_J"))
        l.places.energy_J.push_back(value.is_number() ? value.get<float>() : nan);
    for (const Json& place : places.value("blocked", Json::array())) {  // not in older outputs
        const auto n = place.get<std::uint64_t>();
        if (n >= l.places.energy_J.size())
            fail(file, "has no place " + std::to_string(n) + ", which something is in the way of");
        l.places.energy_J[n] = std::numeric_limits<float>::infinity();
    }
    const std::int64_t side = l.places.side;
    if (side < 0 || side * side != static_cast<std::int64_t>(l.places.energy_J.size()))
        fail(file, "has " + std::to_string(l.places.energy_J.size()) + " places for " +
                       std::to_string(side) + " in a row");
    return l;
}

}  // namespace

void write_landscapes_json(const std::filesystem::path& file, const Scene& scene) {
    auto objects = Json::array();
    for (const Object& object : scene.objects) {
        if (!object.grounded) objects.push_back(landscape_json(object));
    }
    const Json json{{"schema", landscapes_schema}, {"objects", std::move(objects)}};
    write_file(file, json.dump() + "\n");
}

void read_landscapes_json(const FileName& name, Scene& scene) {
    const std::filesystem::path& file = name.path();
    read_document(name, "landscapes.json", landscapes_schema, [&](const Json& json) {
        for (const Json& object : json.at("objects")) {
            const auto id = object.at("id").get<std::int64_t>();
            if (id < 0 || id >= static_cast<std::int64_t>(scene.objects.size()))
                fail(file, "is of another scene: it has an object " + std::to_string(id));
            scene.objects[id].landscape = landscape_of(object, file);
        }
    });
}

}  // namespace topple::io

// SPDX-License-Identifier: MIT
#include "export/bodies_json.h"

#include <cmath>

#include "core/json.h"

namespace topple::exports {
namespace {

OrderedJson json_or_null(double value) {
    return std::isfinite(value) ? OrderedJson(value) : OrderedJson(nullptr);
}

OrderedJson json_or_null(const Vec3& v) {
    for (const double x : v)
        if (!std::isfinite(x)) return nullptr;
    return {v[0], v[1], v[2]};
}

OrderedJson body_json(const ExportedBody& body) {
    return {
        {"name", body.name},
        {"object", body.object},
        {"fixed", body.fixed},
        {"on_pad", body.on_pad},
        {"held", body.held},
        {"struts", body.struts},
        {"moved_m", json_or_null(body.moved_m)},
        {"parts", body.parts},
        {"mass_kg", json_or_null(body.mass_kg)},
        {"solid_m3", json_or_null(body.solid_m3)},
        {"parts_m3", json_or_null(body.parts_m3)},
        {"excess_share", body.solid_m3 > 0 ? json_or_null(body.parts_m3 / body.solid_m3 - 1)
                                           : OrderedJson(nullptr)},
        {"lost_m3", json_or_null(body.lost_m3)},
        {"lost_share", body.solid_m3 > 0 ? json_or_null(body.lost_share()) : OrderedJson(nullptr)}};
}

}  // namespace

std::string bodies_json(const ExportSummary& summary) {
    OrderedJson bodies = OrderedJson::array();
    for (const ExportedBody& body : summary.bodies) bodies.push_back(body_json(body));
    const OrderedJson json{{"schema", bodies_schema},
                           {"deepest_overlap_m", json_or_null(summary.deepest_overlap_m)},
                           {"floor_m", json_or_null(summary.floor_m)},
                           {"free_place_m", json_or_null(summary.free_place_m)},
                           {"free_radius_m", json_or_null(summary.free_radius_m)},
                           {"notes", summary.notes},
                           {"bodies", std::move(bodies)}};
    return json.dump(1) + "\n";
}

}  // namespace topple::exports

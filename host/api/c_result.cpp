// SPDX-License-Identifier: MIT
#include "api/c_result.h"

#include <limits>
#include <map>
#include <string>

#include "api/c_support.h"
#include "safety/disturbances.h"
#include "topple/frame_labels.h"
#include "topple/stays.h"

using namespace topple;
using namespace topple::c_api;

namespace {

void copy_vector(const Vec3& from, double (&to)[3]) {
    std::copy(from.begin(), from.end(), to);
}

const Scene& scene_of(const topple_result* result) {
    return needed(result, "result").result.scene;
}

template <class Item>
const Item& item(const std::vector<Item>& items, std::uint64_t index, const char* what) {
    if (index >= items.size()) {
        throw Error(ErrorKind::usage, std::string(what) + " " + std::to_string(index) +
                                          ": there are " + std::to_string(items.size()));
    }
    return items[index];
}

// NaN: that disturbance was not reckoned with.
double figure(const std::map<std::string, double>& by_disturbance, const std::string& name) {
    const auto found = by_disturbance.find(name);
    return found == by_disturbance.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

}  // namespace

int topple_result_scene(const topple_result* result, topple_scene* scene, topple_status* status) {
    return guarded(status, [&] {
        const Scene& from = scene_of(result);
        topple_scene to{};
        to.source = from.source.c_str();
        to.backend = from.backend.c_str();
        to.device = from.device.c_str();
        to.up_method = from.up_method.c_str();
        to.voxel_size_m = from.voxel_size_m;
        to.density_kg_m3 = from.density_kg_m3;
        to.friction = from.friction;
        copy_vector(from.up, to.up);
        std::copy(from.manhattan_from_input.begin(), from.manhattan_from_input.end(),
                  to.manhattan_from_input);
        to.seed = from.seed;
        to.points = from.points.primitive.size();
        to.primitives = from.primitives.size();
        to.objects = from.objects.size();
        to.contacts = from.contacts.size();
        to.supports = from.supports.size();
        to.notes = from.notes.size();
        to.corrections = from.corrections.size();
        give(to, scene, "scene");
    });
}

int topple_result_primitive(const topple_result* result, uint64_t index,
                            topple_primitive* primitive, topple_status* status) {
    return guarded(status, [&] {
        const Primitive& from = item(scene_of(result).primitives, index, "primitive");
        topple_primitive to{};
        to.id = from.id;
        to.object = from.object;
        to.model = from.model.c_str();
        to.points = from.points;
        to.solid_voxels = from.solid_voxels;
        to.volume_m3 = from.volume_m3;
        to.mass_kg = from.mass_kg;
        copy_vector(from.center_of_mass_m, to.center_of_mass_m);
        to.name = from.name.c_str();
        give(to, primitive, "primitive");
    });
}

int topple_result_object(const topple_result* result, uint64_t index, topple_object* object,
                         topple_status* status) {
    return guarded(status, [&] {
        const Object& from = item(scene_of(result).objects, index, "object");
        topple_object to{};
        to.id = from.id;
        to.grounded = from.grounded;
        to.primitives = result->objects[index].primitives;
        to.primitive_count = from.primitives.size();
        to.mass_kg = from.mass_kg;
        copy_vector(from.size_m, to.size_m);
        copy_vector(from.center_of_mass_m, to.center_of_mass_m);
        to.barrier_J = from.barrier_J;
        to.barrier_error_J = from.barrier_error_J;
        to.release_J = from.release_J;
        to.mode = from.mode.c_str();
        copy_vector(from.direction, to.direction);
        to.instability = result->objects[index].instability;
        to.instability_count = from.instability.size();
        to.unsafety = from.unsafety;
        to.agreement = from.agreement;
        to.why = from.why.sentence.c_str();
        to.advice = from.advice.sentence.c_str();
        to.mass_error_kg = from.mass_error_kg;
        copy_vector(from.center_of_mass_error_m, to.center_of_mass_error_m);
        to.footprint_error_m = from.footprint_error_m;
        to.mass_model = from.mass_model.c_str();
        std::ranges::copy(from.inertia_kg_m2, to.inertia_kg_m2);
        to.tilt_deg = from.overturning.tilt_deg;
        to.tilt_error_deg = from.overturning.tilt_error_deg;
        copy_vector(from.overturning.direction, to.overturning_direction);
        to.push_N = from.overturning.push_N;
        to.push_error_N = from.overturning.push_error_N;
        to.slide_N = from.overturning.slide_N;
        to.shake_g = from.overturning.shake_g;
        to.fragility_pga_g = from.fragility.pga_g;
        to.fragility_pga_dispersion = from.fragility.pga_dispersion;
        to.fragility_firm_pga_g = from.fragility.firm_pga_g;
        to.fragility_pgv_m_s = from.fragility.pgv_m_s;
        to.fragility_pgv_dispersion = from.fragility.pgv_dispersion;
        to.falls_per_year = from.fragility.falls_per_year;
        to.return_years = from.fragility.return_years;
        to.blow_height_m = result->objects[index].blow_height_m;
        to.push_barrier_J = result->objects[index].push_barrier_J;
        to.blow_barrier_J = result->objects[index].blow_barrier_J;
        to.blow_heights = from.barrier_by_direction.height_m.size();
        to.hand_push_N = from.overturning.hand_push_N;
        to.hand_push_error_N = from.overturning.hand_push_error_N;
        to.hand_height_m = from.overturning.hand_height_m;
        to.gust_m_s = from.overturning.gust_m_s;
        to.gust_error_m_s = from.overturning.gust_error_m_s;
        copy_vector(from.fall.lands_m, to.lands_m);
        to.hits_J = from.fall.hits_J;
        to.people_share = from.fall.people_share;
        to.falls = from.fall.falls;
        to.lands_on = from.fall.lands_on;
        to.unsafety_category = from.unsafety_category.c_str();
        to.unsafety_certain = from.unsafety_certain;
        to.name = from.name.c_str();
        to.corrected = result->corrected[index];
        to.corrected_count = from.corrected.size();
        to.push_direction = result->objects[index].push_direction;
        to.push_by_direction_N = result->objects[index].push_N;
        to.push_error_by_direction_N = result->objects[index].push_error_N;
        to.why_azimuth_deg = from.why.azimuth_deg;
        to.why_edge_m = result->objects[index].edge_m;
        to.why_edge_ends = from.why.edge_m.size();
        to.why_way_m = from.why.way_m;
        to.why_drop_m = from.why.drop_m;
        to.stands_on = result->objects[index].stands_on;
        to.stands_on_count = from.why.stands_on.size();
        to.advice_kind = from.advice.kind.c_str();
        copy_vector(from.advice.move_m, to.advice_move_m);
        to.advice_risk_J = from.advice.risk_J;
        to.hold_N = from.advice.hold_N;
        to.hold_height_m = from.advice.hold_height_m;
        to.why_lands_on = from.why.lands_on;
        to.piece_of = from.piece_of;
        to.piece_probability = from.piece_probability;
        to.joint_probability = from.joint_probability;
        std::ranges::copy(from.weakest_joint, to.weakest_joint);
        copy_vector(from.box_middle_m, to.box_middle_m);
        to.action = from.advice.action.c_str();
        to.support_height_m = from.support_height_m;
        to.center_height_m = from.center_height_m;
        to.blow_barrier_Ns = result->objects[index].blow_barrier_Ns;
        give(to, object, "object");
    });
}

int topple_result_contact(const topple_result* result, uint64_t index, topple_contact* contact,
                          topple_status* status) {
    return guarded(status, [&] {
        const Contact& from = item(scene_of(result).contacts, index, "contact");
        topple_contact to{};
        to.a = from.a;
        to.b = from.b;
        to.area_m2 = from.area_m2;
        copy_vector(from.normal, to.normal);
        to.relation = from.relation.c_str();
        to.probability = from.probability;
        give(to, contact, "contact");
    });
}

int topple_result_support(const topple_result* result, uint64_t index, topple_support* support,
                          topple_status* status) {
    return guarded(status, [&] {
        const Support& from = item(scene_of(result).supports, index, "support");
        give(topple_support{sizeof(topple_support), from.supporter, from.supported, from.area_m2},
             support, "support");
    });
}

int topple_result_correction(const topple_result* result, uint64_t index,
                             topple_correction* correction, topple_status* status) {
    return guarded(status, [&] {
        const AppliedCorrection& from = item(scene_of(result).corrections, index, "correction");
        topple_correction to{};
        to.what = to_string(from.correction.kind);
        to.outcome = from.outcome.c_str();
        to.held = from.held;
        to.objects = result->corrections[index];
        to.object_count = from.objects.size();
        give(to, correction, "correction");
    });
}

int topple_result_risk(const topple_result* result, uint64_t index, const char* disturbance,
                       double* risk_J, double* fall_chance, topple_status* status) {
    return guarded(status, [&] {
        const Object& from = item(scene_of(result).objects, index, "object");
        const std::string name = disturbance ? disturbance : "";
        safety::disturbance_kind(name);
        if (risk_J) *risk_J = figure(from.risk_J, name);
        if (fall_chance) *fall_chance = figure(from.fall_chance, name);
    });
}

int topple_result_risk_error(const topple_result* result, uint64_t index, const char* disturbance,
                             double* error_J, double* spread_J, topple_status* status) {
    return guarded(status, [&] {
        const Object& from = item(scene_of(result).objects, index, "object");
        const std::string name = disturbance ? disturbance : "";
        safety::disturbance_kind(name);
        if (error_J) *error_J = figure(from.risk_error_J, name);
        if (spread_J) *spread_J = figure(from.risk_spread_J, name);
    });
}

int topple_result_stays(const topple_result* result, uint64_t index, const double* place_m,
                        const double* way, double force_N, double impulse_Ns, double slack_m,
                        int* stays, topple_status* status) {
    return guarded(status, [&] {
        needed(stays, "stays") = 0;
        const Scene& scene = scene_of(result);
        Touch touch{{}, {}, force_N, impulse_Ns, slack_m};
        std::copy_n(&needed(place_m, "place_m"), 3, touch.place_m.begin());
        if (way) std::copy_n(way, 3, touch.way.begin());
        *stays = topple::stays(scene, item(scene.objects, index, "object"), touch);
    });
}

const char* topple_disturbance_name(uint32_t index) {
    const auto kinds = safety::disturbance_kinds();
    return index < kinds.size() ? kinds[index]->name : nullptr;
}

const char* topple_result_note(const topple_result* result, uint64_t index) {
    if (!result || index >= result->result.scene.notes.size()) return nullptr;
    return result->result.scene.notes[index].c_str();
}

const int32_t* topple_result_point_primitives(const topple_result* result) {
    return result ? result->primitive : nullptr;
}

const int32_t* topple_result_point_objects(const topple_result* result) {
    return result ? result->object : nullptr;
}

const float* topple_result_point_normals(const topple_result* result, int axis) {
    return result && axis >= 0 && axis < 3 ? result->normal[axis] : nullptr;
}

const uint64_t* topple_result_point_index(const topple_result* result) {
    return result ? result->index : nullptr;
}

struct topple_labeller {
    FrameLabeller labeller;
};

int topple_labeller_create(const topple_result* result, topple_labeller** labeller,
                           topple_status* status) {
    return guarded(status, [&] {
        needed(labeller, "labeller") = nullptr;
        *labeller = new topple_labeller{FrameLabeller(needed(result, "result").result)};
    });
}

int topple_labeller_label(const topple_labeller* labeller, const topple_frames* frames,
                          uint64_t number, int32_t* primitives, int32_t* objects,
                          topple_status* status) {
    return guarded(status, [&] {
        const FrameLabels found =
            needed(labeller, "labeller").labeller.label(frames_of(frames), number);
        if (primitives) std::ranges::copy(found.primitive, primitives);
        if (objects) std::ranges::copy(found.object, objects);
    });
}

void topple_labeller_release(topple_labeller* labeller) {
    delete labeller;
}

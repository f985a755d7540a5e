// SPDX-License-Identifier: MIT
#include "api/c_result.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "api/c_support.h"
#include "core/field_rules.h"
#include "core/result_fields.h"
#include "io/text.h"
#include "safety/disturbances.h"
#include "topple/ask.h"
#include "topple/frame_labels.h"
#include "topple/stays.h"

using namespace topple;
using namespace topple::c_api;

namespace {

static_assert(sizeof(topple_step) == sizeof(InstabilityStep) &&
              offsetof(topple_step, S_J) == offsetof(InstabilityStep, S_J));

// Of lists C has the values, or how many there are.
template <class From, class To>
void put(Arrays& arrays, const From& from, To& to) {
    if constexpr (std::is_array_v<To>)
        std::ranges::copy(from, to);
    else if constexpr (std::is_convertible_v<From, To>)
        to = from;
    else if constexpr (std::is_same_v<To, const char*>)
        to = from.c_str();
    else if constexpr (std::is_integral_v<To>)
        to = from.size();
    else
        to = reinterpret_cast<To>(arrays.hand(from));
}

// All of an item, and of what is in it, that the struct has members for.
template <class Item, class To>
void put_fields(Arrays& arrays, const Item& item, To& to) {
    fields(item, [&](const auto& field, const auto& value) {
        if constexpr (Listed<std::remove_cvref_t<decltype(value)>>)
            put_fields(arrays, value, to);
        else
            std::apply([&](const auto... members) { (put(arrays, value, to.*members), ...); },
                       field.to_c);
    });
}
template <class Item, class To>
void put_all(Arrays& arrays, const std::vector<Item>& items, std::vector<To>& to) {
    to.resize(items.size());
    for (std::size_t n = 0; n < items.size(); ++n) put_fields(arrays, items[n], to[n]);
}

// What a field of that name holds, "mass_kg" or "fall.hits_J"; none: there is none, or no numbers.
template <class Item>
std::optional<std::vector<double>> numbers_of(const Item& item, std::string_view name) {
    std::optional<std::vector<double>> found;
    fields(item, [&](const auto& field, const auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        const std::string_view own = field.name;
        if constexpr (Listed<Value>) {
            if (name.starts_with(own) && name.substr(own.size()).starts_with('.'))
                found = numbers_of(value, name.substr(own.size() + 1));
        } else if constexpr (of_numbers<Value>) {
            if (name != own) return;
            found.emplace();
            // each() ends at what does not hold.
            rules::each(value, [&](const auto& v) {
                found->push_back(static_cast<double>(v));
                return true;
            });
        }
    });
    return found;
}

const Scene& scene_of(const topple_result* result) {
    return needed(result, "result").result.scene;
}

// An item of one of the result's lists, as C has it.
template <class Item>
int give_item(const topple_result* result, const std::vector<Item> topple_result::*items,
              std::uint64_t index, Item* to, const char* what, topple_status* status) {
    return guarded(status,
                   [&] { give(item(needed(result, "result").*items, index, what), to, what); });
}

// The first `capacity` of a list, and how many there are.
template <class T>
void give_list(const std::vector<T>& from, const char* name, T* to, std::uint64_t capacity,
               std::uint64_t& count) {
    count = from.size();
    if (capacity > 0)
        std::copy_n(from.begin(), std::min<std::uint64_t>(capacity, count), &needed(to, name));
}

// NaN: that disturbance was not reckoned with.
double figure(const std::map<std::string, double>& by_disturbance, const std::string& name) {
    const auto found = by_disturbance.find(name);
    return found == by_disturbance.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

// Two figures of an object by the disturbance, where the caller wants them.
using ByDisturbance = std::map<std::string, double> Object::*;
int give_figures(const topple_result* result, std::uint64_t index, const char* disturbance,
                 ByDisturbance first, double* first_to, ByDisturbance second, double* second_to,
                 topple_status* status) {
    return guarded(status, [&] {
        const Object& from = item(scene_of(result).objects, index, "object");
        const std::string name = disturbance ? disturbance : "";
        safety::disturbance_kind(name);
        if (first_to) *first_to = figure(from.*first, name);
        if (second_to) *second_to = figure(from.*second, name);
    });
}

}  // namespace

topple_result::topple_result(ParseResult parsed, const topple_allocator* allocator)
    : result(std::move(parsed)), arrays(allocator) {
    const Scene& from = result.scene;
    put_fields(arrays, from, scene);
    put_all(arrays, from.primitives, primitives);
    put_all(arrays, from.objects, objects);
    put_all(arrays, from.contacts, contacts);
    put_all(arrays, from.supports, supports);
    put_all(arrays, from.corrections, corrections);
    scene.points = from.points.primitive.size();
    primitive = arrays.hand(from.points.primitive);
    object = arrays.hand(from.points.object);
    normal[0] = arrays.hand(from.points.nx);
    normal[1] = arrays.hand(from.points.ny);
    normal[2] = arrays.hand(from.points.nz);
    index = arrays.hand(from.points.index);
}

int topple_result_scene(const topple_result* result, topple_scene* scene, topple_status* status) {
    return guarded(status, [&] { give(needed(result, "result").scene, scene, "scene"); });
}

int topple_result_primitive(const topple_result* result, uint64_t index,
                            topple_primitive* primitive, topple_status* status) {
    return give_item(result, &topple_result::primitives, index, primitive, "primitive", status);
}

int topple_result_object(const topple_result* result, uint64_t index, topple_object* object,
                         topple_status* status) {
    return give_item(result, &topple_result::objects, index, object, "object", status);
}

int topple_result_contact(const topple_result* result, uint64_t index, topple_contact* contact,
                          topple_status* status) {
    return give_item(result, &topple_result::contacts, index, contact, "contact", status);
}

int topple_result_support(const topple_result* result, uint64_t index, topple_support* support,
                          topple_status* status) {
    return give_item(result, &topple_result::supports, index, support, "support", status);
}

int topple_result_correction(const topple_result* result, uint64_t index,
                             topple_correction* correction, topple_status* status) {
    return give_item(result, &topple_result::corrections, index, correction, "correction", status);
}

int topple_result_numbers(const topple_result* result, const char* of, uint64_t index,
                          const char* field, double* values, uint64_t capacity, uint64_t* count,
                          topple_status* status) {
    return guarded(status, [&] {
        needed(count, "count") = 0;
        const Scene& scene = scene_of(result);
        const std::string what = &needed(of, "of"), name = &needed(field, "field");
        array(values, "values", capacity);
        std::optional<std::vector<double>> found;
        if (what == "scene")
            found = numbers_of(scene, name);
        else if (what == "primitive")
            found = numbers_of(item(scene.primitives, index, "primitive"), name);
        else if (what == "object")
            found = numbers_of(item(scene.objects, index, "object"), name);
        else if (what == "contact")
            found = numbers_of(item(scene.contacts, index, "contact"), name);
        else if (what == "support")
            found = numbers_of(item(scene.supports, index, "support"), name);
        else if (what == "possible_thing")
            found = numbers_of(item(scene.possible_things, index, "possible thing"), name);
        if (!found)
            throw Error(ErrorKind::usage, "field: no numbers " + io::in_quotes(name) + " of " +
                                              io::in_quotes(what) +
                                              "; docs/output.md has the names");
        give_list(*found, "values", values, capacity, *count);
    });
}

int topple_result_risk(const topple_result* result, uint64_t index, const char* disturbance,
                       double* risk_J, double* fall_chance, topple_status* status) {
    return give_figures(result, index, disturbance, &Object::risk_J, risk_J, &Object::fall_chance,
                        fall_chance, status);
}

int topple_result_risk_error(const topple_result* result, uint64_t index, const char* disturbance,
                             double* error_J, double* spread_J, topple_status* status) {
    return give_figures(result, index, disturbance, &Object::risk_error_J, error_J,
                        &Object::risk_spread_J, spread_J, status);
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

int topple_result_stays_up_to(const topple_result* result, uint64_t index, const double* place_m,
                              const double* way, double* force_N, topple_status* status) {
    return guarded(status, [&] {
        needed(force_N, "force_N") = 0;
        const Scene& scene = scene_of(result);
        Vec3 place{}, towards{};
        std::copy_n(&needed(place_m, "place_m"), 3, place.begin());
        if (way) std::copy_n(way, 3, towards.begin());
        *force_N = stays_up_to_N(scene, item(scene.objects, index, "object"), place, towards);
    });
}

int topple_result_released(const topple_result* result, uint64_t index, double W_J,
                           double* released, topple_status* status) {
    return guarded(status, [&] {
        needed(released, "released_J") = 0;
        *released = released_J(item(scene_of(result).objects, index, "object"), W_J);
    });
}

int topple_result_falls_without(const topple_result* result, const int32_t* taken,
                                uint64_t taken_count, int32_t* ids, uint64_t capacity,
                                uint64_t* count, topple_status* status) {
    return guarded(status, [&] {
        needed(count, "count") = 0;
        array(taken, "taken", taken_count);
        std::vector<std::int32_t> falls;
        for (const Unheld& one :
             falls_without(scene_of(result), {taken, taken + taken_count}).falls)
            falls.push_back(one.object);
        give_list(falls, "ids", ids, capacity, *count);
    });
}

int topple_result_removal_order(const topple_result* result, int32_t before, int32_t* ids,
                                uint64_t capacity, uint64_t* count, topple_status* status) {
    return guarded(status, [&] {
        needed(count, "count") = 0;
        const Scene& scene = scene_of(result);
        std::vector<std::int32_t> order;
        for (const auto& step : before == -1 ? removal_steps(scene) : removal_steps(scene, before))
            order.insert(order.end(), step.begin(), step.end());
        give_list(order, "ids", ids, capacity, *count);
    });
}

int topple_result_held_by(const topple_result* result, int32_t object, int32_t* ids,
                          double* probabilities, uint64_t capacity, uint64_t* count,
                          topple_status* status) {
    return guarded(status, [&] {
        needed(count, "count") = 0;
        std::vector<std::int32_t> holders;
        std::vector<double> likely;
        for (const Holder& one : held_by(scene_of(result), object)) {
            holders.push_back(one.object);
            likely.push_back(one.probability);
        }
        give_list(holders, "ids", ids, capacity, *count);
        if (probabilities) give_list(likely, "probabilities", probabilities, capacity, *count);
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

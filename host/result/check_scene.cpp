// SPDX-License-Identifier: MIT
#include "result/check_scene.h"

#include <cmath>
#include <string>
#include <type_traits>
#include <utility>

#include "core/field_rules.h"
#include "core/result_fields.h"
#include "io/text.h"

namespace topple::io {
namespace {

class Checks {
  public:
    Checks(const Scene& scene, const std::filesystem::path& file) : scene_(scene), file_(file) {}

    void need(bool holds, const std::string& what) const {
        if (!holds) fail(file_, what + "; the file is damaged: parse the scan again");
    }
    // Each field by its rule, and those of what is in the item. who: names it, or is empty, so that
    // its fields are named. place: the item's number.
    template <class Item>
    void check(const Item& item, const std::string& who, std::size_t place = 0) const {
        fields(item, [&](const auto& field, const auto& value) {
            using Value = std::remove_cvref_t<decltype(value)>;
            const std::string named = who.empty() ? field.name : who;
            if constexpr (Listed<Value>)
                check(value, named, place);
            else if constexpr (of_numbers<Value>)
                if (!holds(field.note.rule, value, place))
                    need(false, named + problem(field.note.rule));
        });
        if constexpr (std::is_same_v<Item, DirectedBarrier>)
            need(complete(item),
                 who + " has barriers that are not one for each direction and height");
    }

  private:
    template <class Values>
    bool holds(Rule rule, const Values& values, std::size_t place) const {
        switch (rule) {
            case Rule::own_place: {
                const auto n = static_cast<double>(place);
                return rules::within(n, n)(values);
            }
            case Rule::primitives:
                return rules::ids(scene_.primitives.size())(values);
            case Rule::primitives_or_none:
                return rules::labels(scene_.primitives.size())(values);
            case Rule::objects:
                return rules::ids(scene_.objects.size())(values);
            case Rule::objects_or_none:
                return rules::labels(scene_.objects.size())(values);
            case Rule::corrections:
                return rules::within(1, static_cast<double>(scene_.corrections.size()))(values);
            case Rule::two_or_none:
                if constexpr (requires { values.empty(); }) return rules::length_or_none(2)(values);
                return true;
            case Rule::finite:
                return rules::finite(values);
            case Rule::any:
                return true;
        }
        return true;
    }
    static const char* problem(Rule rule) {
        switch (rule) {
            case Rule::own_place:
                return " has another id";
            case Rule::primitives:
            case Rule::primitives_or_none:
                return " names a primitive that there is not";
            case Rule::objects:
            case Rule::objects_or_none:
                return " names an object that there is not";
            case Rule::corrections:
                return " names a correction that there is not";
            case Rule::two_or_none:
                return " has no edge of two ends";
            default:
                return " holds what is no number";
        }
    }
    // Of blows there is a row of all heights for each direction.
    static bool complete(const DirectedBarrier& b) {
        const std::size_t blows = b.push_J.size() * b.height_m.size();
        const auto of_each = rules::length_or_none(DirectedBarrier::directions);
        return of_each(b.push_J) && of_each(b.direction) && b.blow_J.size() == blows &&
               b.blow_Ns.size() == blows && b.push_error_N.size() == b.push_N.size() &&
               rules::length_or_none(b.direction.size())(b.push_N);  // none of what hangs
    }

    const Scene& scene_;
    const std::filesystem::path& file_;
};

}  // namespace

void check_scene(const Scene& scene, const std::filesystem::path& file) {
    const Checks checks(scene, file);
    for (std::size_t n = 0; n < scene.objects.size(); ++n)
        checks.check(scene.objects[n], "object " + std::to_string(n), n);
    for (std::size_t n = 0; n < scene.primitives.size(); ++n)
        checks.check(scene.primitives[n], "primitive " + std::to_string(n), n);
    for (const Contact& c : scene.contacts) checks.check(c, "a contact");
    for (const Support& s : scene.supports) checks.check(s, "a support");
    for (const PossibleThing& p : scene.possible_things) checks.check(p, "a possible thing");
    for (const AppliedCorrection& c : scene.corrections) checks.check(c, "a correction");
    checks.check(scene, "");
}

void check_bodies(const Scene& scene, const std::filesystem::path& file) {
    const Checks checks(scene, file);
    for (const Object& o : scene.objects) {
        const bool known = rules::finite(o.center_of_mass_m) &&
                           (o.grounded || (o.mass_kg > 0 && std::isfinite(o.mass_kg) &&
                                           rules::finite(o.inertia_kg_m2)));
        checks.need(known,
                    "object " + std::to_string(o.id) + " has no mass, centre of mass or inertia");
    }
}

}  // namespace topple::io

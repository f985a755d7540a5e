// SPDX-License-Identifier: MIT
#include "io/check_scene.h"

#include <cmath>
#include <string>
#include <utility>

#include "core/field_rules.h"
#include "io/text.h"

namespace topple::io {
namespace {

class Checks {
  public:
    Checks(const Scene& scene, const std::filesystem::path& file) : scene_(scene), file_(file) {}

    void need(bool holds, const std::string& what) const {
        if (!holds) fail(file_, what + "; the file is damaged: parse the scan again");
    }
    // All that is named: ids, or -1 where that means none.
    template <class Ids>
    void primitives(const Ids& ids, const std::string& who) const {
        need(rules::ids(scene_.primitives.size())(ids),
             who + " names a primitive that there is not");
    }
    template <class Ids>
    void objects(const Ids& ids, const std::string& who) const {
        need(rules::ids(scene_.objects.size())(ids), who + " names an object that there is not");
    }
    void object_or_none(std::int32_t id, const std::string& who) const {
        if (id != -1) objects(id, who);
    }

    void check(const Object& o, std::size_t number) const {
        const std::string name = "object " + std::to_string(number);
        need(rules::is_id(o.id, number + 1) && o.id == static_cast<std::int64_t>(number),
             name + " has another id");
        primitives(o.primitives, name);
        for (const std::int32_t p : o.weakest_joint)
            if (p != -1) primitives(p, name);
        for (const std::int32_t other :
             {o.piece_of, o.why.lands_on, o.fall.lands_on, o.fall.leans_on})
            object_or_none(other, name);
        objects(o.why.stands_on, name);
        objects(o.fall.takes_along, name);
        need(o.why.edge_m.empty() || o.why.edge_m.size() == 2, name + " has no edge of two ends");
        for (const std::int32_t c : o.corrected)
            need(rules::is_id(std::int64_t{c} - 1, scene_.corrections.size()),
                 name + " names a correction that there is not");
        check(o.barrier_by_direction, name);
    }
    // Of blows there is a row of all heights for each direction.
    void check(const DirectedBarrier& b, const std::string& name) const {
        const std::size_t blows = b.push_J.size() * b.height_m.size();
        const auto of_each = [](const auto& list) {
            return list.empty() || list.size() == DirectedBarrier::directions;
        };
        need(of_each(b.push_J) && of_each(b.direction) && b.blow_J.size() == blows &&
                 b.blow_Ns.size() == blows && b.push_N.size() == b.direction.size() &&
                 b.push_error_N.size() == b.direction.size(),
             name + " has barriers that are not one for each direction and height");
    }

  private:
    const Scene& scene_;
    const std::filesystem::path& file_;
};

}  // namespace

void check_scene(const Scene& scene, const std::filesystem::path& file) {
    const Checks checks(scene, file);
    for (std::size_t n = 0; n < scene.objects.size(); ++n) checks.check(scene.objects[n], n);
    for (std::size_t n = 0; n < scene.primitives.size(); ++n) {
        const std::string name = "primitive " + std::to_string(n);
        checks.need(scene.primitives[n].id == static_cast<std::int64_t>(n),
                    name + " has another id");
        checks.object_or_none(scene.primitives[n].object, name);
    }
    for (const Contact& c : scene.contacts) checks.primitives(std::array{c.a, c.b}, "a contact");
    for (const Support& s : scene.supports)
        checks.objects(std::array{s.supporter, s.supported}, "a support");
    for (const AppliedCorrection& c : scene.corrections) checks.objects(c.objects, "a correction");
    checks.need(rules::finite(scene.manhattan_from_input),
                "manhattan_from_input holds what is no number");
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

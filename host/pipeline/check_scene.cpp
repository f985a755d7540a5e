// SPDX-License-Identifier: MIT
#include "pipeline/check_scene.h"

#include <cmath>
#include <string>

#include "io/text.h"

namespace topple {

void check_scene(const Scene& scene, const std::filesystem::path& file) {
    const auto object = [&](std::int32_t id) {
        return id >= 0 && static_cast<std::size_t>(id) < scene.objects.size();
    };
    const auto primitive = [&](std::int32_t id) {
        return id >= 0 && static_cast<std::size_t>(id) < scene.primitives.size();
    };
    const auto need = [&](bool holds, const std::string& what) {
        if (!holds) io::fail(file, what + "; the file is damaged: parse the scan again");
    };
    for (std::size_t n = 0; n < scene.objects.size(); ++n) {
        const Object& o = scene.objects[n];
        const std::string name = "object " + std::to_string(n);
        need(o.id == static_cast<std::int32_t>(n), name + " has another id");
        for (const std::int32_t p : o.primitives)
            need(primitive(p), name + " names a primitive that there is not");
        bool known = o.grounded || (o.mass_kg > 0 && std::isfinite(o.mass_kg));
        for (const double x : o.center_of_mass_m) known = known && std::isfinite(x);
        for (const double x : o.inertia_kg_m2) known = known && (o.grounded || std::isfinite(x));
        need(known, name + " has no mass, centre of mass or inertia");
    }
    for (const Primitive& p : scene.primitives)
        need(p.object == -1 || object(p.object),
             "primitive " + std::to_string(p.id) + " names an object that there is not");
    for (const Contact& c : scene.contacts)
        need(primitive(c.a) && primitive(c.b), "a contact names a primitive that there is not");
    for (const Support& s : scene.supports)
        need(object(s.supporter) && object(s.supported),
             "a support names an object that there is not");
    for (const double x : scene.manhattan_from_input)
        need(std::isfinite(x), "manhattan_from_input holds what is no number");
}

}  // namespace topple

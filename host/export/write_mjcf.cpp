// SPDX-License-Identifier: MIT
#include <string>

#include "core/vectors.h"
#include "export/export_folder.h"
#include "export/text.h"
#include "export/turned.h"
#include "export/write_obj.h"
#include "export/writers.h"

namespace topple::exports {
namespace {

// Hulls are made of their corners by MuJoCo.
void add_mesh(const NamedPart& each, const Vec3& center_m, std::string& out) {
    std::string corners;
    for (const Vec3& c : each.part->corner)
        append(corners, corners.empty() ? "" : "  ", text(minus(c, center_m)));
    append(out, "    <mesh", attribute("name", each.name), attribute("vertex", corners), "/>\n");
}

// What a geom is, in the body's frame.
struct GeomOf {
    const std::string& name;

    std::string operator()(std::monostate) const {
        return joined(attribute("type", "mesh"), attribute("mesh", name));
    }
    std::string operator()(const Box& box) const {
        const auto q = quaternion(box.axis);
        return joined(attribute("type", "box"), attribute("size", text(box.half_m)),
                      attribute("pos", text(box.center)),
                      attribute("quat", numbers({q[0], q[1], q[2], q[3]})));
    }
    std::string operator()(const Cylinder& cylinder) const {
        return joined(attribute("type", "cylinder"),
                      attribute("size", numbers({cylinder.radius_m, cylinder.half_m})),
                      attribute("pos", text(cylinder.center)),
                      attribute("zaxis", text(cylinder.axis)));
    }
    std::string operator()(const Sphere& sphere) const {
        return joined(attribute("type", "sphere"), attribute("size", number(sphere.radius_m)),
                      attribute("pos", text(sphere.center)));
    }
};

std::string inertial(double mass_kg, const Mat3& i) {
    return joined("<inertial pos=\"0 0 0\"", attribute("mass", number(mass_kg)),
                  attribute("fullinertia", numbers({i[0], i[4], i[8], i[1], i[2], i[5]})), "/>\n");
}

// Of what is fixed, too: MuJoCo would make up a mass of its parts.
std::string inertial(const Body& body) {
    if (!has_inertia(body))
        return joined("<inertial pos=\"0 0 0\"",
                      attribute("mass", number(has_mass(body) ? body.mass_kg : 0)),
                      attribute("diaginertia", "0 0 0"), "/>\n");
    return inertial(body.mass_kg, body.inertia_kg_m2);
}

// The coefficients of sliding, turning and rolling.
std::string frictions(double sliding) {
    return attribute("friction", numbers({sliding, 0.005, 0.0001}));
}

// A front within its body. What shows no surfaces shows what collides.
void add_front(const NamedFront& named, const Body& of, bool visuals, std::string& out) {
    const JointedFront& front = *named.front;
    append(out, "      <body", attribute("name", front.name),
           attribute("pos", text(minus(front.center_m, of.center_m))), ">\n        <joint",
           attribute("name", named.joint()), attribute("type", front.slides() ? "slide" : "hinge"),
           attribute("pos", text(minus(front.at_m, front.center_m))),
           attribute("axis", text(front.axis)), attribute("limited", "true"),
           attribute("range", numbers({0, front.most})),
           attribute("damping", number(front.damping())),
           attribute("frictionloss", number(front.holding())), "/>\n        ",
           inertial(front.mass_kg, front.inertia_kg_m2));
    const std::string none;
    for (const Box& box : named.boxes) {
        const std::string shape = GeomOf{none}(box);
        append(out, "        <geom", attribute("class", "collision"), shape, "/>\n");
        if (visuals)
            append(out, "        <geom", attribute("class", "front"), shape,
                   attribute("rgba", rgba(front.colour)), "/>\n");
    }
    out += "      </body>\n";
}

// Of one body; meshes that it takes go to `assets`.
void add_body(const NamedBody& named, bool visuals, std::string& assets, std::string& out) {
    const Body& body = *named.body;
    append(out, "    <body", attribute("name", named.name), attribute("pos", text(body.center_m)),
           ">\n");
    if (!body.fixed) out += "      <freejoint/>\n";
    append(out, "      ", inertial(body));
    // Where bodies differ MuJoCo takes the larger coefficient, but that of the higher priority.
    const std::string own = body.has_own_friction()
                                ? joined(frictions(named.friction), attribute("priority", "1"))
                                : "";
    for (const NamedPart& each : named.parts) {
        if (is_mesh(each.shape)) add_mesh(each, body.center_m, assets);
        append(out, "      <geom", attribute("name", each.name), attribute("class", "collision"),
               std::visit(GeomOf{each.name}, each.shape), own, "/>\n");
    }
    if (!body.visual.triangle.empty()) {
        const std::string mesh = joined(named.name, "_visual");
        append(assets, "    <mesh", attribute("name", mesh),
               attribute("file", joined(named.name, ".obj")), "/>\n");
        append(out, "      <geom", attribute("name", mesh), attribute("class", "visual"),
               attribute("mesh", mesh), "/>\n");
    }
    for (const NamedFront& front : named.fronts) add_front(front, body, visuals, out);
    out += "    </body>\n";
}

// Fronts lie in their bodies, and their edges turn past one another.
std::string excluded_contacts(const std::vector<NamedBody>& bodies) {
    std::string pairs;
    for (const NamedBody& named : bodies) {
        for (std::size_t n = 0; n < named.fronts.size(); ++n) {
            const std::string& front = named.fronts[n].front->name;
            const auto exclude = [&](const std::string& other) {
                append(pairs, "    <exclude", attribute("body1", other), attribute("body2", front),
                       "/>\n");
            };
            exclude(named.name);
            for (std::size_t m = 0; m < n; ++m) exclude(named.fronts[m].front->name);
        }
    }
    return pairs.empty() ? pairs : joined("  <contact>\n", pairs, "  </contact>\n");
}

// Viewers show groups 0 to 2.
std::string defaults(const SimScene& scene, bool visuals) {
    std::string out = "  <default>\n    <geom";
    append(out, frictions(scene.friction),
           " condim=\"4\" solref=\"0.01 1\" solimp=\"0.95 0.99 0.0005\"/>\n"
           "    <default class=\"collision\">\n      <geom",
           attribute("group", visuals ? "3" : "0"), "/>\n    </default>\n");
    if (visuals)
        out +=
            "    <default class=\"visual\">\n"
            "      <geom type=\"mesh\" material=\"colours\" group=\"2\" contype=\"0\" "
            "conaffinity=\"0\" mass=\"0\"/>\n"
            "    </default>\n"
            "    <default class=\"front\">\n"
            "      <geom group=\"2\" contype=\"0\" conaffinity=\"0\" mass=\"0\"/>\n"
            "    </default>\n";
    out += "  </default>\n";
    return out;
}

// The same scene, of which nothing is reckoned where all is at rest. At MuJoCo's tolerance of a
// millimetre a second contacts that chatter keep rooms awake. Older versions of MuJoCo don't
// know the flag, so that it has a file of its own.
std::string asleep() {
    std::string out(xml_mark);
    out +=
        "<!-- For MuJoCo 3.4 or later: what is at rest sleeps until something awake touches it. "
        "-->\n"
        "<mujoco model=\"scan\">\n"
        "  <include file=\"scene.xml\"/>\n"
        "  <option sleep_tolerance=\"0.005\">\n"
        "    <flag sleep=\"enable\"/>\n"
        "  </option>\n"
        "</mujoco>\n";
    return out;
}

}  // namespace

void write_mjcf(const std::filesystem::path& folder, const SimScene& scene) {
    const std::vector<NamedBody> bodies = named_bodies(scene);
    ExportFolder files(folder, "mjcf", "scene.xml", "scene_asleep.xml");
    const bool visuals = files.add_visuals(bodies);
    std::string assets, world;
    for (const NamedBody& body : bodies) add_body(body, visuals, assets, world);
    std::string out(xml_mark);
    out +=
        "<!-- For MuJoCo 2.3 or later. Earlier ones have room for 100 contacts, and leave out the "
        "others: they take\n     <size nconmax=\"1000\" njmax=\"4000\"/> within <mujoco>. -->\n";
    out += "<mujoco model=\"scan\">\n  <compiler angle=\"radian\"";
    if (visuals)
        append(out, attribute("meshdir", files.beside()), attribute("texturedir", files.beside()));
    append(out, "/>\n  <option", attribute("gravity", numbers({0, 0, -scene.gravity_m_s2})),
           " timestep=\"0.004\" cone=\"elliptic\" impratio=\"10\">\n"
           "    <flag multiccd=\"enable\"/>\n"
           "  </option>\n"
           "  <visual>\n"
           "    <headlight ambient=\"0.5 0.5 0.5\" diffuse=\"0.5 0.5 0.5\" specular=\"0 0 0\"/>\n"
           "  </visual>\n",
           defaults(scene, visuals), "  <asset>\n");
    if (visuals)
        append(out, "    <texture name=\"colours\" type=\"2d\"", attribute("file", colour_file),
               "/>\n    <material name=\"colours\" texture=\"colours\" specular=\"0\"/>\n");
    append(out, assets, "  </asset>\n  <worldbody>\n", world, "  </worldbody>\n",
           excluded_contacts(bodies), "</mujoco>\n");
    files.commit(out, asleep());
}

}  // namespace topple::exports

// SPDX-License-Identifier: MIT
#include <string>

#include "core/vectors.h"
#include "export/export_folder.h"
#include "export/text.h"
#include "export/turned.h"
#include "export/writers.h"

namespace topple::exports {
namespace {

// Where a shape is, in the link's frame, and what it is.
struct SdfShape {
    const std::string& name;
    const std::string& folder;  // of meshes

    std::string operator()(std::monostate) const { return mesh(name); }
    std::string operator()(const Box& box) const {
        const Vec3& h = box.half_m;
        return shape(pose(box.center, roll_pitch_yaw(box.axis)), "box",
                     element("size", numbers({2 * h[0], 2 * h[1], 2 * h[2]})));
    }
    std::string operator()(const Cylinder& cylinder) const {
        return shape(pose(cylinder.center, roll_pitch_yaw(frame_around(cylinder.axis))), "cylinder",
                     joined(element("radius", number(cylinder.radius_m)),
                            element("length", number(2 * cylinder.half_m))));
    }
    std::string operator()(const Sphere& sphere) const {
        return shape(pose(sphere.center, {}), "sphere", element("radius", number(sphere.radius_m)));
    }
    std::string mesh(const std::string& called) const {
        return shape("", "mesh", element("uri", joined(folder, "/", called, ".obj")));
    }

  private:
    static std::string shape(std::string_view pose, std::string_view kind, std::string_view what) {
        return joined(pose, element("geometry", element(kind, what)));
    }
    static std::string pose(const Vec3& at, const Vec3& turn) {
        return element("pose", joined(text(at), " ", text(turn)));
    }
};

std::string sdf_inertial(double mass_kg, const Mat3& i) {
    return joined(
        "      ",
        element(
            "inertial",
            joined(element("mass", number(mass_kg)),
                   element("inertia",
                           joined(element("ixx", number(i[0])), element("ixy", number(i[1])),
                                  element("ixz", number(i[2])), element("iyy", number(i[4])),
                                  element("iyz", number(i[5])), element("izz", number(i[8])))))),
        "\n");
}

// Contacts may be half a millimetre deep before they push, and push apart slowly: what rests stays.
std::string sdf_surface(double friction) {
    return element(
        "surface",
        joined(element("friction", element("ode", joined(element("mu", number(friction)),
                                                         element("mu2", number(friction))))),
               element("contact", element("ode", joined(element("max_vel", "0.01"),
                                                        element("min_depth", "0.0005"))))));
}

// A front's link, at its centre of mass, and its joint.
std::string sdf_front(const NamedFront& named, const Body& of, const std::string& surface) {
    const JointedFront& front = *named.front;
    std::string out =
        joined("      <link", attribute("name", front.name), ">\n      ",
               element("pose", joined(text(minus(front.center_m, of.center_m)), " 0 0 0")), "\n",
               sdf_inertial(front.mass_kg, front.inertia_kg_m2));
    const std::string none;
    for (std::size_t n = 0; n < named.boxes.size(); ++n) {
        const std::string name = attribute("name", joined("board_", std::to_string(n))),
                          shape = SdfShape{none, none}(named.boxes[n]);
        if (!of.visual.triangle.empty())
            append(out, "      <visual", name, ">", shape,
                   element("material", element("diffuse", rgba(front.colour))), "</visual>\n");
        append(out, "      <collision", name, ">", shape, surface, "</collision>\n");
    }
    append(
        out, "      </link>\n      <joint", attribute("name", named.joint()),
        attribute("type", front.slides() ? "prismatic" : "revolute"), ">",
        element("parent", "link"), element("child", front.name),
        element("pose", joined(text(minus(front.at_m, front.center_m)), " 0 0 0")),
        element("axis",
                joined(element("xyz", text(front.axis)),
                       element("limit",
                               joined(element("lower", "0"), element("upper", number(front.most)))),
                       element("dynamics", joined(element("damping", number(front.damping())),
                                                  element("friction", number(front.holding())))))),
        "</joint>\n");
    return out;
}

std::string sdf_model(const NamedBody& named, const std::string& folder) {
    const Body& body = *named.body;
    const std::string surface = sdf_surface(named.friction);
    std::string out = joined("    <model", attribute("name", named.name), ">\n      ",
                             element("static", body.fixed ? "true" : "false"),
                             element("pose", joined(text(body.center_m), " 0 0 0")),
                             "\n      <link name=\"link\">\n");
    if (!body.fixed) out += sdf_inertial(body.mass_kg, body.inertia_kg_m2);
    if (!body.visual.triangle.empty())
        append(out, "      <visual name=\"visual\">", SdfShape{named.name, folder}.mesh(named.name),
               "</visual>\n");
    for (const NamedPart& each : named.parts)
        append(out, "      <collision", attribute("name", each.name), ">",
               std::visit(SdfShape{each.name, folder}, each.shape), surface, "</collision>\n");
    out += "      </link>\n";
    for (const NamedFront& front : named.fronts) out += sdf_front(front, body, surface);
    out += "    </model>\n";
    return out;
}

}  // namespace

void write_sdf(const std::filesystem::path& folder, const SimScene& scene) {
    const std::vector<NamedBody> bodies = named_bodies(scene);
    ExportFolder files(folder, "sdf", "scene.sdf");
    files.add_visuals(bodies);
    files.add_parts(bodies);
    std::string out(xml_mark);
    append(out, "<sdf version=\"1.7\">\n  <world name=\"scan\">\n    ",
           element("gravity", numbers({0, 0, -scene.gravity_m_s2})),
           "\n    <physics name=\"steps\" type=\"ode\">", element("max_step_size", "0.001"),
           element("real_time_factor", "1"), element("real_time_update_rate", "1000"),
           "</physics>\n    <light name=\"sun\" type=\"directional\">",
           element("cast_shadows", "false"), element("pose", "0 0 10 0 0 0"),
           element("diffuse", "0.8 0.8 0.8 1"), element("specular", "0.1 0.1 0.1 1"),
           element("direction", "-0.4 0.3 -0.9"), "</light>\n");
    for (const NamedBody& named : bodies) out += sdf_model(named, files.beside());
    out += "  </world>\n</sdf>\n";
    files.commit(out);
}

}  // namespace topple::exports

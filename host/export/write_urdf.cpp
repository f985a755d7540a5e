// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>

#include "core/vectors.h"
#include "export/export_folder.h"
#include "export/text.h"
#include "export/turned.h"
#include "export/write_obj.h"
#include "export/writers.h"

namespace topple::exports {
namespace {

// Bullet makes a hull so much thicker all around: its meshes are thinner by that.
constexpr double bullet_margin_m = 0.001;
constexpr std::string_view for_bullet = "_bullet";

// Where a shape is, in the body's frame, and what it is. files: what leads to the meshes; kind: of
// a hull's mesh, the end of its name.
struct UrdfShape {
    const std::string& name;
    std::string_view files, kind;

    std::string operator()(std::monostate) const { return mesh(joined(name, kind)); }
    std::string operator()(const Box& box) const {
        const Vec3& h = box.half_m;
        return joined(origin(box.center, roll_pitch_yaw(box.axis)), "<geometry><box",
                      attribute("size", numbers({2 * h[0], 2 * h[1], 2 * h[2]})), "/></geometry>");
    }
    std::string operator()(const Cylinder& cylinder) const {
        return joined(origin(cylinder.center, roll_pitch_yaw(frame_around(cylinder.axis))),
                      "<geometry><cylinder", attribute("radius", number(cylinder.radius_m)),
                      attribute("length", number(2 * cylinder.half_m)), "/></geometry>");
    }
    std::string operator()(const Sphere& sphere) const {
        return joined(origin(sphere.center, {}), "<geometry><sphere",
                      attribute("radius", number(sphere.radius_m)), "/></geometry>");
    }
    std::string mesh(const std::string& called) const {
        return joined("<geometry><mesh", attribute("filename", joined(files, called, ".obj")),
                      "/></geometry>");
    }

  private:
    static std::string origin(const Vec3& at, const Vec3& turn) {
        return joined("<origin", attribute("xyz", text(at)), attribute("rpy", text(turn)), "/>");
    }
};

std::string urdf_inertial(double mass_kg, const Mat3& i, const Vec3& center_m = {}) {
    std::string out = "    <inertial>";
    if (center_m != Vec3{})
        append(out, "<origin", attribute("xyz", text(center_m)), " rpy=\"0 0 0\"/>");
    append(out, "<mass", attribute("value", number(mass_kg)), "/><inertia",
           attribute("ixx", number(i[0])), attribute("iyy", number(i[4])),
           attribute("izz", number(i[8])), attribute("ixy", number(i[1])),
           attribute("ixz", number(i[2])), attribute("iyz", number(i[5])), "/></inertial>\n");
    return out;
}

// <contact> is Bullet's, which takes the product of both bodies' coefficients; and what has no mass
// is fixed there.
std::string urdf_link(const NamedBody& named, std::string_view files, std::string_view kind) {
    const Body& body = *named.body;
    std::string out = joined("  <link", attribute("name", named.name), ">\n");
    append(out, "    <contact><lateral_friction",
           attribute("value", number(std::sqrt(named.friction))), "/></contact>\n",
           body.fixed ? urdf_inertial(0, {}) : urdf_inertial(body.mass_kg, body.inertia_kg_m2));
    if (!body.visual.triangle.empty())
        append(out, "    <visual>", UrdfShape{named.name, files, kind}.mesh(named.name),
               "</visual>\n");
    for (const NamedPart& each : named.parts)
        append(out, "    <collision", attribute("name", each.name), ">",
               std::visit(UrdfShape{each.name, files, kind}, each.shape), "</collision>\n");
    out += "  </link>\n";
    return out;
}

// A front's link, at its centre of mass, and its joint to its body's. The joint's frame is the
// link's: hinges turn about its origin.
std::string urdf_front(const NamedFront& named, const NamedBody& of) {
    const JointedFront& front = *named.front;
    const Vec3 center = minus(front.center_m, front.at_m);
    std::string out = joined("  <link", attribute("name", front.name), ">\n");
    append(out, urdf_inertial(front.mass_kg, front.inertia_kg_m2, center));
    const std::string none;
    for (Box box : named.boxes) {
        box.center = plus(box.center, center);
        const std::string shape = UrdfShape{none, "", ""}(box);
        if (!of.body->visual.triangle.empty())
            append(out, "    <visual>", shape, "<material",
                   attribute("name", joined(front.name, "_colour")), "><color",
                   attribute("rgba", rgba(front.colour)), "/></material></visual>\n");
        append(out, "    <collision>", shape, "</collision>\n");
    }
    append(out, "  </link>\n  <joint", attribute("name", named.joint()),
           attribute("type", front.slides() ? "prismatic" : "revolute"), "><parent",
           attribute("link", of.name), "/><child", attribute("link", front.name), "/><origin",
           attribute("xyz", text(minus(front.at_m, of.body->center_m))), " rpy=\"0 0 0\"/><axis",
           attribute("xyz", text(front.axis)), "/><limit", attribute("lower", "0"),
           attribute("upper", number(front.most)), " effort=\"100\" velocity=\"2\"/><dynamics",
           attribute("damping", number(front.damping())),
           attribute("friction", number(front.holding())), "/></joint>\n");
    return out;
}

std::string robot(std::string_view name, std::string_view content) {
    return joined(xml_mark, "<robot", attribute("name", name), ">\n", content, "</robot>\n");
}

}  // namespace

void write_urdf(const std::filesystem::path& folder, const SimScene& scene) {
    const std::vector<NamedBody> bodies = named_bodies(scene);
    ExportFolder files(folder, "urdf", "scene.urdf");
    files.add_visuals(bodies);
    files.add_parts(bodies);
    for (const NamedBody& named : bodies)
        for (const NamedPart& each : named.parts)
            if (is_mesh(each.shape))
                files.add(joined(each.name, for_bullet, ".obj"),
                          part_obj(shrunk(*each.part, bullet_margin_m), named.body->center_m));
    // MuJoCo would leave folders out of the names of meshes.
    std::string all =
        "  <mujoco>\n    <compiler strippath=\"false\" discardvisual=\"false\" "
        "fusestatic=\"false\"/>\n    <option";
    append(all, attribute("gravity", numbers({0, 0, -scene.gravity_m_s2})),
           "/>\n  </mujoco>\n  <link name=\"world\">\n", urdf_inertial(0, {}), "  </link>\n");
    const std::string below = joined(files.beside(), "/");
    for (const NamedBody& named : bodies) {
        const bool fixed = named.body->fixed;
        append(all, urdf_link(named, below, ""), "  <joint",
               attribute("name", joined(named.name, "_joint")),
               attribute("type", fixed ? "fixed" : "floating"), "><parent link=\"world\"/><child",
               attribute("link", named.name), "/><origin",
               attribute("xyz", text(named.body->center_m)), " rpy=\"0 0 0\"/></joint>\n");
        std::string fronts;
        for (const NamedFront& front : named.fronts) fronts += urdf_front(front, named);
        all += fronts;
        files.add(joined(named.name, ".urdf"),
                  robot(named.name, joined(urdf_link(named, "", for_bullet), fronts)));
    }
    files.commit(robot("scan", all));
}

}  // namespace topple::exports

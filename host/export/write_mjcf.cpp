// SPDX-License-Identifier: MIT
#include "export/write_mjcf.h"

#include <cstdio>

#include "export/names.h"
#include "export/write_export.h"
#include "physics/vectors.h"

namespace topple::exports {
namespace {

std::string number(double value) {
    char digits[32];
    std::snprintf(digits, sizeof(digits), "%.9g", value);
    return digits;
}

std::string numbers(std::initializer_list<double> values) {
    std::string out;
    for (const double v : values) {
        if (!out.empty()) out += ' ';
        out += number(v);
    }
    return out;
}

std::string text(const Vec3& v) {
    return numbers({v[0], v[1], v[2]});
}

constexpr double box_tolerance_m = 1e-5;

// One that a box stands for has no mesh.
void add_meshes(const Body& body, const std::string& name, std::string& out) {
    for (std::size_t n = 0; n < body.parts.size(); ++n) {
        if (as_box(body.parts[n], box_tolerance_m)) continue;
        out += "    <mesh name=\"" + part_name(name, n) + "\" vertex=\"";
        bool first = true;
        for (const Vec3& c : body.parts[n].corner) {
            if (!first) out += "  ";
            out += text(physics::minus(c, body.center_m));
            first = false;
        }
        out += "\"/>\n";
    }
}

void add_geoms(const Body& body, const std::string& name, const std::string& indent,
               std::string& out) {
    for (std::size_t n = 0; n < body.parts.size(); ++n) {
        out += indent + "<geom name=\"" + part_name(name, n) + "\" ";
        if (const auto box = as_box(body.parts[n], box_tolerance_m)) {
            out += "type=\"box\" size=\"" + text(box->half_m) + "\" pos=\"" +
                   text(physics::minus(box->center, body.center_m)) + "\" xyaxes=\"" +
                   text(box->axis[0]) + " " + text(box->axis[1]) + "\"/>\n";
        } else {
            out += "type=\"mesh\" mesh=\"" + part_name(name, n) + "\"/>\n";
        }
    }
}

}  // namespace

std::string mjcf(const SimScene& scene) {
    std::string meshes, bodies;
    for (std::size_t n = 0; n < scene.bodies.size(); ++n) {
        const Body& body = scene.bodies[n];
        if (body.parts.empty()) continue;
        const std::string called = body_name(body, n);
        add_meshes(body, called, meshes);
        bodies += "    <body name=\"" + called + "\" pos=\"" + text(body.center_m) + "\">\n";
        if (!body.fixed) {
            const Mat3& i = body.inertia_kg_m2;
            bodies += "      <freejoint/>\n      <inertial pos=\"0 0 0\" mass=\"" +
                      number(body.mass_kg) + "\" fullinertia=\"" +
                      numbers({i[0], i[4], i[8], i[1], i[2], i[5]}) + "\"/>\n";
        }
        add_geoms(body, called, "      ", bodies);
        bodies += "    </body>\n";
    }
    return std::string("<!-- ").append(export_mark) +
           " -->\n"
           "<mujoco model=\"scan\">\n"
           "  <compiler angle=\"radian\"/>\n"
           "  <option gravity=\"0 0 " +
           number(-scene.gravity_m_s2) +
           "\" timestep=\"0.002\" cone=\"elliptic\" impratio=\"10\">\n"
           "    <flag multiccd=\"enable\"/>\n"
           "  </option>\n"
           "  <default>\n"
           "    <geom friction=\"" +
           numbers({scene.friction, 0.005, 0.0001}) +
           "\" condim=\"4\" solref=\"0.01 1\" solimp=\"0.95 0.99 0.0005\"/>\n"
           "  </default>\n"
           "  <asset>\n" +
           meshes + "  </asset>\n  <worldbody>\n" + bodies + "  </worldbody>\n</mujoco>\n";
}

void write_mjcf(const std::filesystem::path& folder, const SimScene& scene) {
    write_export(folder / "scene.xml", mjcf(scene));
}

}  // namespace topple::exports

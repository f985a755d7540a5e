// SPDX-License-Identifier: MIT
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/vectors.h"
#include "export/export_folder.h"
#include "export/text.h"
#include "export/turned.h"
#include "export/writers.h"
#include "io/text.h"

namespace topple::exports {
namespace {

// "(1, 2, 3)"
std::string tuple(std::initializer_list<double> values) {
    return joined("(", numbers(values, ", "), ")");
}
std::string tuple(const Vec3& v) {
    return tuple({v[0], v[1], v[2]});
}
std::string quaternion_tuple(const Axes& axes) {
    const auto q = quaternion(axes);
    return tuple({q[0], q[1], q[2], q[3]});
}

// "[(1, 2, 3), (4, 5, 6)]" of vectors, each written by append_one(text, vector).
template <class Values, class AppendOne>
std::string array_of(const Values& values, const AppendOne& append_one) {
    std::string out = "[";
    for (const auto& each : values) {
        if (out.size() > 1) out += ", ";
        append_one(out, each);
    }
    out += "]";
    return out;
}
template <class Values>
std::string fixed_tuples(const Values& values, int digits) {
    return array_of(values, [digits](std::string& out, const auto& each) {
        out += '(';
        for (std::size_t a = 0; a < 3; ++a) {
            if (a > 0) out += ", ";
            append_fixed(out, each[a], digits);
        }
        out += ')';
    });
}
template <class Values>
std::string whole_numbers(const Values& values) {
    return array_of(values, [](std::string& out, auto each) { out += std::to_string(each); });
}

// Points with their box, and the corners of faces.
std::string usd_mesh(const std::vector<Vec3>& points, int digits,
                     const std::vector<std::size_t>& counts,
                     const std::vector<std::uint32_t>& corners) {
    Extents<double> box;
    for (const Vec3& p : points) box.add(p);
    return joined(
        "            uniform token subdivisionScheme = \"none\"\n"
        "            float3[] extent = ",
        fixed_tuples(std::array{box.low, box.high}, digits),
        "\n            point3f[] points = ", fixed_tuples(points, digits),
        "\n            int[] faceVertexCounts = ", whole_numbers(counts),
        "\n            int[] faceVertexIndices = ", whole_numbers(corners), "\n");
}

// A hundredth of a millimetre for what is seen, a ten-thousandth for what touches.
constexpr int seen_digits = 5, touching_digits = 7, direction_digits = 3;

// Displayed colours are linear.
std::string usd_colours(const std::vector<Rgb8>& colours) {
    std::vector<Vec3> linear;
    const bool one = std::ranges::all_of(colours, [&](const Rgb8& c) { return c == colours[0]; });
    for (const Rgb8& c : colours) {
        Vec3& to = linear.emplace_back();
        for (std::size_t a = 0; a < 3; ++a) to[a] = linear_of_srgb(c[a] / 255.0);
        if (one) break;
    }
    return joined("            color3f[] primvars:displayColor = ", fixed_tuples(linear, 4),
                  " (\n                interpolation = \"", one ? "constant" : "vertex",
                  "\"\n            )\n");
}

std::string usd_visual(const Visual& visual) {
    std::vector<std::uint32_t> corners;
    for (const auto& triangle : visual.triangle)
        corners.insert(corners.end(), triangle.begin(), triangle.end());
    return joined(
        "        def Mesh \"visual\"\n        {\n",
        usd_mesh(visual.vertex, seen_digits, std::vector<std::size_t>(visual.triangle.size(), 3),
                 corners),
        "            normal3f[] normals = ", fixed_tuples(visual.normal, direction_digits),
        " (\n                interpolation = \"vertex\"\n            )\n",
        usd_colours(visual.colour), "        }\n");
}

// Of a shape: what it is, and its content, in the body's frame.
struct UsdShape {
    const ConvexPart& part;
    const Vec3& center_m;

    struct Written {
        const char* type;
        std::string content;
    };
    Written operator()(std::monostate) const {
        std::vector<Vec3> points;
        for (const Vec3& c : part.corner) points.push_back(minus(c, center_m));
        std::vector<std::size_t> counts;
        std::vector<std::uint32_t> corners;
        for (const auto& outline : part.outline) {
            counts.push_back(outline.size());
            corners.insert(corners.end(), outline.begin(), outline.end());
        }
        std::string out = usd_mesh(points, touching_digits, counts, corners);
        out += "            uniform token physics:approximation = \"convexHull\"\n";
        return {"Mesh", std::move(out)};
    }
    Written operator()(const Box& box) const {
        return {"Cube", joined("            double size = 2\n"
                               "            float3[] extent = [(-1, -1, -1), (1, 1, 1)]\n",
                               place(box.center), orient(box.axis),
                               "            float3 xformOp:scale = ", tuple(box.half_m),
                               "\n            uniform token[] xformOpOrder = "
                               "[\"xformOp:translate\", \"xformOp:orient\", \"xformOp:scale\"]\n")};
    }
    Written operator()(const Cylinder& cylinder) const {
        const double r = cylinder.radius_m, h = cylinder.half_m;
        return {
            "Cylinder",
            joined("            uniform token axis = \"Z\"\n            double radius = ",
                   number(r), "\n            double height = ", number(2 * h),
                   "\n            float3[] extent = [", tuple({-r, -r, -h}), ", ", tuple({r, r, h}),
                   "]\n", place(cylinder.center), orient(frame_around(cylinder.axis)),
                   "            uniform token[] xformOpOrder = "
                   "[\"xformOp:translate\", \"xformOp:orient\"]\n")};
    }
    Written operator()(const Sphere& sphere) const {
        const double r = sphere.radius_m;
        return {
            "Sphere",
            joined("            double radius = ", number(r), "\n            float3[] extent = [",
                   tuple({-r, -r, -r}), ", ", tuple({r, r, r}), "]\n", place(sphere.center),
                   "            uniform token[] xformOpOrder = [\"xformOp:translate\"]\n")};
    }

  private:
    static std::string place(const Vec3& at) {
        return joined("            double3 xformOp:translate = ", tuple(at), "\n");
    }
    static std::string orient(const Axes& axes) {
        return joined("            quatf xformOp:orient = ", quaternion_tuple(axes), "\n");
    }
};

// What is seen instead of it hides a part from renderers.
std::string usd_part(const NamedPart& each, const Vec3& center_m, bool hidden) {
    const auto shape = std::visit(UsdShape{*each.part, center_m}, each.shape);
    return joined("        def ", shape.type, " \"", each.name,
                  "\" (\n            prepend apiSchemas = [\"PhysicsCollisionAPI\"",
                  is_mesh(each.shape) ? ", \"PhysicsMeshCollisionAPI\"" : "",
                  "]\n        )\n        {\n", shape.content,
                  hidden ? "            uniform token purpose = \"guide\"\n" : "", "        }\n");
}

// Inertia along its principal axes.
std::string usd_mass(double mass_kg, const Mat3& inertia_kg_m2) {
    const Eigen::Matrix3d inertia(inertia_kg_m2.data());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(inertia);
    Axes axes{};
    for (std::size_t a = 0; a < 2; ++a) {
        const auto column = solved.eigenvectors().col(static_cast<Eigen::Index>(a));
        axes[a] = {column[0], column[1], column[2]};
    }
    axes[2] = cross(axes[0], axes[1]);
    const auto& moments = solved.eigenvalues();
    return joined("        float physics:mass = ", number(mass_kg),
                  "\n        point3f physics:centerOfMass = (0, 0, 0)\n"
                  "        float3 physics:diagonalInertia = ",
                  tuple({moments[0], moments[1], moments[2]}),
                  "\n        quatf physics:principalAxes = ", quaternion_tuple(axes), "\n");
}

// Called "friction".
std::string usd_material(std::string_view indent, double friction) {
    return joined(indent, "def Material \"friction\" (\n", indent,
                  "    prepend apiSchemas = [\"PhysicsMaterialAPI\"]\n", indent, ")\n", indent,
                  "{\n", indent, "    float physics:staticFriction = ", number(friction), "\n",
                  indent, "    float physics:dynamicFriction = ", number(friction), "\n", indent,
                  "    float physics:restitution = 0\n", indent, "}\n");
}

// A front, and its joint, whose x is the axis: of hinges to its angle, degrees.
std::string usd_front(const NamedFront& named, const NamedBody& of) {
    const JointedFront& front = *named.front;
    std::string out = joined("\n    def Xform \"", front.name,
                             "\" (\n        prepend apiSchemas = [\"PhysicsRigidBodyAPI\", "
                             "\"PhysicsMassAPI\"]\n    )\n    {\n");
    append(out, "        double3 xformOp:translate = ", tuple(front.center_m),
           "\n        uniform token[] xformOpOrder = [\"xformOp:translate\"]\n",
           usd_mass(front.mass_kg, front.inertia_kg_m2));
    const ConvexPart none;
    for (std::size_t n = 0; n < named.boxes.size(); ++n)
        append(out, "        def Cube \"board_", std::to_string(n),
               "\" (\n            prepend apiSchemas = [\"PhysicsCollisionAPI\"]\n        )\n"
               "        {\n",
               UsdShape{none, front.center_m}(named.boxes[n]).content, usd_colours({front.colour}),
               "        }\n");
    const Axes frame = frame_around(front.axis);  // its third is the axis
    const Axes turned{frame[2], frame[0], frame[1]};
    const std::string turn = quaternion_tuple(turned);
    append(out, "    }\n\n    def Physics", front.slides() ? "Prismatic" : "Revolute", "Joint \"",
           named.joint(), "\"\n    {\n        rel physics:body0 = </World/", of.name,
           ">\n        rel physics:body1 = </World/", front.name,
           ">\n        uniform token physics:axis = \"X\"\n        point3f physics:localPos0 = ",
           tuple(minus(front.at_m, of.body->center_m)),
           "\n        point3f physics:localPos1 = ", tuple(minus(front.at_m, front.center_m)),
           "\n        quatf physics:localRot0 = ", turn,
           "\n        quatf physics:localRot1 = ", turn,
           "\n        float physics:lowerLimit = 0\n        float physics:upperLimit = ",
           number(front.slides() ? front.most : front.most * 180 / std::numbers::pi), "\n    }\n");
    return out;
}

std::string usd_body(const NamedBody& named, bool hide_parts) {
    const Body& body = *named.body;
    std::string out = joined("\n    def Xform \"", named.name, "\""), schemas;
    if (!body.fixed) schemas = "\"PhysicsRigidBodyAPI\", \"PhysicsMassAPI\"";
    if (body.has_own_friction())
        append(schemas, schemas.empty() ? "" : ", ", "\"MaterialBindingAPI\"");
    if (!schemas.empty()) append(out, " (\n        prepend apiSchemas = [", schemas, "]\n    )");
    out += "\n    {\n";
    if (body.has_own_friction())
        append(out, "        rel material:binding:physics = </World/", named.name, "/friction>\n\n",
               usd_material("        ", named.friction), "\n");
    append(out, "        double3 xformOp:translate = ", tuple(body.center_m),
           "\n        uniform token[] xformOpOrder = [\"xformOp:translate\"]\n",
           body.fixed ? "" : usd_mass(body.mass_kg, body.inertia_kg_m2));
    if (!body.visual.triangle.empty()) out += usd_visual(body.visual);
    for (const NamedPart& each : named.parts) out += usd_part(each, body.center_m, hide_parts);
    out += "    }\n";
    for (const NamedFront& front : named.fronts) out += usd_front(front, named);
    return out;
}

}  // namespace

void write_usd(const std::filesystem::path& file, const SimScene& scene) {
    if (file.extension() != ".usda")
        throw Error(ErrorKind::usage, io::path_text(file) + ": the name must end in .usda");
    check_ours(file);
    const std::vector<NamedBody> bodies = named_bodies(scene);
    const bool seen = std::ranges::any_of(
        bodies, [](const NamedBody& named) { return !named.body->visual.triangle.empty(); });
    std::string out(usd_mark);
    append(out,
           "(\n"
           "    defaultPrim = \"World\"\n"
           "    kilogramsPerUnit = 1\n"
           "    metersPerUnit = 1\n"
           "    upAxis = \"Z\"\n"
           ")\n\n"
           "def Xform \"World\" (\n"
           "    prepend apiSchemas = [\"MaterialBindingAPI\"]\n"
           ")\n"
           "{\n"
           "    rel material:binding:physics = </World/friction>\n\n"
           "    def PhysicsScene \"physics\"\n"
           "    {\n"
           "        vector3f physics:gravityDirection = (0, 0, -1)\n"
           "        float physics:gravityMagnitude = ",
           number(scene.gravity_m_s2), "\n    }\n\n", usd_material("    ", scene.friction));
    for (const NamedBody& named : bodies) out += usd_body(named, seen);
    out += "}\n";
    replace_file(file, out);
}

}  // namespace topple::exports

// SPDX-License-Identifier: MIT
#include "colour_image.h"
#include "mesh_files.h"
#include "points/formats/gltf.h"
#include "points/formats/mesh_sides.h"
#include "points/formats/obj_surface.h"
#include "points/formats/read_cloud.h"
#include "result/write_glb.h"

// Meshes that would have the library which reads them take far more than their size.
namespace topple::io {
namespace {

using test::expect_input_error;

class HostileMesh : public test::Files {
  protected:
    void refused(const std::string& json, std::initializer_list<std::string_view> message) const {
        expect_input_error([&] { checked_gltf(path("a.gltf"), json, std::nullopt); }, message);
    }
    void taken(const std::string& json) const { checked_gltf(path("a.gltf"), json, std::nullopt); }
};

std::string repeated(std::size_t count, const std::string& entry) {
    std::string out = entry;
    for (std::size_t n = 1; n < count; ++n) out.append(",").append(entry);
    return out;
}

// Each the other's child, from 0 on.
std::string chain(std::size_t count) {
    std::string out = R"({"nodes": [)";
    for (std::size_t n = 1; n < count; ++n)
        out.append(R"({"children": [)").append(std::to_string(n)).append("]},");
    return out + "{}]}";
}

TEST_F(HostileMesh, nodes_are_trees_of_some_depth) {
    taken(chain(256));
    refused(chain(257), {"256 deep"});
    refused(R"({"nodes": [{"children": [1, 1]}, {}]})", {"node 1", "twice"});
    refused(R"({"nodes": [{"children": [2]}, {"children": [2]}, {}]})", {"node 2", "two nodes"});
    refused(R"({"nodes": [{"children": [0]}]})", {"cycle"});
    refused(R"({"nodes": [{"children": [1]}, {"children": [0]}]})", {"cycle"});
    refused(R"({"nodes": [{"children": [-1]}]})", {"no node"});
    refused(std::string(101, '[') + std::string(101, ']'), {"nested"});
}

TEST_F(HostileMesh, counts_are_weighed_against_the_file) {
    taken(R"({"materials": [)" + repeated(1000, "{}") + "]}");
    refused(R"({"materials": [)" + repeated(10000, "{}") + "]}", {"materials", "memory"});
    refused(R"({"nodes": [)" + repeated(100000, "{}") + "]}", {"nodes", "memory"});
    const std::string data = R"("buffers": [{"byteLength": 12000}],
        "bufferViews": [{"buffer": 0, "byteLength": 12000}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 1000, "type": "VEC3"}])";
    const auto primitives = [&](std::size_t count) {
        return "{" + data + R"(, "meshes": [{"primitives": [)" +
               repeated(count, R"({"attributes": {"POSITION": 0}})") + "]}], \"a\": \"" +
               std::string(12000, 'a') + "\"}";
    };
    taken(primitives(100));
    refused(primitives(10000), {"memory"});
}

TEST_F(HostileMesh, accessors_fit_by_the_size_of_their_elements) {
    const auto json = [](int count) {
        return R"({"buffers": [{"byteLength": 120, "uri": "data:,)" + std::string(200, 'a') +
               R"("}], "bufferViews": [{"buffer": 0, "byteLength": 120}], "accessors": [)" +
               R"({"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": )" +
               std::to_string(count) + "}]}";
    };
    taken(json(10));
    refused(json(11), {"accessor 0", "more than"});
}

TEST_F(HostileMesh, files_beside_lie_in_the_same_folder) {
    const auto file = write("in/a.gltf", "{}");
    write("in/b/c d.bin", "1");
    write("outside.bin", "1");
    std::filesystem::create_symlink(path("outside.bin"), path("in/link.bin"));
    EXPECT_TRUE(
        std::filesystem::equivalent(file_beside(file, "b/c%20d.bin").path(), path("in/b/c d.bin")));
    for (const char* uri : {"../outside.bin", "%2e%2e/outside.bin", "/etc/hostname", "link.bin",
                            "file:///etc/hostname", "b/../../outside.bin", ""}) {
        SCOPED_TRACE(uri);
        expect_input_error([&] { file_beside(file, uri); }, {"a.gltf", "folder"});
    }
    expect_input_error([&] { file_beside(file, "none.bin"); }, {"none.bin", "No such file"});
    expect_input_error([&] { file_beside(file, "b"); }, {"regular file"});
}

TEST_F(HostileMesh, an_obj_is_its_vertices_and_faces) {
    EXPECT_EQ(obj_surface("g a\nv 1 2 3\nusemtl b\n f 1 2 \\\n3\nl 1 2\no c \\\nv 9\nvn 0 0 1"),
              "v 1 2 3\n f 1 2 \\\n3\nvn 0 0 1\n");
    std::string groups = test::box_obj();
    for (std::size_t at = 0; (at = groups.find("f ", at)) != std::string::npos; at += 6)
        groups.insert(at, "g a\n");
    EXPECT_EQ(read_cloud(write("a.obj", groups)).x, read_cloud(write("b.obj", test::box_obj())).x);
}

using Triangles = std::vector<std::array<Vec3, 3>>;

// A box of `edge` times 2 x 1 x 0.5 at `at`, faces seen from outside.
Triangles box(double edge = 1, const Vec3& at = {0, 0, 0}) {
    Triangles out;
    const auto corners = test::box_corners();
    for (const auto& t : test::box_triangles()) {
        std::array<Vec3, 3> triangle{};
        for (std::size_t n = 0; n < 3; ++n)
            for (std::size_t a = 0; a < 3; ++a) triangle[n][a] = edge * corners[t[n]][a] + at[a];
        out.push_back(triangle);
    }
    return out;
}
Triangles turned(Triangles of, std::initializer_list<std::size_t> which = {}) {
    for (std::size_t n = 0; n < of.size(); ++n)
        if (which.size() == 0 || std::ranges::find(which, n) != which.end())
            std::swap(of[n][0], of[n][1]);
    return of;
}
Triangles operator+(Triangles a, const Triangles& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}
Triangles without_top(Triangles of) {
    of.resize(10);
    return of;
}

TEST(MeshSides, outside_is_out) {
    const Triangles apart = box(1, {0, 0, 3}), within = box(0.2, {0.1, 0.1, 0.1});
    const struct {
        const char* what;
        Triangles mesh;
        double unit_m;
        std::uint64_t against, bodies, turned;
    } cases[] = {
        {"right", box() + apart, 1, 0, 0, 0},
        {"inside out", turned(box()), 1, 0, 1, 12},
        {"one of two", turned(box()) + apart, 1, 0, 1, 12},
        {"two that share an edge", turned(box()) + turned(box(1, {2, 1, 0})), 1, 0, 2, 24},
        {"some triangles", turned(box(), {1, 4, 7}), 1, 3, 0, 3},
        {"most triangles", turned(box(), {0, 1, 2, 3, 4, 5, 6, 7, 8}), 1, 3, 1, 9},
        {"open, and so it may be", turned(without_top(box())), 1, 0, 0, 0},
        {"open, but at odds", turned(without_top(box()), {2}), 1, 1, 0, 1},
        {"a room", turned(box(4)), 1, 0, 0, 0},
        {"the same in millimetres", turned(box(4)), 0.001, 0, 1, 12},
        {"a hollow", box() + turned(within), 1, 0, 0, 0},
        {"nothing", {}, 1, 0, 0, 0},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.what);
        TriangleMesh mesh;
        for (const auto& triangle : c.mesh) mesh.add(triangle);
        const MeshSides sides = find_sides(mesh, c.unit_m);
        EXPECT_EQ(sides.against_neighbours, c.against);
        EXPECT_EQ(sides.bodies, c.bodies);
        EXPECT_EQ(static_cast<std::uint64_t>(std::ranges::count(sides.turned, true)), c.turned);
        EXPECT_EQ(sides.notes().size(), std::size_t{c.against > 0} + std::size_t{c.bodies > 0});
    }
}

// Colours of meshes, on the points that their faces become.

class MeshColour : public test::Files {};

TEST_F(MeshColour, of_vertices_are_mixed_between_them) {
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
        "float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face "
        "1\nproperty list uchar int vertex_indices\nend_header\n";
    const auto ply = write("a.ply", head +
                                        "0 0 0 0 100 40\n1 0 0 200 100 40\n1 1 0 200 100 40\n"
                                        "0 1 0 0 100 40\n4 0 1 2 3\n");
    const auto obj = write("a.obj",
                           "v 0 0 0 0 0.392157 0.156863\nv 1 0 0 0.784314 0.392157 "
                           "0.156863\nv 1 1 0 0.784314 0.392157 0.156863\n"
                           "v 0 1 0 0 0.392157 0.156863\nf 1 2 3 4\n");
    for (const auto& file : {ply, obj}) {
        SCOPED_TRACE(file.filename());
        const auto cloud = read_cloud(file);
        ASSERT_EQ(cloud.red.size(), cloud.size());
        for (std::size_t n = 0; n < cloud.size(); ++n) {
            EXPECT_NEAR(cloud.red[n], 200 * cloud.x[n], 0.51);
            EXPECT_EQ(cloud.green[n], 100);
            EXPECT_EQ(cloud.blue[n], 40);
        }
    }
    for (const char* plain : {"box.obj", "box.stl", "box.glb", "box.ply"}) {
        const auto cloud = read_cloud(write(plain, test::box_file(plain)));
        EXPECT_TRUE(cloud.red.empty()) << plain;
    }
}

// What the writer of objects.glb makes of sRGB comes back.
TEST_F(MeshColour, of_materials_and_vertices_of_gltf) {
    std::vector<GlbNode> nodes{{"red", {200, 100, 40}, {}}, {"own", {9, 9, 9}, {}}};
    for (auto& node : nodes) {
        node.mesh.vertex = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        node.mesh.triangle = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    }
    for (Vec3& v : nodes[1].mesh.vertex) v[0] += 5;
    nodes[1].vertex_colour.assign(nodes[1].mesh.vertex.size(), {30, 130, 230});
    write_glb(path("a.glb"), nodes, {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}});
    const auto cloud = read_cloud(path("a.glb"));
    ASSERT_EQ(cloud.red.size(), cloud.size());
    for (std::size_t n = 0; n < cloud.size(); ++n) {
        const bool first = cloud.x[n] < 3;
        EXPECT_NEAR(cloud.red[n], first ? 200 : 30, 1);
        EXPECT_NEAR(cloud.green[n], first ? 100 : 130, 1);
        EXPECT_NEAR(cloud.blue[n], first ? 40 : 230, 1);
    }
}

// A square of 1 m with an image of 2 x 2 pixels: glTF's v runs down.
std::string textured_glb(const std::string& image, const std::string& mime) {
    std::string buffer;
    for (const auto& corner : {std::array{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        for (const int v : {corner[0], corner[1], 0}) test::append(buffer, static_cast<float>(v));
    }
    for (const auto& corner : {std::array{0, 1}, {1, 1}, {1, 0}, {0, 0}}) {
        for (const int v : corner) test::append(buffer, static_cast<float>(v));
    }
    for (const int index : {0, 1, 2, 0, 2, 3})
        test::append(buffer, static_cast<std::uint16_t>(index));
    const std::string size = std::to_string(image.size());
    buffer += image;
    std::string json =
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,)"
        R"("material":0}]}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],)"
        R"("textures":[{"source":0}],"images":[{"bufferView":3,"mimeType":"image/)" +
        mime +
        R"("}],"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3",)"
        R"("min":[0,0,0],"max":[1,1,0]},{"bufferView":1,"componentType":5126,"count":4,)"
        R"("type":"VEC2"},{"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}],)"
        R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},)"
        R"({"buffer":0,"byteOffset":48,"byteLength":32},{"buffer":0,"byteOffset":80,)"
        R"("byteLength":12},{"buffer":0,"byteOffset":92,"byteLength":)" +
        size + R"(}],"buffers":[{"byteLength":)" + std::to_string(buffer.size()) + "}]}";
    return test::glb_of(json, buffer);
}

TEST_F(MeshColour, of_images_within_the_file) {
    const std::vector<std::uint8_t> pixels{200, 0, 0, 0, 200, 0, 0, 0, 200, 90, 90, 90};
    const std::string png = test::png_bytes(2, 2, 8, PNG_COLOR_TYPE_RGB, pixels);
    const auto cloud = read_cloud(write("a.glb", textured_glb(png, "png")));
    ASSERT_EQ(cloud.red.size(), cloud.size());
    for (std::size_t n = 0; n < cloud.size(); ++n) {
        const double x = cloud.x[n], y = cloud.y[n];
        if (std::abs(x - 0.5) < 1e-3 || std::abs(y - 0.5) < 1e-3) continue;
        const std::size_t pixel = (y > 0.5 ? 0 : 2) + (x > 0.5 ? 1 : 0);
        EXPECT_EQ(cloud.red[n], pixels[3 * pixel]) << x << " " << y;
        EXPECT_EQ(cloud.green[n], pixels[3 * pixel + 1]) << x << " " << y;
        EXPECT_EQ(cloud.blue[n], pixels[3 * pixel + 2]) << x << " " << y;
    }
    // A mesh is a mesh without its image, too.
    const auto broken = read_cloud(write("a.glb", textured_glb(png.substr(0, 60), "png")));
    EXPECT_TRUE(broken.red.empty());
    ASSERT_EQ(broken.notes.size(), 1u);
    EXPECT_THAT(broken.notes[0], testing::HasSubstr("cut short"));
}

}  // namespace
}  // namespace topple::io

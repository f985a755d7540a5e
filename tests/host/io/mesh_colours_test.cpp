// SPDX-License-Identifier: MIT
#include <cmath>

#include "colour_image.h"
#include "files.h"
#include "mesh_files.h"
#include "points/formats/read_cloud.h"
#include "result/write_glb.h"

// Colours of meshes, on the points that their faces become.
namespace topple::io {
namespace {

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
        const std::string name = plain;
        const auto cloud = read_cloud(write(name, name.ends_with("obj")   ? test::box_obj()
                                                  : name.ends_with("stl") ? test::box_stl()
                                                  : name.ends_with("glb") ? test::box_glb()
                                                                          : test::box_ply()));
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
    while (buffer.size() % 4 != 0) buffer.push_back('\0');
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
    while (json.size() % 4 != 0) json.push_back(' ');
    std::string out = "glTF";
    test::append<std::uint32_t>(out, 2);
    test::append<std::uint32_t>(out, std::uint32_t(28 + json.size() + buffer.size()));
    test::append<std::uint32_t>(out, std::uint32_t(json.size()));
    out.append("JSON").append(json);
    test::append<std::uint32_t>(out, std::uint32_t(buffer.size()));
    out.append("BIN").push_back('\0');
    return out + buffer;
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

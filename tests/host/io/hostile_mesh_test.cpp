// SPDX-License-Identifier: MIT
#include <filesystem>

#include "mesh_files.h"
#include "points/formats/gltf_checks.h"
#include "points/formats/obj_surface.h"
#include "points/formats/read_cloud.h"

// Meshes that would have the library which reads them take far more than their size.
namespace topple::io {
namespace {

using test::expect_input_error;

class HostileMesh : public test::Files {
  protected:
    void refused(const std::string& json, std::initializer_list<std::string_view> message) const {
        expect_input_error([&] { check_gltf(path("a.gltf"), json, std::nullopt); }, message);
    }
    void taken(const std::string& json) const { check_gltf(path("a.gltf"), json, std::nullopt); }
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

}  // namespace
}  // namespace topple::io

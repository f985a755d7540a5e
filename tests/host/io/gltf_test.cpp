// SPDX-License-Identifier: MIT
#include <assimp/scene.h>

#include <assimp/Importer.hpp>

#include "mesh_files.h"
#include "points/formats/read_cloud.h"
#include "result/write_glb.h"

// What glTF may hold beside floats in a row.
namespace topple::io {
namespace {

using test::append;
using test::expect_input_error;

// A box of one primitive. Corners are at byte 0, what else `binary` holds is at 512 and 1024.
struct Box {
    std::string node, accessors, views, primitive = R"("attributes":{"POSITION":0},"indices":1)",
                                        more;
    std::string corners, second, third;

    std::string glb() const {
        std::string binary = corners;
        binary.resize(512, '\0');
        binary += second;
        binary.resize(1024, '\0');
        binary += third;
        binary.resize(1536, '\0');
        return test::glb_of(
            R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" +
                node + R"(}],"meshes":[{"primitives":[{)" + primitive + R"(}]}],"accessors":[)" +
                accessors + R"(],"bufferViews":[)" + views + "]" + more +
                R"(,"buffers":[{"byteLength":1536}]})",
            binary);
    }
};

const std::string index_view = R"({"buffer":0,"byteOffset":512,"byteLength":512})";
std::string accessor(int view, int component, int count, const char* type,
                     const std::string& more = "") {
    return R"({"bufferView":)" + std::to_string(view) + R"(,"componentType":)" +
           std::to_string(component) + R"(,"count":)" + std::to_string(count) + R"(,"type":")" +
           type + "\"" + more + "}";
}

template <class T>
std::string numbers(const std::vector<double>& values, std::size_t pad_after_three = 0) {
    std::string out;
    for (std::size_t n = 0; n < values.size(); ++n) {
        append<T>(out, static_cast<T>(values[n]));
        if (n % 3 == 2) out.append(pad_after_three, '\0');
    }
    return out;
}

// The box's corners, times a factor.
std::vector<double> corners(double factor = 1) {
    std::vector<double> out;
    for (const auto& corner : test::box_corners())
        for (const double v : corner) out.push_back(v * factor);
    return out;
}
std::vector<double> triangle_indices() {
    std::vector<double> out;
    for (const auto& triangle : test::box_triangles())
        out.insert(out.end(), triangle.begin(), triangle.end());
    return out;
}

Box plain_box() {
    Box box;
    box.views = R"({"buffer":0,"byteLength":512},)" + index_view;
    box.accessors = accessor(0, 5126, 8, "VEC3") + "," + accessor(1, 5123, 36, "SCALAR");
    box.corners = numbers<float>(corners());
    box.second = numbers<std::uint16_t>(triangle_indices());
    return box;
}

class Gltf : public test::Files {
  protected:
    // Points with normals that face out of the box.
    void expect_box(const std::string& glb) const {
        const auto cloud = read_cloud(write("a.glb", glb));
        EXPECT_NEAR(static_cast<double>(cloud.size()), 70000, 10);
        EXPECT_EQ(up_of_format(path("a.glb")), (Vec3{0, 1, 0}));
        EXPECT_EQ(cloud.notes, std::vector<std::string>());
        std::size_t off = 0, inwards = 0;
        for (std::size_t n = 0; n < cloud.size(); ++n) {
            const std::array<double, 3> p{cloud.x[n], cloud.y[n], cloud.z[n]},
                normal{cloud.nx[n], cloud.ny[n], cloud.nz[n]};
            double nearest = 1, out = 0;
            for (std::size_t a = 0; a < 3; ++a) {
                nearest = std::min({nearest, std::abs(p[a]), std::abs(p[a] - test::box_size[a])});
                out += normal[a] * (p[a] - test::box_size[a] / 2);
            }
            off += nearest > 1e-4;
            inwards += out < 0;
        }
        EXPECT_EQ(off, 0u);
        EXPECT_EQ(inwards, 0u);
    }
};

TEST_F(Gltf, shapes_however_they_are_stored) {
    const auto changed = [](const auto& change) {
        Box box = plain_box();
        change(box);
        return box;
    };
    const std::string shorts = R"(,"normalized":true)";
    const std::pair<const char*, Box> cases[] = {
        {"plain", plain_box()},
        {"shorts of a node that scales", changed([&](Box& b) {
             b.corners = numbers<std::int16_t>(corners(1000), 2);
             b.accessors = accessor(0, 5122, 8, "VEC3") + "," + accessor(1, 5123, 36, "SCALAR");
             b.views = R"({"buffer":0,"byteLength":64,"byteStride":8},)" + index_view;
             b.node = R"(,"scale":[0.001,0.001,0.001])";
             b.more = R"(,"extensionsRequired":["KHR_mesh_quantization","KHR_texture_transform"])";
         })},
        {"normalised shorts", changed([&](Box& b) {
             b.corners = numbers<std::int16_t>(corners(32767 / 2.0), 2);
             b.accessors =
                 accessor(0, 5122, 8, "VEC3", shorts) + "," + accessor(1, 5123, 36, "SCALAR");
             b.views = R"({"buffer":0,"byteLength":64,"byteStride":8},)" + index_view;
             b.node = R"(,"scale":[2,2,2])";
         })},
        {"bytes, and indices of bytes", changed([&](Box& b) {
             b.corners = numbers<std::uint8_t>(corners(2), 1);
             b.second = numbers<std::uint8_t>(triangle_indices());
             b.accessors = accessor(0, 5121, 8, "VEC3") + "," + accessor(1, 5121, 36, "SCALAR");
             b.views = R"({"buffer":0,"byteLength":32,"byteStride":4},)" + index_view;
             b.node = R"(,"matrix":[0.5,0,0,0,0,0.5,0,0,0,0,0.5,0,0,0,0,1])";
         })},
        {"interleaved, indices of 32 bits", changed([&](Box& b) {
             b.corners = numbers<float>(corners(), 12);
             b.second = numbers<std::uint32_t>(triangle_indices());
             b.accessors = accessor(0, 5126, 8, "VEC3") + "," + accessor(1, 5125, 36, "SCALAR");
             b.views = R"({"buffer":0,"byteLength":192,"byteStride":24},)" + index_view;
         })},
        {"sparse over zeros", changed([&](Box& b) {
             std::vector<double> places{1, 2, 3, 4, 5, 6, 7}, values = corners();
             values.erase(values.begin(), values.begin() + 3);
             b.corners = numbers<float>(values);
             b.third = numbers<std::uint8_t>(places);
             b.views += R"(,{"buffer":0,"byteOffset":1024,"byteLength":7})";
             b.accessors =
                 R"({"componentType":5126,"count":8,"type":"VEC3","sparse":{"count":7,"indices":{"bufferView":2,)"
                 R"("componentType":5121},"values":{"bufferView":0}}},)" +
                 accessor(1, 5123, 36, "SCALAR");
         })},
        {"a node that mirrors", changed([&](Box& b) {
             std::vector<double> values = corners();
             for (std::size_t n = 0; n < values.size(); n += 3) values[n] *= -1;
             b.corners = numbers<float>(values);
             b.node = R"(,"scale":[-1,1,1])";
             std::vector<double> turned = triangle_indices();
             // The mesh itself, mirrored, faces outwards, too.
             for (std::size_t n = 0; n < turned.size(); n += 3) std::swap(turned[n], turned[n + 1]);
             b.second = numbers<std::uint16_t>(turned);
         })},
    };
    for (const auto& [what, box] : cases) {
        SCOPED_TRACE(what);
        expect_box(box.glb());
    }
}

TEST_F(Gltf, strips_and_fans_face_one_side) {
    for (const auto& [mode, order] : {std::pair("5", std::vector<double>{0, 1, 2, 3}),
                                      {"6", std::vector<double>{0, 1, 3, 2}}}) {
        Box quad = plain_box();
        quad.primitive += R"(,"mode":)" + std::string(mode);
        quad.second = numbers<std::uint16_t>(order);
        quad.accessors = accessor(0, 5126, 8, "VEC3") + "," + accessor(1, 5123, 4, "SCALAR");
        const auto cloud = read_cloud(write("a.glb", quad.glb()));
        EXPECT_EQ(std::ranges::count(cloud.nz, 1.0f), std::ssize(cloud.nz)) << mode;
        EXPECT_NEAR(*std::ranges::max_element(cloud.x), 2, 0.01);
    }
}

TEST_F(Gltf, points_are_a_cloud) {
    Box box = plain_box();
    box.primitive = R"("attributes":{"POSITION":0},"mode":0)";
    box.node = R"(,"translation":[0,0,10])";
    const auto cloud = read_cloud(write("a.glb", box.glb()));
    ASSERT_EQ(cloud.size(), 8u);
    EXPECT_EQ(cloud.z[7], 10.5f);
    EXPECT_TRUE(cloud.nx.empty());
    const auto obj = read_cloud(write("a.obj", "v 1 2 3 1 0.2 0\nvn 0 0 1\nv 4 5 6 0 1 0\n"));
    EXPECT_EQ(obj.y, (std::vector<float>{2, 5}));
    EXPECT_EQ(obj.green, (std::vector<std::uint8_t>{51, 255}));
    EXPECT_EQ(read_cloud(write("a.obj", "v 1 2 3\nv 4 5 6\n")).size(), 2u);
}

TEST_F(Gltf, what_is_not_read_is_named) {
    const auto box = [](const std::string& more, const std::string& of_primitive = "") {
        Box out = plain_box();
        out.more = more;
        if (!of_primitive.empty()) {
            out.primitive += of_primitive;
            out.accessors = R"({"componentType":5126,"count":8,"type":"VEC3"},)" +
                            accessor(1, 5123, 36, "SCALAR");
        }
        return out;
    };
    Box sparse = plain_box();
    sparse.accessors =
        accessor(
            0, 5126, 8, "VEC3",
            R"(,"sparse":{"count":1,"indices":{"bufferView":1,"byteOffset":500,"componentType":5125},)"
            R"("values":{"bufferView":0}})") +
        "," + accessor(1, 5123, 36, "SCALAR");
    sparse.second.resize(500, '\0');
    append<std::uint32_t>(sparse.second, 8);
    const std::pair<Box, std::vector<std::string_view>> cases[] = {
        {box(R"(,"extensionsRequired":["KHR_draco_mesh_compression"])"),
         {"KHR_draco_mesh_compression", "gltf-pipeline"}},
        {box("", R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0}})"),
         {"KHR_draco_mesh_compression", "gltf-pipeline"}},
        {box(R"(,"extensionsRequired":["EXT_meshopt_compression"])"), {"EXT_meshopt_compression"}},
        {box(R"(,"extensionsRequired":["ACME_shape"])"), {"ACME_shape", "not read"}},
        {sparse, {"element 8 of 8", "damaged"}},
    };
    for (const auto& [bad, message] : cases)
        expect_input_error([&] { read_cloud(write("a.glb", bad.glb())); }, message);
}

// By the divergence theorem.
template <class Mesh>
double volume_of(const Mesh& mesh) {
    double six = 0;
    for (const auto& t : mesh.triangle) {
        const Vec3 &a = mesh.vertex[t[0]], &b = mesh.vertex[t[1]], &c = mesh.vertex[t[2]];
        six += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    return six / 6;
}

// A box of which the corners come three times, once for each of its faces' normals.
GlbMesh box(const Vec3& low, const Vec3& size) {
    GlbMesh out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const bool upper : {false, true}) {
            const auto first = static_cast<std::uint32_t>(out.vertex.size());
            for (const auto& [u, v] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
                Vec3 at = low, normal{};
                at[axis] += upper ? size[axis] : 0;
                at[(axis + 1) % 3] += u * size[(axis + 1) % 3];
                at[(axis + 2) % 3] += v * size[(axis + 2) % 3];
                normal[axis] = upper ? 1 : -1;
                out.vertex.push_back(at);
                out.normal.push_back(normal);
            }
            const std::uint32_t b = upper ? 1 : 3, d = upper ? 3 : 1;
            out.triangle.push_back({first, first + b, first + 2});
            out.triangle.push_back({first, first + 2, first + d});
        }
    }
    return out;
}

class Glb : public test::Files {};

TEST_F(Glb, loads_again_with_names_colours_places_and_volumes) {
    std::vector<GlbNode> nodes{{"object 0", {150, 150, 150}, box({-0.1, 0.2, 0.3}, {0.25, 0.5, 1})},
                               {"object 7", {255, 0, 51}, box({1, 2, 3}, {0.5, 0.125, 0.25})}};
    nodes[1].mesh.normal.clear();
    // z up to y up.
    write_glb(path("a.glb"), nodes, {Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, -1, 0}});
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path("a.glb").string(), 0);
    ASSERT_TRUE(scene) << importer.GetErrorString();
    ASSERT_EQ(scene->mRootNode->mNumChildren, 2u);
    const aiVector3D up = aiMatrix3x3(scene->mRootNode->mTransformation) * aiVector3D(0, 0, 1);
    EXPECT_NEAR(up.y, 1, 1e-6);
    for (unsigned n = 0; n < 2; ++n) {
        const aiNode& node = *scene->mRootNode->mChildren[n];
        EXPECT_EQ(std::string(node.mName.C_Str()), nodes[n].name);
        ASSERT_EQ(node.mNumMeshes, 1u);
        const aiMesh& mesh = *scene->mMeshes[node.mMeshes[0]];
        GlbMesh read;
        for (unsigned v = 0; v < mesh.mNumVertices; ++v)
            read.vertex.push_back({mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z});
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            ASSERT_EQ(mesh.mFaces[f].mNumIndices, 3u);
            const unsigned* i = mesh.mFaces[f].mIndices;
            read.triangle.push_back({i[0], i[1], i[2]});
        }
        EXPECT_NEAR(volume_of(read), n == 0 ? 0.125 : 0.015625, 1e-6);
        ASSERT_EQ(mesh.HasNormals(), n == 0);
        for (unsigned v = 0; n == 0 && v < mesh.mNumVertices; ++v) {
            const Vec3& normal = nodes[0].mesh.normal.at(v);
            EXPECT_EQ(mesh.mNormals[v].x, static_cast<float>(normal[0]));
            EXPECT_EQ(mesh.mNormals[v].z, static_cast<float>(normal[2]));
        }
        aiColor4D colour;
        ASSERT_EQ(scene->mMaterials[mesh.mMaterialIndex]->Get(AI_MATKEY_BASE_COLOR, colour),
                  aiReturn_SUCCESS);
        EXPECT_NEAR(colour.r, n == 0 ? 0.3050 : 1, 1e-3);
        EXPECT_NEAR(colour.b, n == 0 ? 0.3050 : 0.0331, 1e-3);
    }
}

}  // namespace
}  // namespace topple::io

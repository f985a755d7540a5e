// SPDX-License-Identifier: MIT
#include "io/read_mesh.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <vector>

#include "io/cloud_builder.h"
#include "io/mesh_checks.h"
#include "io/mesh_colours.h"
#include "io/text.h"
#include "io/triangulate.h"

namespace topple::io {
namespace {

struct Triangle {
    std::array<aiVector3t<double>, 3> corner;
    aiVector3t<double> normal;  // unit
    double area = 0;
    std::uint32_t mesh = 0;  // of the scene's, and which of its vertices the corners are
    std::array<std::uint32_t, 3> vertex{};
};

struct Triangles {
    std::vector<Triangle> all;
    double area = 0;
    std::uint64_t broken = 0;  // with a corner that is not finite
};

void append(const std::array<aiVector3t<double>, 3>& corner, std::uint32_t mesh,
            const std::array<std::uint32_t, 3>& vertex, Triangles& out) {
    auto normal = (corner[1] - corner[0]) ^ (corner[2] - corner[0]);
    const double length = normal.Length();
    if (!std::isfinite(length)) {
        ++out.broken;
    } else if (length > 0) {
        normal /= length;
        out.area += length / 2;
        out.all.push_back({corner, normal, length / 2, mesh, vertex});
    }
}

void append(const aiScene& scene, std::uint32_t number, const aiMatrix4x4t<double>& to_world,
            Triangles& out) {
    const aiMesh& mesh = *scene.mMeshes[number];
    std::vector<Vec3> polygon;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        polygon.clear();
        for (unsigned c = 0; c < face.mNumIndices && face.mIndices[c] < mesh.mNumVertices; ++c) {
            const aiVector3D& v = mesh.mVertices[face.mIndices[c]];
            const auto p = to_world * aiVector3t<double>(v.x, v.y, v.z);
            polygon.push_back({p.x, p.y, p.z});
        }
        if (polygon.size() < face.mNumIndices) {
            ++out.broken;
            continue;
        }
        const auto at = [&](std::size_t c) {
            return aiVector3t<double>(polygon[c][0], polygon[c][1], polygon[c][2]);
        };
        for (const auto& t : triangulate(polygon)) {
            append({at(t[0]), at(t[1]), at(t[2])}, number,
                   {face.mIndices[t[0]], face.mIndices[t[1]], face.mIndices[t[2]]}, out);
        }
    }
}

// Every mesh at every place where a node shows it.
Triangles triangles_of(const aiScene& scene) {
    struct Placed {
        const aiNode* node;
        aiMatrix4x4t<double> to_world;
    };
    Triangles out;
    std::vector<Placed> left{{scene.mRootNode, {}}};
    while (!left.empty()) {
        const Placed at = left.back();
        left.pop_back();
        const auto& m = at.node->mTransformation;
        const aiMatrix4x4t<double> own(m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2,
                                       m.c3, m.c4, m.d1, m.d2, m.d3, m.d4);
        const auto to_world = at.to_world * own;
        for (unsigned n = 0; n < at.node->mNumMeshes; ++n)
            append(scene, at.node->mMeshes[n], to_world, out);
        for (unsigned n = at.node->mNumChildren; n > 0; --n)
            left.push_back({at.node->mChildren[n - 1], to_world});
    }
    return out;
}

// Points of a triangle mesh: as many on each triangle as its area has, evenly spread by the
// additive sequence of the plastic number (Roberts's R2), which is the same on every machine.
PointCloud sample(const std::filesystem::path& file, const Triangles& triangles,
                  const MeshColours& colours, double unit_m, const MeshSampling& sampling) {
    const double area_m2 = triangles.area * unit_m * unit_m;
    const double wanted =
        std::clamp(area_m2 / (sampling.spacing_m * sampling.spacing_m),
                   static_cast<double>(sampling.fewest), static_cast<double>(sampling.most));
    const double per_area = wanted / triangles.area;
    constexpr double step_u = 0.7548776662466927, step_v = 0.5698402909980532;
    CloudFields fields{.normals = true};
    if (colours.any()) fields.colours = ColourValues::bytes;
    CloudBuilder cloud(file, static_cast<std::uint64_t>(wanted) + 1, fields);
    double due = 0.5;
    for (const Triangle& t : triangles.all) {
        due += t.area * per_area;
        const auto side_u = t.corner[1] - t.corner[0], side_v = t.corner[2] - t.corner[0];
        for (; due >= 1; due -= 1) {
            const auto n = static_cast<double>(cloud.seen() + 1);
            double u = std::fmod(n * step_u, 1.0), v = std::fmod(n * step_v, 1.0);
            if (u + v > 1) {
                u = 1 - u;
                v = 1 - v;
            }
            const auto p = t.corner[0] + side_u * u + side_v * v;
            cloud.add({p.x, p.y, p.z}, {t.normal.x, t.normal.y, t.normal.z},
                      colours.any() ? colours.at({t.mesh, t.vertex, {1 - u - v, u, v}})
                                    : std::array<double, 3>{});
        }
    }
    PointCloud out = cloud.finish();
    out.notes = colours.notes();
    if (triangles.broken > 0) {
        out.notes.push_back(counted(triangles.broken, "triangle") +
                            " without three finite corners left out.");
    }
    return out;
}

const char* hint_of(MeshFormat format) {
    switch (format) {
        case MeshFormat::obj:
            return "obj";
        case MeshFormat::ply:
            return "ply";
        case MeshFormat::stl:
            return "stl";
        case MeshFormat::glb:
            return "glb";
        case MeshFormat::gltf:
            return "gltf";
    }
    return "";
}

}  // namespace

std::optional<PointCloud> parse_mesh(const std::filesystem::path& file, std::string_view bytes,
                                     MeshFormat format, double unit_m,
                                     const MeshSampling& sampling) {
    check_mesh(file, bytes, format);
    Assimp::Importer importer;
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    // Refuses indices that point nowhere. Polygons are cut here: the library's own step for that
    // ends the program where a file has faces of two corners only.
    constexpr unsigned steps = aiProcess_ValidateDataStructure;
    const aiScene* scene = nullptr;
    std::string reason;
    try {
        // glTF as text has its numbers in files beside it.
        scene = format == MeshFormat::gltf ? importer.ReadFile(file.string(), steps)
                                           : importer.ReadFileFromMemory(bytes.data(), bytes.size(),
                                                                         steps, hint_of(format));
        if (!scene) reason = importer.GetErrorString();
    } catch (const std::exception& error) {
        reason = error.what();
    }
    if (!scene || !scene->mRootNode)
        fail(file, "is no mesh that can be read: " + printable(reason, 200));
    const Triangles triangles = triangles_of(*scene);
    if (!std::isfinite(triangles.area))
        fail(file, "its triangles have no finite area; coordinates must be metres");
    if (!(triangles.area > 0)) return std::nullopt;
    return sample(file, triangles, MeshColours(file, *scene, format), unit_m, sampling);
}

}  // namespace topple::io

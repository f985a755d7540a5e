// SPDX-License-Identifier: MIT
#include "points/formats/read_mesh.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <vector>

#include "io/open_file.h"
#include "io/text.h"
#include "points/formats/cloud_builder.h"
#include "points/formats/formats.h"
#include "points/formats/gltf.h"
#include "points/formats/import_budget.h"
#include "points/formats/mesh_colours.h"
#include "points/formats/mesh_sides.h"
#include "points/formats/obj_surface.h"
#include "points/formats/ply_file.h"
#include "points/formats/scalar.h"
#include "points/formats/triangulate.h"

namespace topple::io {
namespace {

// Faces that a file may show by naming its meshes again and again.
constexpr std::uint64_t most_repeated_faces = 20'000'000;

struct Triangle {
    std::array<aiVector3t<double>, 3> corner;
    aiVector3t<double> normal;  // unit
    double area = 0;
    std::uint32_t mesh = 0;  // of the scene's, and which of its vertices the corners are
    std::array<std::uint32_t, 3> vertex{};
};

// The triangles of a scene, every mesh at every place where a node shows it, again each time that
// they are asked for: held, they would take more than the file.
class Triangles {
  public:
    Triangles(const std::filesystem::path& file, const aiScene& scene, std::uint64_t file_bytes)
        : scene_(scene) {
        place(file, file_bytes);
        each([&](const Triangle& t) {
            area_ += t.area;
            ++count_;
        });
        counted_ = true;
    }

    // Has those turned that face the wrong side (mesh_sides.h); returns what there is to say.
    std::vector<std::string> turn(double unit_m) {
        constexpr std::uint64_t most = 5'000'000;  // beyond them it takes too much memory
        if (count_ > most) return {};
        TriangleMesh mesh;
        each([&](const Triangle& t) {
            std::array<Vec3, 3> corners{};
            for (std::size_t c = 0; c < 3; ++c)
                corners[c] = {t.corner[c].x, t.corner[c].y, t.corner[c].z};
            // As the triangle faces, which a node that mirrors changes.
            if (mirrored_) std::swap(corners[1], corners[2]);
            mesh.add(corners);
        });
        MeshSides sides = find_sides(mesh, unit_m);
        turned_ = std::move(sides.turned);
        return sides.notes();
    }

    double area() const { return area_; }
    std::uint64_t broken() const { return broken_; }  // with a corner that is not finite

    template <class Use>
    void each(const Use& use) {
        given_ = 0;
        for (const Placed& at : placed_) {
            for (unsigned n = 0; n < at.node->mNumMeshes; ++n)
                each_of(at.node->mMeshes[n], at.to_world, use);
        }
    }

    // All corners, as use(place, mesh, vertex).
    template <class Use>
    void each_vertex(const Use& use) const {
        for (const Placed& at : placed_) {
            for (unsigned n = 0; n < at.node->mNumMeshes; ++n) {
                const std::uint32_t mesh = at.node->mMeshes[n];
                for (std::uint32_t v = 0; v < scene_.mMeshes[mesh]->mNumVertices; ++v) {
                    const aiVector3D& p = scene_.mMeshes[mesh]->mVertices[v];
                    use(at.to_world * aiVector3t<double>(p.x, p.y, p.z), mesh, v);
                }
            }
        }
    }

  private:
    struct Placed {
        const aiNode* node;
        aiMatrix4x4t<double> to_world;
    };

    // A corner takes a byte of the file at least, unless its mesh is shown more than once.
    void place(const std::filesystem::path& file, std::uint64_t file_bytes) {
        const std::uint64_t most = std::max<std::uint64_t>(most_repeated_faces, file_bytes);
        std::uint64_t faces = 0;
        std::vector<Placed> left{{scene_.mRootNode, {}}};
        while (!left.empty()) {
            const Placed at = left.back();
            left.pop_back();
            const auto& m = at.node->mTransformation;
            const aiMatrix4x4t<double> own(m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1,
                                           m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4);
            const Placed here{at.node, at.to_world * own};
            for (unsigned n = 0; n < at.node->mNumMeshes; ++n)
                faces += scene_.mMeshes[at.node->mMeshes[n]]->mNumFaces;
            if (faces > most) {
                fail(file, "shows its meshes in so many places that they have more than " +
                               counted(most, "face") + "; leave some out");
            }
            if (at.node->mNumMeshes > 0) placed_.push_back(here);
            for (unsigned n = at.node->mNumChildren; n > 0; --n)
                left.push_back({at.node->mChildren[n - 1], here.to_world});
        }
    }

    template <class Use>
    void each_of(std::uint32_t number, const aiMatrix4x4t<double>& to_world, const Use& use) {
        const aiMesh& mesh = *scene_.mMeshes[number];
        // A node that mirrors has its faces turn the other way (glTF 2.0, 3.7.4).
        mirrored_ = to_world.Determinant() < 0;
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            polygon_.clear();
            for (unsigned c = 0; c < face.mNumIndices && face.mIndices[c] < mesh.mNumVertices;
                 ++c) {
                const aiVector3D& v = mesh.mVertices[face.mIndices[c]];
                const auto p = to_world * aiVector3t<double>(v.x, v.y, v.z);
                polygon_.push_back({p.x, p.y, p.z});
            }
            if (polygon_.size() < face.mNumIndices) {
                broken_ += !counted_;
                continue;
            }
            for (const auto& t : triangulate(polygon_))
                give(number, {face.mIndices[t[0]], face.mIndices[t[1]], face.mIndices[t[2]]}, t,
                     use);
        }
    }

    template <class Use>
    void give(std::uint32_t mesh, const std::array<std::uint32_t, 3>& vertex,
              const std::array<std::size_t, 3>& corners, const Use& use) {
        const auto at = [&](std::size_t c) {
            return aiVector3t<double>(polygon_[c][0], polygon_[c][1], polygon_[c][2]);
        };
        Triangle t{{at(corners[0]), at(corners[1]), at(corners[2])}, {}, 0, mesh, vertex};
        t.normal = (t.corner[1] - t.corner[0]) ^ (t.corner[2] - t.corner[0]);
        if (mirrored_) t.normal *= -1.0;
        const double length = t.normal.Length();
        if (!std::isfinite(length)) {
            broken_ += !counted_;
        } else if (length > 0) {
            t.normal /= length;
            t.area = length / 2;
            if (!turned_.empty() && turned_[given_]) t.normal *= -1.0;
            ++given_;
            use(t);
        }
    }

    const aiScene& scene_;
    std::vector<Placed> placed_;
    std::vector<Vec3> polygon_;
    double area_ = 0;
    std::uint64_t count_ = 0, given_ = 0;  // of all, and so far
    std::vector<bool> turned_;             // of each; or empty
    std::uint64_t broken_ = 0;
    bool mirrored_ = false;  // the mesh that is walked over
    bool counted_ = false;
};

// Points of a triangle mesh: as many on each triangle as its area has, evenly spread by the
// additive sequence of the plastic number (Roberts's R2), which is the same on every machine.
PointCloud sample(const std::filesystem::path& file, Triangles& triangles,
                  const MeshColours& colours, double unit_m, const MeshSampling& sampling) {
    const double area_m2 = triangles.area() * unit_m * unit_m;
    const double wanted =
        std::clamp(area_m2 / (sampling.spacing_m * sampling.spacing_m),
                   static_cast<double>(sampling.fewest), static_cast<double>(sampling.most));
    const double per_area = wanted / triangles.area();
    constexpr double step_u = 0.7548776662466927, step_v = 0.5698402909980532;
    CloudFields fields{.normals = true};
    if (colours.any()) fields.colours = ColourValues::bytes;
    CloudBuilder cloud(file, static_cast<std::uint64_t>(wanted) + 1, fields);
    double due = 0.5;
    triangles.each([&](const Triangle& t) {
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
            FilePoint point{{p.x, p.y, p.z}, {t.normal.x, t.normal.y, t.normal.z}};
            if (colours.any()) point.colour = colours.at({t.mesh, t.vertex, {1 - u - v, u, v}});
            cloud.add(point);
        }
    });
    PointCloud out = cloud.finish();
    out.notes = colours.notes();
    if (triangles.broken() > 0) {
        out.notes.push_back(counted(triangles.broken(), "triangle") +
                            " without three finite corners left out.");
    }
    return out;
}

// The corners of a mesh that shows nothing but points.
std::optional<PointCloud> points_of(const std::filesystem::path& file, const aiScene& scene,
                                    const Triangles& triangles, const MeshColours& colours) {
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        if (scene.mMeshes[m]->mPrimitiveTypes != aiPrimitiveType_POINT) return std::nullopt;
    CloudFields fields;
    if (colours.any()) fields.colours = ColourValues::bytes;
    CloudBuilder cloud(file, 0, fields);
    triangles.each_vertex([&](const aiVector3t<double>& p, std::uint32_t mesh, std::uint32_t v) {
        FilePoint point{{p.x, p.y, p.z}};
        if (colours.any()) point.colour = colours.at({mesh, {v, v, v}, {1, 0, 0}});
        cloud.add(point);
    });
    PointCloud out = cloud.finish();
    out.notes = colours.notes();
    return out;
}

// The files that the library which reads meshes may open: the mesh's own and, where it has parts
// in others, those of file_beside(); of a mesh in memory, none.
class FilesBeside final : public Assimp::DefaultIOSystem {
  public:
    FilesBeside(std::filesystem::path file, bool has_parts)
        : file_(std::move(file)), has_parts_(has_parts) {}

    bool Exists(const char* name) const override { return resolved(name).has_value(); }
    Assimp::IOStream* Open(const char* name, const char* mode) override {
        const std::optional<FileName> found = resolved(name);
        if (!found || mode[0] != 'r') return nullptr;
        try {
            return new Stream(*found);
        } catch (const Error&) {
            return nullptr;
        }
    }

  private:
    // Of what is open, so that nothing is looked up by name once more.
    class Stream final : private MappedFile, public Assimp::MemoryIOStream {
      public:
        explicit Stream(const FileName& name)
            : MappedFile(name),
              MemoryIOStream(reinterpret_cast<const std::uint8_t*>(text().data()), text().size()) {}
    };

    // None: not to be opened. The library puts the folder before names, or not.
    std::optional<FileName> resolved(const std::string& name) const {
        if (!has_parts_) return std::nullopt;
        if (name == file_.string()) return file_;
        const std::filesystem::path folder = file_.parent_path();
        const std::filesystem::path relative =
            folder.empty() ? std::filesystem::path(name)
                           : std::filesystem::path(name).lexically_relative(folder);
        try {
            return file_beside(file_, relative.string());
        } catch (const Error&) {
            return std::nullopt;
        }
    }

    std::filesystem::path file_;
    bool has_parts_;
};

// Each becomes a mesh of its own, with a node and a name of a kilobyte.
void check_stl_solids(const std::filesystem::path& file, std::string_view bytes) {
    constexpr std::uint64_t solid_bytes = 4096;
    std::uint64_t solids = 0;
    Lines lines(bytes);
    for (std::string_view line; lines.next(line);) solids += next_token(line) == "solid";
    ImportWeight(file, bytes.size()).add(solids, solid_bytes, "solid");
}

// A binary STL is 80 bytes of anything, a count, and 50 bytes a triangle.
void check_stl(const std::filesystem::path& file, std::string_view bytes) {
    const bool text = bytes.starts_with("solid") &&
                      bytes.substr(0, 1024).find("facet") != std::string_view::npos &&
                      bytes.substr(0, 1024).find('\0') == std::string_view::npos;
    if (text) return check_stl_solids(file, bytes);
    if (bytes.size() < 84) fail(file, "is no STL: it is shorter than the 84 bytes of its header");
    const auto triangles = value_at<std::uint32_t>(bytes, 80);
    const std::uint64_t need = 84 + std::uint64_t{50} * triangles;
    if (need != bytes.size()) {
        fail(file, "promises " + counted(triangles, "triangle") + ", which take " +
                       counted(need, "byte") + ", but has " + std::to_string(bytes.size()) +
                       "; it is cut short or no STL");
    }
}

const char* hint_of(MeshFormat format) {
    constexpr std::array hints{"obj", "ply", "stl", "glb", "gltf"};
    return hints[static_cast<std::size_t>(format)];
}

}  // namespace

std::optional<PointCloud> parse_mesh(const std::filesystem::path& file, std::string_view bytes,
                                     MeshFormat format, double unit_m,
                                     const MeshSampling& sampling) {
    // What the library takes on trust; of glTF that is checked by plain_gltf(), an OBJ has no
    // counts.
    if (format == MeshFormat::stl) check_stl(file, bytes);
    if (format == MeshFormat::ply) check_ply(file, bytes);
    const std::string surface = format == MeshFormat::obj ? obj_surface(bytes) : std::string();
    if (format == MeshFormat::obj) {
        bytes = surface;
        if (const std::string points = obj_points(surface); !points.empty())
            return parse_xyz(file, points);
    }
    const std::uint64_t file_bytes = bytes.size();
    const bool gltf = format == MeshFormat::glb || format == MeshFormat::gltf;
    std::optional<std::string> plain;
    if (gltf) plain = plain_gltf(file, bytes, format == MeshFormat::glb);
    if (plain) {
        bytes = *plain;
        format = MeshFormat::glb;
    }
    Assimp::Importer importer;
    importer.SetIOHandler(new FilesBeside(file, format == MeshFormat::gltf));  // is the importer's
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
    Triangles triangles(file, *scene, file_bytes);
    if (!std::isfinite(triangles.area()))
        fail(file, "its triangles have no finite area; coordinates must be metres");
    const MeshColours colours(file, *scene, format);
    std::optional<PointCloud> out;
    if (triangles.area() > 0) {
        const std::vector<std::string> turned = triangles.turn(unit_m);
        out = sample(file, triangles, colours, unit_m, sampling);
        out->notes.insert(out->notes.end(), turned.begin(), turned.end());
    } else {
        out = points_of(file, *scene, triangles, colours);
    }
    return out;
}

}  // namespace topple::io

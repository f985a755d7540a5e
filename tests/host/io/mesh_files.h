// SPDX-License-Identifier: MIT
#pragma once

#include "files.h"

// One box as mesh files of every format: corner at the origin, faces seen from outside.
namespace topple::test {

constexpr std::array<double, 3> box_size{2, 1, 0.5};

inline std::array<std::array<double, 3>, 8> box_corners() {
    std::array<std::array<double, 3>, 8> out{};
    for (std::size_t n = 0; n < 8; ++n) {
        for (std::size_t a = 0; a < 3; ++a) out[n][a] = (n >> a & 1) ? box_size[a] : 0;
    }
    return out;
}

// Corners of the sides' quadrangles, against the clock.
constexpr std::array<std::array<unsigned, 4>, 6> box_sides{
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

inline std::string box_obj() {
    std::string out = "# box\n";
    for (const auto& c : box_corners()) {
        out.append("v");
        for (const double v : c) out.append(" ").append(std::to_string(v));
        out.append("\n");
    }
    for (const auto& side : box_sides) {
        out.append("f");
        for (const unsigned corner : side) out.append(" ").append(std::to_string(corner + 1));
        out.append("\n");
    }
    return out;
}

inline std::string box_ply() {
    std::string out =
        "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty "
        "float z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n";
    for (const auto& c : box_corners()) {
        for (const double v : c) out.append(std::to_string(v)).append(" ");
        out.append("\n");
    }
    for (const auto& side : box_sides) {
        out.append("4");
        for (const unsigned corner : side) out.append(" ").append(std::to_string(corner));
        out.append("\n");
    }
    return out;
}

inline std::array<std::array<unsigned, 3>, 12> box_triangles() {
    std::array<std::array<unsigned, 3>, 12> out{};
    for (std::size_t s = 0; s < 6; ++s) {
        const auto& q = box_sides[s];
        out[2 * s] = {q[0], q[1], q[2]};
        out[2 * s + 1] = {q[0], q[2], q[3]};
    }
    return out;
}

inline std::string box_stl() {
    std::string out(80, ' ');
    append<std::uint32_t>(out, 12);
    const auto corners = box_corners();
    for (const auto& triangle : box_triangles()) {
        for (int a = 0; a < 3; ++a) append<float>(out, 0);
        for (const unsigned corner : triangle) {
            for (const double v : corners[corner]) append<float>(out, static_cast<float>(v));
        }
        append<std::uint16_t>(out, 0);
    }
    return out;
}

// 8 corners (96 bytes), then 36 indices (72 bytes).
inline std::string box_buffer() {
    std::string out;
    for (const auto& c : box_corners()) {
        for (const double v : c) append<float>(out, static_cast<float>(v));
    }
    for (const auto& triangle : box_triangles()) {
        for (const unsigned corner : triangle) append<std::uint16_t>(out, std::uint16_t(corner));
    }
    return out;
}

inline std::string box_gltf_json(const std::array<double, 3>& at, const std::string& uri) {
    std::string place;
    for (const double v : at) place.append(place.empty() ? "" : ",").append(std::to_string(v));
    std::string json = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)";
    json.append(R"("nodes":[{"mesh":0,"translation":[)").append(place).append("]}],");
    json.append(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
                R"("accessors":[{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3",)"
                R"("min":[0,0,0],"max":[2,1,0.5]},)"
                R"({"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}],)"
                R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":96},)"
                R"({"buffer":0,"byteOffset":96,"byteLength":72}],"buffers":[{)");
    json.append(uri).append(R"("byteLength":168}]})");
    return json;
}

inline std::string glb_of(std::string json, std::string binary) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    std::string out = "glTF";
    for (const std::size_t word : {std::size_t{2}, 28 + json.size() + binary.size(), json.size()})
        append(out, static_cast<std::uint32_t>(word));
    out += "JSON" + json;
    append(out, static_cast<std::uint32_t>(binary.size()));
    out.append("BIN").push_back('\0');
    return out + binary;
}

inline std::string box_glb(const std::array<double, 3>& at = {0, 0, 0}) {
    return glb_of(box_gltf_json(at, ""), box_buffer());
}

inline std::string box_file(std::string_view name) {
    return name.ends_with(".obj")   ? box_obj()
           : name.ends_with(".stl") ? box_stl()
           : name.ends_with(".glb") ? box_glb()
                                    : box_ply();
}

inline void write_box_gltf(const std::filesystem::path& folder) {
    std::ofstream(folder / "box.gltf") << box_gltf_json({0, 0, 0}, R"("uri":"box.bin",)");
    std::ofstream(folder / "box.bin", std::ios::binary) << box_buffer();
}

}  // namespace topple::test

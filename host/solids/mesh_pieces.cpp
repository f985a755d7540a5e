// SPDX-License-Identifier: MIT
#include "solids/mesh_pieces.h"

#include <algorithm>
#include <array>
#include <utility>

namespace topple::solids {
namespace {

constexpr std::int32_t edge = 32;  // of a block, voxels

std::uint64_t block_of(const std::array<std::int32_t, 3>& corner) {
    std::uint64_t key = 0;
    for (const std::int32_t c : corner)
        key = key << 21 | (static_cast<std::uint32_t>((c + (1 << 25)) / edge) & 0x1fffff);
    return key;
}

}  // namespace

MeshPieces::MeshPieces(const SurfaceMesh& mesh) : mesh_(mesh), shared_(mesh.vertex.size(), 0) {
    std::vector<std::uint64_t> keys;
    keys.reserve(mesh.triangle.size());
    for (const auto& t : mesh.triangle) keys.push_back(block_of(mesh.corner[t[0]]));
    blocks_ = geometry::group_keys(keys);
    constexpr std::uint64_t none = ~std::uint64_t{0};
    std::vector<std::uint64_t> block(mesh.vertex.size(), none);
    for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
        for (const std::uint32_t v : mesh.triangle[t]) {
            if (block[v] == none) block[v] = keys[t];
            if (block[v] != keys[t]) shared_[v] = 1;
        }
    }
}

MeshPiece MeshPieces::cut(std::size_t block, std::span<const ErrorQuadric> quadric,
                          std::vector<std::uint32_t>& number) const {
    MeshPiece out;
    const auto triangles = blocks_.group(block);
    for (const std::uint32_t t : triangles) {
        for (const std::uint32_t v : mesh_.triangle[t])
            if (std::exchange(number[v], 1) == 0) out.from.push_back(v);
    }
    std::ranges::sort(out.from);
    const std::size_t count = out.from.size();
    out.mesh.vertex.reserve(count);
    out.mesh.corner.reserve(count);
    out.quadric.reserve(count);
    out.fixed.reserve(count);
    for (const std::uint32_t v : out.from) {
        number[v] = static_cast<std::uint32_t>(out.mesh.vertex.size());
        out.mesh.vertex.push_back(mesh_.vertex[v]);
        out.mesh.corner.push_back(mesh_.corner[v]);
        out.quadric.push_back(quadric[v]);
        out.fixed.push_back(shared_[v]);
    }
    out.mesh.triangle.reserve(triangles.size());
    out.mesh.facet.reserve(triangles.size());
    for (const std::uint32_t t : triangles) {
        const auto [a, b, c] = mesh_.triangle[t];
        out.mesh.triangle.push_back({number[a], number[b], number[c]});
        out.mesh.facet.push_back(mesh_.facet[t]);
    }
    for (const std::uint32_t v : out.from) number[v] = 0;
    return out;
}

SurfaceMesh MeshPieces::joined(std::span<const MeshPiece> pieces,
                               std::vector<ErrorQuadric>& quadric,
                               std::vector<std::uint8_t>& settled) const {
    std::vector<std::uint32_t> number(mesh_.vertex.size(), 0);
    for (const MeshPiece& p : pieces)
        for (const std::uint32_t v : p.from) number[v] = 1;
    SurfaceMesh out;
    for (std::uint32_t v = 0; v < number.size(); ++v) {
        if (number[v] == 0) continue;
        number[v] = static_cast<std::uint32_t>(out.vertex.size());
        out.vertex.push_back(mesh_.vertex[v]);
        out.corner.push_back(mesh_.corner[v]);
        quadric[out.vertex.size() - 1] = quadric[v];
    }
    quadric.resize(out.vertex.size());
    settled.assign(out.vertex.size(), 0);
    for (const MeshPiece& p : pieces) {
        for (std::size_t v = 0; v < p.from.size(); ++v) {
            if (p.fixed[v] != 0) continue;
            quadric[number[p.from[v]]] = p.quadric[v];
            settled[number[p.from[v]]] = p.settled[v];
        }
        for (std::size_t t = 0; t < p.mesh.triangle.size(); ++t) {
            const auto [a, b, c] = p.mesh.triangle[t];
            out.triangle.push_back({number[p.from[a]], number[p.from[b]], number[p.from[c]]});
            out.facet.push_back(p.mesh.facet[t]);
        }
    }
    return out;
}

}  // namespace topple::solids

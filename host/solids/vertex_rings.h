// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <utility>
#include <vector>

#include "solids/surface_mesh.h"

namespace topple::solids {

// The triangles around each vertex, side by side in one array: a vertex that gains some gets a new
// place. Several threads may change the rings of different vertices.
class VertexRings {
  public:
    explicit VertexRings(const SurfaceMesh& mesh)
        : place_(mesh.vertex.size()), triangles_(3 * mesh.triangle.size()) {
        for (const auto& t : mesh.triangle)
            for (const std::uint32_t v : t) ++place_[v].count;
        std::uint32_t* first = triangles_.data();
        for (Place& p : place_) {
            p.first = first;
            first += std::exchange(p.count, 0);
        }
        for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t)
            for (const std::uint32_t v : mesh.triangle[t]) {
                Place& p = place_[v];
                p.first[p.count++] = t;
            }
    }
    std::size_t size() const { return place_.size(); }
    std::span<const std::uint32_t> operator[](std::uint32_t v) const {
        return {place_[v].first, place_[v].count};
    }
    void clear(std::uint32_t v) { place_[v].count = 0; }
    void erase(std::uint32_t v, std::uint32_t triangle) {
        Place& p = place_[v];
        p.count =
            static_cast<std::uint32_t>(std::remove(p.first, p.first + p.count, triangle) - p.first);
    }
    // room: for the vertex's new place, one thread's at a time. It must live as long as this.
    void append(std::uint32_t v, std::span<const std::uint32_t> more,
                std::pmr::memory_resource& room) {
        if (more.empty()) return;
        Place& p = place_[v];
        const std::size_t count = p.count + more.size();
        auto* first = static_cast<std::uint32_t*>(
            room.allocate(count * sizeof(std::uint32_t), alignof(std::uint32_t)));
        std::copy_n(p.first, p.count, first);
        std::ranges::copy(more, first + p.count);
        p = {first, static_cast<std::uint32_t>(count)};
    }

  private:
    struct Place {
        std::uint32_t* first = nullptr;
        std::uint32_t count = 0;
    };
    std::vector<Place> place_;
    std::vector<std::uint32_t> triangles_;
};

}  // namespace topple::solids

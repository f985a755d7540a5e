// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "solids/surface_mesh.h"

namespace topple::solids {

// The triangles around each vertex, side by side in one array: a vertex that gains some gets a new
// place at its end.
class VertexRings {
  public:
    explicit VertexRings(const SurfaceMesh& mesh) : place_(mesh.vertex.size()) {
        for (const auto& t : mesh.triangle)
            for (const std::uint32_t v : t) ++place_[v].count;
        std::size_t first = 0;
        for (Place& p : place_) {
            p.first = first;
            first += std::exchange(p.count, 0);
        }
        triangles_.resize(first);
        for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t)
            for (const std::uint32_t v : mesh.triangle[t]) {
                Place& p = place_[v];
                triangles_[p.first + p.count++] = t;
            }
    }
    std::size_t size() const { return place_.size(); }
    std::span<const std::uint32_t> operator[](std::uint32_t v) const {
        return std::span(triangles_).subspan(place_[v].first, place_[v].count);
    }
    void clear(std::uint32_t v) { place_[v].count = 0; }
    void erase(std::uint32_t v, std::uint32_t triangle) {
        const auto begin = triangles_.begin() + static_cast<std::ptrdiff_t>(place_[v].first);
        const auto end = begin + place_[v].count;
        const auto kept = std::remove(begin, end, triangle);
        place_[v].count = static_cast<std::uint32_t>(kept - begin);
    }
    void append(std::uint32_t v, std::span<const std::uint32_t> more) {
        if (more.empty()) return;
        Place& p = place_[v];
        const std::size_t first = triangles_.size();
        triangles_.resize(first + p.count + more.size());
        std::copy_n(triangles_.begin() + static_cast<std::ptrdiff_t>(p.first), p.count,
                    triangles_.begin() + static_cast<std::ptrdiff_t>(first));
        std::ranges::copy(more, triangles_.begin() + static_cast<std::ptrdiff_t>(first + p.count));
        p.first = first;
        p.count += static_cast<std::uint32_t>(more.size());
    }

  private:
    struct Place {
        std::size_t first = 0;
        std::uint32_t count = 0;
    };
    std::vector<Place> place_;
    std::vector<std::uint32_t> triangles_;
};

}  // namespace topple::solids

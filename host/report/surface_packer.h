// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/object_surface.h"
#include "core/thread_pool.h"
#include "report/view_data.h"

namespace topple::report {

// Of each axis -1, 0 or 1, as PackedSurface has it.
std::uint8_t direction_code(const std::array<float, 3>& direction);
inline constexpr std::uint8_t no_direction = 13;

// Puts the surfaces of objects into one, each vertex once for each group of its triangles.
class SurfacePacker {
  public:
    explicit SurfacePacker(bool coloured) : coloured_(coloured) {}

    // group_of: of a primitive. The surface must outlive the packer.
    void add(const ObjectSurface& surface,
             const std::function<std::uint16_t(std::int32_t)>& group_of);

    // What it will take.
    std::size_t bytes() const { return vertex_.size() * (coloured_ ? 16 : 12) + index_.size() * 6; }
    // vertex_of: vertex number v of a surface, in a group; several threads call it.
    using VertexOf = std::function<Record(const ObjectSurface&, std::size_t, std::uint16_t)>;
    PackedSurface take(const VertexOf& vertex_of, ThreadPool& pool);

  private:
    // A vertex, before it is known whether it is needed.
    struct Vertex {
        const ObjectSurface* surface;
        std::uint32_t number;
        std::uint16_t group;
    };
    bool coloured_;
    std::vector<Vertex> vertex_;
    std::vector<std::array<std::uint16_t, 3>> index_;
};

}  // namespace topple::report

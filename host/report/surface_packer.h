// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "core/object_surface.h"
#include "report/view_data.h"

namespace topple::report {

struct SurfaceVertex {
    std::array<std::uint16_t, 4> cell{};
    std::array<std::int8_t, 4> aux{};
    std::array<std::uint8_t, 4> photo{};
};

// Of each axis -1, 0 or 1, as PackedSurface has it.
std::uint8_t direction_code(const std::array<float, 3>& direction);
inline constexpr std::uint8_t no_direction = 13;

// Puts the surfaces of objects into one, each vertex once for each group of its triangles.
class SurfacePacker {
  public:
    explicit SurfacePacker(bool coloured) : coloured_(coloured) {}

    // group_of: of a primitive. vertex_of: number v of the surface, in a group.
    void add(const ObjectSurface& surface,
             const std::function<std::uint16_t(std::int32_t)>& group_of,
             const std::function<SurfaceVertex(std::size_t, std::uint16_t)>& vertex_of);

    std::size_t bytes() const {
        return out_.cell.size() * (coloured_ ? 16 : 12) + out_.index.size() * 6;
    }
    PackedSurface take() { return std::move(out_); }

  private:
    bool coloured_;
    PackedSurface out_;
};

}  // namespace topple::report

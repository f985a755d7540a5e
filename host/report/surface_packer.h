// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>

#include "core/object_surface.h"
#include "core/thread_pool.h"
#include "report/view_data.h"

namespace topple::report {

// Of each axis -1, 0 or 1, as PackedSurface has it.
std::uint8_t direction_code(const std::array<float, 3>& direction);
inline constexpr std::uint8_t no_direction = 13;

// What a surface's records are made by. group_of: of a primitive of a surface; vertex_of: vertex
// number v of a surface, in a group, asked by several threads.
struct SurfaceRecords {
    bool coloured = false;
    std::function<std::uint16_t(const ObjectSurface&, std::int32_t)> group_of;
    std::function<Record(const ObjectSurface&, std::size_t v, std::uint16_t group)> vertex_of;
};

// The surfaces of objects as one, each vertex once for each group of its triangles. Empty where it
// would take more than `most` bytes.
PackedSurface pack_surfaces(std::span<const ObjectSurface> surfaces, const SurfaceRecords& records,
                            std::size_t most, ThreadPool& pool);

}  // namespace topple::report

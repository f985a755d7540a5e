// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/boundary_cells.h"
#include "core/thread_pool.h"
#include "solids/block_surface.h"
#include "solids/object_voxels.h"
#include "solids/solid_places.h"

// Which patch each face of an object's voxels stands for. Grid frame, metres.
namespace topple::solids {

constexpr std::uint32_t no_patch = ~std::uint32_t{0};

// What a triangle is a piece of.
struct Facet {
    std::uint32_t patch = no_patch;
    bool outside = false;         // it is the patch's outside that is solid
    std::int32_t primitive = -1;  // whose surface it is
    std::uint8_t direction = 0;   // of the voxel's side: -x +x -y +y -z +z
};
// Of a facet's patch, out of the solid; not of unit length.
Vec3 outwards(const Facet& facet, std::span<const SurfacePatch> patches, const Vec3& at);

// What the boundary says of an object in its voxels.
class ObjectEntries {
  public:
    // Keeps references to its arguments.
    ObjectEntries(const BoundaryCells& boundary, std::span<const std::int32_t> object_of_primitive,
                  double voxel_m);

    // The patch through which a line along an axis leaves the object last before `end`, if it does
    // so in the voxel or not far from it. `start`: a point on the line.
    std::optional<Facet> way_out(const ObjectVoxel& voxel, const Vec3& start, std::size_t axis,
                                 int sign, double end) const;
    // The middles of what is solid of each primitive there, the largest first.
    void middles(const ObjectVoxel& voxel, std::vector<Vec3>& out) const;
    // The patch of a primitive that a voxel's side in some direction, with its middle at `at`, may
    // be: that of a sheet, which says nothing of what is solid within voxels.
    std::optional<Facet> beside(std::int32_t primitive, const Vec3& at, std::size_t axis,
                                int sign) const;
    // Whether p, in the voxel or near it, is solid; patches count as slack_m wider.
    bool solid(const ObjectVoxel& voxel, const Vec3& p, double slack_m) const;
    // Adds the voxel's patches.
    void add_patches(const ObjectVoxel& voxel, std::vector<std::uint32_t>& out) const;

    double voxel_m() const { return h_; }

  private:
    template <class Do>
    void each(const ObjectVoxel& voxel, Do what) const;

    const BoundaryCells& b_;
    std::span<const std::int32_t> object_of_;
    double h_;
    PatchesSeenOn seen_on_;
};

// Of each face.
std::vector<Facet> find_facets(std::span<const ObjectVoxel> voxels,
                               std::span<const VoxelFace> faces, const ObjectEntries& entries,
                               ThreadPool& pool);

}  // namespace topple::solids

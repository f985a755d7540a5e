// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/rotation.h"
#include "core/solid_cells.h"
#include "core/space_map.h"
#include "topple/cloud_view.h"
#include "topple/kernels/device.h"
#include "topple/scene.h"

// Sparse voxel grids of a scene. OpenVDB holds them; devices see their leaves as flat tiles.
namespace topple::vdb {

// How voxels lie in the input's frame: voxel (i, j, k) is centred at R' * ((i, j, k) + 0.5) *
// voxel_m + origin_m, with R = grid_from_input, a rotation whose third row is up.
struct VoxelFrame {
    double voxel_m = 0.02;
    Rotation grid_from_input{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    Vec3 origin_m{};
    Vec3 grid_of(const Vec3& place) const {
        return turned(grid_from_input, minus(place, origin_m));
    }
    Vec3 input_of(const Vec3& place) const {
        return plus(turned_back(grid_from_input, place), origin_m);
    }
};

// That of the grid frame, which a transform of the input's leads to.
inline VoxelFrame grid_frame(const Mat4& grid_from_input, double voxel_m) {
    const Rotation rotation = rotation_of(grid_from_input);
    const Vec3 to{grid_from_input[3], grid_from_input[7], grid_from_input[11]};
    return {voxel_m, rotation, opposite(turned_back(rotation, to))};
}

enum class State : std::uint8_t { empty = 0, surface = 1, invisible = 2, completed = 3 };

// Leaves of 8x8x8 voxels, sorted by origin (x, then y, then z). Voxel (x, y, z) of leaf n has index
// n * 512 + (x & 7) * 64 + (y & 7) * 8 + (z & 7), in every per-voxel array here.
struct Tiles {
    std::vector<std::int32_t> x, y, z;  // lowest voxel of each leaf, multiples of 8
    std::size_t size() const { return x.size(); }
};

using Voxel = Place;

// A scene's voxels as plain arrays, but for the fields that were added and the objects.
struct SavedVoxels {
    VoxelFrame frame;
    std::array<Voxel, 2> bounds{};  // lowest leaf and leaves per axis
    std::vector<Voxel> beyond;      // leaves outside of the bounds
    // What is stored as one value: its level in the tree, lowest voxel, value, and whether active.
    struct Tile {
        std::int32_t level, i, j, k, value, active;
    };
    std::vector<Tile> tiles;
    std::vector<Voxel> leaves;             // of the states: lowest voxels
    std::vector<std::uint8_t> states;      // 512 of each
    std::vector<std::uint8_t> solid;       // as states: whether active
    std::vector<Voxel> labelled;           // leaves of the labels
    std::vector<std::uint64_t> has_label;  // 8 words of each: of which voxels
    std::vector<std::int32_t> label;       // of these
};

class VoxelScene {
  public:
    // Surface voxels from points and their primitive labels (-1: no primitive; the voxel is still
    // surface). A voxel takes the label that most of its labelled points have, the lowest of
    // equals. seen_side: empty where it is not known, or for each point a bit by direction (-x +x
    // -y +y -z +z): what goes that way meets its surface on the side from which it was seen. A
    // voxel has the bits of a quarter of its points, but neither of two opposite ones. The scene's
    // bounds are those of its points; where few stray points lie far from all others, the bounds
    // leave them out (0.1 % per side), and only their own leaves exist out there, which belong to
    // no primitive. Points that no voxel index can reach, further than 2^20 voxels from the points'
    // median, are left out. Throws Error(usage) for a frame that is no rotation, a voxel size that
    // is not positive, or labels or sides that don't match the points; Error(input) where the
    // bounds hold more leaves than memory allows.
    VoxelScene(const VoxelFrame& frame, const CloudView& cloud, std::span<const std::int32_t> label,
               std::span<const std::uint8_t> seen_side = {});
    // The same before labels are known: what is carved doesn't depend on them.
    VoxelScene(const VoxelFrame& frame, const CloudView& cloud);
    // The labels of a scene of the same cloud.
    void set_labels(const CloudView& cloud, std::span<const std::int32_t> label,
                    std::span<const std::uint8_t> seen_side = {});
    // A scene without points or bounds, for put_leaf(), labels and write().
    explicit VoxelScene(const VoxelFrame& frame);
    // As it was saved. Throws Error(input) for what no scene saves. It can't be carved further.
    explicit VoxelScene(const SavedVoxels& saved);
    SavedVoxels saved() const;
    ~VoxelScene();
    VoxelScene(VoxelScene&&) noexcept;

    // Takes over a leaf of 8x8x8 voxels, found elsewhere, once each: 512 states in the order of
    // Tiles. Of a solid voxel put_label() names the primitive.
    void put_leaf(const std::array<std::int32_t, 3>& lowest, std::span<const std::uint8_t> states);
    void put_label(std::int32_t i, std::int32_t j, std::int32_t k, std::int32_t primitive);

    const VoxelFrame& frame() const;
    // Of points whose coordinates were reckoned from there.
    void set_origin(const Vec3& origin_m);

    // Whether a voxel lies within the scene's bounds, rounded outwards to whole leaves.
    bool in_bounds(std::int32_t i, std::int32_t j, std::int32_t k) const;

    // Visibility carving (paper, 2.2.2; kernels carve_leaves, carve): voxels in front of a depth
    // reading become empty, those that no frame saw stay invisible. May be called for as many
    // batches of frames as there are. Leaves that are all empty or all
    // invisible are stored as one value. Undoes an earlier completion. Throws Error(input) for
    // frames that don't match the intrinsics or whose pose is not finite.
    void carve(device::Device& device, const Intrinsics& intrinsics,
               std::span<const DepthFrame> frames);

    // Free space that a map tells, instead of frames or, after carve(), beside them: voxels whose
    // centre it says to be free become empty, those with points stay surface. Where the map's
    // voxels are the grid's, its free space beyond the scene's bounds is kept, too. Undoes an
    // earlier completion. Throws Error(usage) for a map without a voxel size, Error(input) for one
    // of more than 2^23 blocks of 8x8x8 free voxels.
    void set_free(const SpaceMap& map);

    // Makes completed voxels invisible again.
    void clear_completed();

    // Takes solid voxels away: they are empty then, as if they had been seen to be.
    void set_empty(std::span<const Voxel> voxels);

    // Primitive p becomes number[p]; -1: its voxels stay solid, but belong to no primitive. Throws
    // Error(usage) for a primitive beyond the span.
    void relabel(std::span<const std::int32_t> number);

    // The leaves that hold solid voxels, or that `all` asks for, and their voxels, flattened.
    Tiles tiles(bool all = false) const;
    std::vector<std::uint8_t> states(const Tiles& tiles) const;
    std::vector<std::int32_t> primitives(const Tiles& tiles) const;  // -1: none
    // Outside of the scene's bounds: invisible.
    State state_at(std::int32_t i, std::int32_t j, std::int32_t k) const;

    // The solid voxels, flattened; of completed ones it says no more than that they were filled.
    // What follows the completion gets them from there.
    SolidCells solid_cells() const;

    // Object of each primitive, for write(); -1 where the span ends.
    void set_objects(std::span<const std::int32_t> object_of_primitive);

    // Adds a float grid to what write() stores: a value for each of the voxels (i, j, k); zeros are
    // not stored. Throws Error(usage) for a name that is taken or arrays that differ in length.
    void add_field(const std::string& name, std::span<const std::int32_t> i,
                   std::span<const std::int32_t> j, std::span<const std::int32_t> k,
                   std::span<const float> values);

    // Takes one of those away again, where there is one of that name.
    void remove_field(const std::string& name);

    // Grids `state`, `primitive`, `object` (Int32Grid; inactive background -1 for the last two, 2
    // for `state`, whose active voxels are the solid ones) and the added fields. The transform
    // takes the index (i, j, k) to the voxel's centre in the input's frame. Throws Error(input)
    // where the file can't be written.
    void write(const std::filesystem::path& path) const;

    struct Grids;  // internal to vdb/
    Grids& grids() { return *grids_; }
    const Grids& grids() const { return *grids_; }

  private:
    std::unique_ptr<Grids> grids_;
};

// Their centres in the input's frame, in the same order. Object of each primitive: -1 where the
// span ends.
SolidVoxels solid_voxels(const VoxelFrame& frame, const SolidCells& cells,
                         std::span<const std::int32_t> object_of_primitive);

}  // namespace topple::vdb

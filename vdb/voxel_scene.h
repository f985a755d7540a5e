// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "device/device.h"
#include "topple/input.h"

// Sparse voxel grids of a scene. OpenVDB holds them; devices see their leaves as flat tiles.
namespace topple::vdb {

// How voxels lie in the input's frame: voxel (i, j, k) is centred at R' * ((i, j, k) + 0.5) * voxel_m,
// with R = grid_from_input, a rotation whose third row is up.
struct VoxelFrame {
    double voxel_m = 0.02;
    std::array<Vec3, 3> grid_from_input{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
};

enum class State : std::uint8_t { empty = 0, surface = 1, invisible = 2, completed = 3 };

// Leaves of 8x8x8 voxels, sorted by origin (x, then y, then z). Voxel (x, y, z) of leaf n has index
// n * 512 + (x & 7) * 64 + (y & 7) * 8 + (z & 7), in every per-voxel array here.
struct Tiles {
    std::vector<std::int32_t> x, y, z;      // lowest voxel of each leaf, multiples of 8
    std::vector<std::int32_t> neighbour;    // 6 per leaf: -x, +x, -y, +y, -z, +z; -1 where absent
    std::size_t size() const { return x.size(); }
};

class VoxelScene {
  public:
    // Surface voxels from points and their primitive labels (-1: no primitive; the voxel is still
    // surface). A voxel takes the label that most of its points have, the lowest of equals.
    VoxelScene(const VoxelFrame& frame, const PointCloud& cloud, std::span<const std::int32_t> label);
    ~VoxelScene();
    VoxelScene(VoxelScene&&) noexcept;

    const VoxelFrame& frame() const;

    // Visibility carving (paper, 2.2.2; kernels carve_leaves, carve): voxels in front of a depth
    // reading become empty, those that no frame saw stay invisible. May be called for as many batches
    // of frames as there are. Leaves that are all empty or all invisible are stored as one value.
    void carve(device::Device& device, const Intrinsics& intrinsics, std::span<const DepthFrame> frames);

    // Six-direction filling (paper, 2.2.3; kernels six_fill_sweep, six_fill_vote). Primitives in
    // `hollow` (walls, floors: large planes) neither fill nor are filled. Returns voxels completed.
    struct FillOptions {
        unsigned votes = 2;              // directions that must agree
        std::vector<bool> hollow;        // by primitive
    };
    std::uint64_t fill(device::Device& device, const FillOptions& options);

    // The leaves that hold solid voxels, or that `all` asks for, and their voxels, flattened.
    Tiles tiles(bool all = false) const;
    std::vector<std::uint8_t> states(const Tiles& tiles) const;
    std::vector<std::int32_t> primitives(const Tiles& tiles) const;  // -1: none
    State state_at(std::int32_t i, std::int32_t j, std::int32_t k) const;

    // Bounds of all surface voxels, inclusive.
    std::array<std::int32_t, 3> lowest() const, highest() const;

    void set_objects(std::span<const std::int32_t> object_of_primitive);

    // Adds a float grid to what write() stores: value per voxel of `tiles`, zeros are not stored.
    void add_field(const std::string& name, const Tiles& tiles, std::span<const float> values);

    // Grids `state`, `primitive`, `object` (Int32Grid; inactive background -1 for the last two) and
    // the added fields, with the voxel-to-input transform. Throws Error(input) where the file can't
    // be written.
    void write(const std::filesystem::path& path) const;

  private:
    struct Grids;
    std::unique_ptr<Grids> grids_;
};

}  // namespace topple::vdb
